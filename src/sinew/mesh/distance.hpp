/// @file
/// Position of a point relative to a tetrahedron.
#pragma once

#include <array>

#include "sinew/mesh/quality.hpp"

namespace sinew::mesh {

/// Barycentric weights w of the corners, with point = sum w_k x_k and sum w_k = 1; all in [0, 1] if
/// the point is inside. The tetrahedron must not be flat.
/// @param point (3,) m.
/// @param corners of the tetrahedron, m.
std::array<double, 4> barycentric_weights(const Vector3& point, const Corners& corners);

/// The nearest point of the tetrahedron; the point itself if it is inside.
/// @param point (3,) m.
/// @param corners of the tetrahedron, m.
Vector3 closest_on_tetrahedron(const Vector3& point, const Corners& corners);

/// Distance to the tetrahedron, m; 0 inside.
/// @param point (3,) m.
/// @param corners of the tetrahedron, m.
double distance_to_tetrahedron(const Vector3& point, const Corners& corners);

}  // namespace sinew::mesh
