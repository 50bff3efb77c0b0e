/// @file
/// Working data of a batch of hyperelastic elements: positions, gradients and shared dilatation.
/// Included by kernels only; the equations are in solid_elements.hpp and element_history.hpp.
#pragma once

#include "sinew/fem/element_history.hpp"
#include "sinew/fem/element_patches.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/fem/transpose.hpp"
#include "sinew/material/principal.hpp"

namespace sinew::fem {

using material::kLanes;
using material::Lanes;
using material::lanes;
using material::Lanes3x3;

/// Positions and constants of one batch of elements with N nodes and Q quadrature points.
template <int N, int Q>
struct Batch {
  static constexpr int kRows = 3 * N + 1;

  const LaneRow* constants;
  Lanes x[N][3];  // relative to the first node, to keep digits far from the origin

  SINEW_INLINE Batch(const SolidGroup& group, std::int64_t batch, const double* points)
      : constants(group.constants.data() + batch * Q * kRows) {
    const std::int32_t* nodes = group.node.data() + batch * N * kLanes;
    Lanes origin[3];
    load_points(points, nodes, origin);
    for (int a = 0; a < N; ++a) {
      load_points(points, nodes + kLanes * a, x[a]);
      for (int c = 0; c < 3; ++c) x[a][c] -= origin[c];
    }
  }
  SINEW_INLINE Lanes gradient(int q, int a, int c) const {
    return material::load(constants[q * kRows + 3 * a + c].value);
  }
  SINEW_INLINE Lanes weight(int q) const {
    return material::load(constants[q * kRows + 3 * N].value);
  }
  SINEW_INLINE Lanes3x3 deformation(int q) const {
    Lanes3x3 f{};
    for (int a = 1; a < N; ++a) {
      for (int c = 0; c < 3; ++c) {
        const Lanes g = gradient(q, a, c);
        for (int r = 0; r < 3; ++r) f[r][c] += x[a][r] * g;
      }
    }
    return f;
  }
};

/// Moduli of the shared dilatation and of the dilatation of each point relative to it
/// (solid_elements.hpp).
struct BulkModuli {
  double shared = 0.0;
  double own = 0.0;
  /// Whether rotations leave mainly pressure errors in the tangent: nu above about 0.45. Otherwise
  /// the tangent uses the pressure of the forces, which large steps need.
  bool dominates = false;

  explicit BulkModuli(const SolidGroup& group)
      : shared(group.law.saint_venant_shear == 0.0 ? group.law.bulk_modulus : 0.0),
        own(own_bulk_modulus(group)),
        dominates(shared > 9.0 * group.law.shear_modulus()) {}
};

/// Shared dilatation of the elements of a batch.
struct Dilatation {
  Lanes ratio = lanes(1.0);     // Jm
  Lanes pressure = lanes(0.0);  // kappa (Jm - 1)
  Lanes energy = lanes(0.0);    // V kappa/2 (Jm - 1)^2
  Lanes volume = lanes(1.0);    // V; 1 in padding lanes
};

/// Computes the shared dilatation, from the points of each element or from the patch it belongs to.
/// @param group,batch,number the batch and its number. @param ratios det F of each point.
/// @param patch_ratio Jm of the patches of the group; null without patches. @param bulk kappa, Pa.
template <int N, int Q>
SINEW_INLINE Dilatation shared_dilatation(const SolidGroup& group, const Batch<N, Q>& batch,
                                          std::int64_t number, const Lanes (&ratios)[Q],
                                          const double* patch_ratio, double bulk) {
  Dilatation result;
  Lanes volume = lanes(0.0), sum = lanes(0.0);
  for (int q = 0; q < Q; ++q) {
    volume += batch.weight(q);
    sum += batch.weight(q) * ratios[q];
  }
  result.volume = volume > 0.0 ? volume : lanes(1.0);
  result.ratio = volume > 0.0 ? sum / result.volume : lanes(1.0);
  if (patch_ratio != nullptr) {
    const std::int32_t* patch = group.patches.of_slot.data() + number * kLanes;
    for (int lane = 0; lane < kLanes; ++lane) result.ratio[lane] = patch_ratio[patch[lane]];
  }
  result.pressure = bulk * (result.ratio - 1.0);
  result.energy = 0.5 * volume * result.pressure * (result.ratio - 1.0);
  return result;
}

/// The stress due to the strain history at one point, with b = F H and s = F : b.
struct Overstress {
  material::LanesSymmetric h;
  Lanes3x3 b;
  Lanes3x3 inverse;  // F^-T
  Lanes scale, s;    // J^(-2/3); 1 and 0 for a law that is not split

