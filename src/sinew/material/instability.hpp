/// @file
/// Where a law loses its stability at stretches of robots.
#pragma once

#include <string>

#include "sinew/material/hyperelastic.hpp"

namespace sinew::material {

/// Stretches that robots reach: rubbers tear at 5 to 12, and walls that stretch twofold are common.
inline constexpr double kLeastStretch = 0.5, kMostStretch = 3.0;

/// Where a law is unstable between kLeastStretch and kMostStretch, such as "above 1.13 and below
/// 0.885 in uniaxial stretch, above 1.06 in equibiaxial stretch"; empty if it is stable there.
///
/// By Drucker's criterion (stable_range()) in uniaxial, equibiaxial and planar stretch. The tangent
/// of the compressible law has the same sign: with H = d^2 psi/de_i de_j at J = 1 and the 2x2
/// matrix A of the isochoric motions (1, 0, -1), (0, 1, -1),
///   H = H_iso + kappa 1 1^T,   H_iso 1 = 0,   det H = kappa det A,
/// so that H is positive definite where A is. Saint Venant-Kirchhoff is linear in the Green strain;
/// in uniaxial stress, its nominal stress E l (l^2 - 1)/2 has its minimum at l = 1/sqrt(3).
std::string instability(const Hyperelastic& law);

}  // namespace sinew::material
