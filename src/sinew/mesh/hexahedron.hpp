/// @file
/// The trilinear hexahedron: shape functions in VTK node order, and local coordinates of a point
/// (Zienkiewicz, Taylor, Zhu, "The Finite Element Method", 6th ed., 2005, volume 1, section 4.8).
#pragma once

#include <array>
#include <optional>

#include "sinew/core/types.hpp"

namespace sinew::mesh {

/// Shape functions N_a at local coordinates in [-1, 1]^3.
std::array<double, 8> hexahedron_shapes(const Vector3& local);
/// Derivatives dN_a/dxi, (8, 3).
Eigen::Matrix<double, 8, 3> hexahedron_gradients(const Vector3& local);
/// The 2 x 2 x 2 Gauss points; each has weight 1.
const std::array<Vector3, 8>& hexahedron_points();

/// Local coordinates of a point, by Newton's method from the centre; none if it does not converge
/// (a point far outside of a distorted element).
/// @param point (3,) m. @param corners (8, 3) m.
std::optional<Vector3> hexahedron_coordinates(const Vector3& point,
                                              const Eigen::Matrix<double, 8, 3>& corners);

}  // namespace sinew::mesh
