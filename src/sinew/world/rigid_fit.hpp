/// @file
/// The rigid motion nearest to the displacements of some points, in words.
#pragma once

#include <string>

#include "sinew/core/types.hpp"

namespace sinew::world {

/// The least-squares fit u = translation + rotation x (x - centre) of displacements, for small
/// motions.
struct RigidFit {
  /// @param points,displacements (n, 3) m, n > 0.
  RigidFit(const Points& points, const Points& displacements);

  /// "turns freely about the axis through (x, y, z) m along (a, b, c)", or "moves freely along
  /// (a, b, c)", or "moves freely" if the motion is not rigid.
  std::string text() const;

  Vector3 centre = Vector3::Zero();       ///< m, mean of the points
  Vector3 translation = Vector3::Zero();  ///< m, of the centre
  Vector3 rotation = Vector3::Zero();     ///< rad
  double reach = 0.0;                     ///< m, root mean square distance from the centre
  bool is_rigid = false;                  ///< whether the fit leaves less than a tenth of u
};

/// "(0.01, 0, 0.2)": coordinates without the digits that are rounding, relative to a size in m.
std::string place_text(const Vector3& at, double size);

}  // namespace sinew::world
