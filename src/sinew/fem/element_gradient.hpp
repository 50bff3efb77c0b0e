/// @file
/// Deformation gradient of a batch of linear tetrahedra from unpadded positions, for output outside
/// of steps.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/fem/element_batches.hpp"
#include "sinew/material/lanes.hpp"

namespace sinew::fem {

/// F = I + sum (u_a - u_0) g_a^T. It uses displacements, so that small strains are not lost to
/// rounding.
/// @param batch,nodes as in ElementBatches. @param positions,rest (n, 3) m.
inline material::Lanes3x3 deformation_gradient(const BatchConstants& batch,
                                               const std::int32_t* nodes, const Points& positions,
                                               const Points& rest) {
  using material::kLanes;
  material::Lanes3x3 f{};
  for (int lane = 0; lane < kLanes; ++lane) {
    const Vector3 origin = (positions.row(nodes[lane]) - rest.row(nodes[lane])).transpose();
    for (int a = 1; a < 4; ++a) {
      const auto node = nodes[kLanes * a + lane];
      const Vector3 u = (positions.row(node) - rest.row(node)).transpose() - origin;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) f[r][c][lane] += u[r] * batch.gradient[a - 1][c].value[lane];
      }
    }
  }
  for (int r = 0; r < 3; ++r) f[r][r] += 1.0;
  return f;
}

}  // namespace sinew::fem
