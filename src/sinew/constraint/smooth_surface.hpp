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

/// Shapes without edges. Their tangent planes turn continuously with the point for which they are
/// chosen; the iterations of a step rely on this (see Contact).
using SmoothSurface = std::variant<Plane, Sphere, Capsule>;

}  // namespace sinew::constraint