  /// @param rows six rows of PointHistory::carried. @param split whether H acts on J^(-2/3) C.
  /// @param f,cof,ratio F, its cofactors and its determinant.
  SINEW_INLINE Overstress(const LaneRow* rows, bool split, const Lanes3x3& f, const Lanes3x3& cof,
                          const Lanes& ratio)
      : h{material::load(rows[0].value), material::load(rows[1].value),
          material::load(rows[2].value), material::load(rows[3].value),
          material::load(rows[4].value), material::load(rows[5].value)},
        b(material::multiply(f, h)),
        inverse{},
        scale(lanes(1.0)),
        s(lanes(0.0)) {
    if (!split) return;
    const Lanes root = material::detail::inverse_cube_root(ratio), unit = 1.0 / ratio;
    scale = root * root;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        inverse[r][c] = unit * cof[r][c];
        s += f[r][c] * b[r][c];
      }
    }
  }
  SINEW_INLINE Lanes energy(const Lanes3x3& f) const {
    Lanes sum = lanes(0.0);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) sum += f[r][c] * b[r][c];
    }
    return 0.5 * scale * sum;
  }
  SINEW_INLINE void add_stress(Lanes3x3& piola) const {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) piola[r][c] += scale * (b[r][c] - s / 3.0 * inverse[r][c]);
    }
  }
  /// dP = J^(-2/3) (dF H - 2/3 (T : dF) b - 2/3 (b : dF) T + 2/9 s (T : dF) T + s/3 T dF^T T),
  /// T = F^-T.
  SINEW_INLINE void add_tangent(material::Lanes9x9& a) const {
    const Lanes full[3][3] = {{h.xx, h.xy, h.xz}, {h.xy, h.yy, h.yz}, {h.xz, h.yz, h.zz}};
    const Lanes third = s / 3.0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Lanes mixed = 2.0 / 3.0 * (third * inverse[i][j] - b[i][j]);
        const Lanes spread = 2.0 / 3.0 * inverse[i][j];
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) {
            Lanes value =
                mixed * inverse[r][c] - spread * b[r][c] + third * inverse[i][c] * inverse[r][j];
            if (i == r) value += full[j][c];
            a.m[3 * i + j][3 * r + c] += scale * value;
          }
        }
      }
    }
  }
};

/// Strain history at the points of one batch.
struct BatchHistory {
  const LaneRow* carried = nullptr;  ///< six rows per point
  const LaneRow* peak = nullptr;     ///< one row per point

  SINEW_INLINE BatchHistory(const SolidGroup& group, const PointHistory& history,
                            std::int64_t batch)
      : carried(history.carried == nullptr ? nullptr : history.carried + 6 * group.points * batch),
        peak(history.peak == nullptr ? nullptr : history.peak + group.points * batch) {}

  /// Isochoric response at point q, with softening.
  SINEW_INLINE material::LanesLogResponse respond(const material::Hyperelastic& law,
                                                  const material::Principal& at, int q) const {
    material::LanesLogResponse response = material::respond(law, at);
    if (peak != nullptr) material::soften(*law.mullins, material::load(peak[q].value), response);
    return response;
  }
};

}  // namespace sinew::fem
