/// @file
/// Gauss-Legendre quadrature over [0, 1].
#pragma once

#include <vector>

namespace sinew::pcc {

struct GaussPoint {
  double at = 0.0, weight = 0.0;
};

inline constexpr int kMaxGaussPoints = 8;

/// Quadrature points, exact for polynomials of degree 2 count - 1. @param count 1 to
/// kMaxGaussPoints.
std::vector<GaussPoint> gauss_points(int count);

}  // namespace sinew::pcc
