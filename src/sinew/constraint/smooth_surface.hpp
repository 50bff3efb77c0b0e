/// @file
/// The shapes that material points may touch.
#pragma once

#include <variant>

#include "sinew/collision/shape.hpp"

namespace sinew::constraint {

using collision::Capsule;
using collision::distance;
using collision::Plane;
using collision::Sphere;

/// Shapes without edges: their tangent planes turn gradually with the point that they are chosen
/// for, which the rounds of a step rely on (see Contact).
using SmoothSurface = std::variant<Plane, Sphere, Capsule>;

}  // namespace sinew::constraint
