/// @file
/// Lids that close the openings of a surface.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::builder {

/// The rim of an opening: a closed loop of nodes at rest.
struct Rim {
  std::vector<Vector3> corners;  ///< m
  std::vector<Vector3>
      middles;             ///< m, (corners,) or empty: the middle of the edge from each corner
  std::vector<char> held;  ///< (corners,) 1: the node is immovable
};

/// Weights (corners,) of the hub of the lid: the point hub = sum weights x_corner, which sum to 1,
/// so that the triangles between it and the edges of the rim lie in the planes of the rim. None if
/// no such point exists.
///
/// - A rim in one plane: the mean of its corners.
/// - A rim in two planes that bound the body, such as the clamp of half a robot and its plane of
///   symmetry: the mean of the corners on both planes. While the rim stays in its planes, so do all
///   triangles. Other planes through the rim may cut through the chamber.
/// - A rim in three planes that bound the body, such as the clamp of a quarter of a robot and two
///   planes of symmetry: the point where the planes meet, as a mean of immovable corners.
/// A triangle in a plane through the hub encloses no volume with it, so the volume of the surface
/// with its lids is that of the cones from the hub to the faces of the material.
/// @param rim of the opening. @param body (n, 3) m: nodes of the body at rest.
std::optional<std::vector<double>> find_hub(const Rim& rim, const Points& body);

/// Size of a rim, and how far it leaves a plane.
struct RimShape {
  Vector3 area = Vector3::Zero();  ///< m^2, sum of the triangles to any point
  double rise = 0.0;               ///< m, extent of the rim along its area vector
  /// m^3: the volume under a lid with the hub h is c + h . area/3, so hubs at different nodes of
  /// the rim enclose volumes that differ by up to this.
  double uncertainty() const { return area.norm() * rise / 3.0; }
};
/// Shape of a rim that no planes contain.
RimShape rim_shape(const Rim& rim);

}  // namespace sinew::builder
