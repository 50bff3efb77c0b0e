#include "sinew/fem/solid_kernel.hpp"

#include "sinew/fem/lane_minimum.hpp"
#include "sinew/fem/solid_batch.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;
using material::Lanes;
using material::lanes;
using material::Lanes3x3;
using material::sum;

/// Stiffness and forces of eight elements, summed over points.
template <int N>
struct Sums {
  static constexpr int kPairs = (N * (N + 1) / 2 + 1) / 2 * 2;  // as SolidGroup::pairs()
  Lanes force[N][3] = {};
  Lanes spread[N][3] = {};  // b_a = dV/dx_a
  Lanes block[kPairs][9] = {};

  /// First node that is computed. Shape gradients of a tetrahedron sum to zero, and so do the rows
  /// and columns of its blocks; those of node 0 follow from the others.
  static constexpr int kFirst = N == 4 ? 1 : 0;

  SINEW_INLINE void add_tangent(const material::Lanes9x9& a9, const Lanes (&g)[N][3],
                                const Lanes& weight) {
    for (int b = kFirst; b < N; ++b) {
      Lanes t[9][3];  // (3 i + j, r): sum over c of A(i j, r c) g_b c
      for (int ij = 0; ij < 9; ++ij) {
        for (int r = 0; r < 3; ++r) {
          t[ij][r] = weight * (a9.m[ij][3 * r] * g[b][0] + a9.m[ij][3 * r + 1] * g[b][1] +
                               a9.m[ij][3 * r + 2] * g[b][2]);
        }
      }
      for (int a = kFirst; a <= b; ++a) {
        Lanes* k = block[SolidGroup::pair(a, b)];
        for (int i = 0; i < 3; ++i) {
          for (int r = 0; r < 3; ++r) {
            k[3 * i + r] +=
                g[a][0] * t[3 * i][r] + g[a][1] * t[3 * i + 1][r] + g[a][2] * t[3 * i + 2][r];
          }
        }
      }
    }
  }
  SINEW_INLINE void complete() {
    if constexpr (N == 4) {
      for (int i = 0; i < 3; ++i) {
        for (int r = 0; r < 3; ++r) {
          Lanes corner = lanes(0.0);
          for (int b = 1; b < 4; ++b) {
            Lanes sum = lanes(0.0);
            for (int a = 1; a < 4; ++a) {
              sum += a <= b ? block[SolidGroup::pair(a, b)][3 * i + r]
                            : block[SolidGroup::pair(b, a)][3 * r + i];
            }
            block[SolidGroup::pair(0, b)][3 * i + r] = -sum;
            corner += sum;
          }
          block[SolidGroup::pair(0, 0)][3 * i + r] = corner;
        }
      }
    }
  }
  SINEW_INLINE void add_dilatation(const Lanes& stiffness) {
    for (int b = kFirst; b < N; ++b) {
      for (int a = kFirst; a <= b; ++a) {
        Lanes* k = block[SolidGroup::pair(a, b)];
        for (int i = 0; i < 3; ++i) {
          const Lanes scaled = stiffness * spread[a][i];
          for (int r = 0; r < 3; ++r) k[3 * i + r] += scaled * spread[b][r];
        }
      }
    }
  }
  /// Vectors of all nodes, padded to four. @param vectors force or spread.
  SINEW_INLINE static void store_vectors(const Lanes (&vectors)[N][3], double* records) {
    const Lanes zero = lanes(0.0);
    for (int a = 0; a < N; a += 2) {
      const Lanes(&u)[3] = vectors[a];
      const Lanes(&v)[3] = vectors[a + 1];
      const Lanes rows[8] = {u[0], u[1], u[2], zero, v[0], v[1], v[2], zero};
      store_records(rows, records + 4 * a, 4 * N);
    }
  }
  SINEW_INLINE void store_blocks(double* records) const {
    constexpr int kRecord = kSolidBlock * kPairs;
    for (int pair = 0; pair < kPairs; pair += 2) {
      Lanes rows[2 * kSolidBlock];
      for (int k = 0; k < 2; ++k) {
        for (int c = 0; c < 3; ++c) {  // by columns, padded
          for (int r = 0; r < 3; ++r)
            rows[kSolidBlock * k + 4 * c + r] = block[pair + k][3 * r + c];
          rows[kSolidBlock * k + 4 * c + 3] = lanes(0.0);
        }
      }
      for (int k = 0; k < 2 * kSolidBlock; k += 8) {
        store_records(rows + k, records + kSolidBlock * pair + k, kRecord);
      }
    }
  }
};

/// Null without patches.
const double* patch_ratios_of(const SolidGroup& group, const SolidOutput& output) {
  return group.patches.empty() ? nullptr : output.patch_ratio + group.patches.patches_before;
}

/// Start of the records of a batch that patches sum (see sum_rows()).
double* spread_records(const SolidGroup& group, const SolidOutput& output, std::int64_t batch) {
  return output.spread + 16 * (group.patches.slots_before + kLanes * batch);
}

/// kappa (Jm - 1) with J linearised about the positions before the last motion, J0 + cof F0 : (F -
/// F0); see SolidOutput::start.
/// @param group,batch,number of which batch. @param f F of each point. @param bulk kappa, Pa.
template <int N, int Q>
SINEW_INLINE Lanes linear_pressure(const SolidGroup& group, const Batch<N, Q>& batch,
                                   std::int64_t number, const Lanes3x3 (&f)[Q],
                                   const SolidOutput& output, double bulk) {
  const Batch<N, Q> start(group, number, output.start);
  Lanes ratio[Q];
  for (int q = 0; q < Q; ++q) {
    const Lanes3x3 from = start.deformation(q), cof = material::cofactor(from);
    ratio[q] = material::determinant(from, cof);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) ratio[q] += cof[r][c] * (f[q][r][c] - from[r][c]);
    }
  }
  return shared_dilatation(group, batch, number, ratio, nullptr, bulk).pressure;
}

material::Projection projection_of(Tangent tangent) {
  using enum material::Projection;
  if (tangent == Tangent::rates) return rates;
  return tangent == Tangent::exact ? none : positive;
}

// Compiled with and without blocks, but not for each tangent, since each takes long to compile.
template <int N, int Q, bool kBlocks>
void evaluate(const SolidGroup& group, int begin, int end, const double* points, Tangent tangent,
              const SolidOutput& output, LaneMinimum& minimum) {
  const BulkModuli bulk(group);
  const double* patch_ratio = patch_ratios_of(group, output);
  const bool split = group.law.saint_venant_shear == 0.0;
  for (std::int64_t b = begin; b < end; ++b) {
    const BatchHistory past(group, output.history, b);
    const Batch<N, Q> batch(group, b, points);
    Lanes3x3 f[Q], cof[Q];
    Lanes ratio[Q];
    for (int q = 0; q < Q; ++q) {
      f[q] = batch.deformation(q);
      cof[q] = material::cofactor(f[q]);
      ratio[q] = material::determinant(f[q], cof[q]);
      minimum.see(ratio[q], b);
    }
    const Dilatation shared = shared_dilatation(group, batch, b, ratio, patch_ratio, bulk.shared);
    Lanes lag = lanes(0.0);  // pressure of the tangent minus that of the forces
    if (kBlocks && bulk.dominates && output.start != nullptr && patch_ratio == nullptr) {
      lag = linear_pressure(group, batch, b, f, output, bulk.shared) - shared.pressure;
    }
    Sums<N> sums;
    Lanes energy = shared.energy;
    for (int q = 0; q < Q; ++q) {
      const Lanes weight = batch.weight(q);
      const material::Principal at = material::principal(f[q]);
      material::LanesLogResponse response = past.respond(group.law, at, q);
      if (past.carried != nullptr) material::scale(response, output.history.factor);
      const Lanes off = ratio[q] - shared.ratio, own = bulk.own * off;
      energy += weight * (response.energy + 0.5 * own * off);
      // The stress p cof F adds p J to the derivatives with respect to logarithmic stretches.
      const Lanes push = (shared.pressure + own) * ratio[q];
      const Lanes stiffness = push + bulk.own * ratio[q] * ratio[q];
      for (int i = 0; i < 3; ++i) {
        response.first[i] += push;
        for (int j = 0; j <= i; ++j) response.second[i][j] += stiffness;
      }
      Lanes g[N][3];
      for (int a = 0; a < N; ++a) {
        for (int c = 0; c < 3; ++c) g[a][c] = batch.gradient(q, a, c);
      }
      Lanes3x3 stress = material::first_piola(f[q], at, response);
      if (past.carried != nullptr) {
        const Overstress over(past.carried + 6 * q, split, f[q], cof[q], ratio[q]);
        energy += weight * over.energy(f[q]);
        over.add_stress(stress);
      }
      for (int a = 0; a < N; ++a) {
        for (int r = 0; r < 3; ++r) {
          sums.force[a][r] +=
              weight * (stress[r][0] * g[a][0] + stress[r][1] * g[a][1] + stress[r][2] * g[a][2]);
          sums.spread[a][r] +=
              weight * (cof[q][r][0] * g[a][0] + cof[q][r][1] * g[a][1] + cof[q][r][2] * g[a][2]);
        }
      }
      if constexpr (kBlocks) {
        for (int i = 0; i < 3; ++i) {
          response.first[i] += lag * ratio[q];
          for (int j = 0; j <= i; ++j) response.second[i][j] += lag * ratio[q];
        }
        material::Lanes9x9 a9;
        material::tangent(f[q], at, response, projection_of(tangent), a9);
        if (tangent == Tangent::exact && past.carried != nullptr) {
          Overstress(past.carried + 6 * q, split, f[q], cof[q], ratio[q]).add_tangent(a9);
        }
        sums.add_tangent(a9, g, weight);
      }
    }
    sums.store_vectors(sums.force, output.forces + 4 * (group.first_force + N * kLanes * b));
    output.energy[b] = sum(energy);
    if constexpr (kBlocks) {
      if constexpr (N == 4) {
        if (patch_ratio != nullptr) {
          sums.store_vectors(sums.spread, spread_records(group, output, b));
        }
      }
      if (Q > 1) sums.add_dilatation((bulk.shared - bulk.own) / shared.volume);
      sums.complete();
      sums.store_blocks(output.blocks +
                        kSolidBlock * (group.first_block + Sums<N>::kPairs * kLanes * b));
    }
  }
}

/// Whether psi_iso = c (I - 3), which is evaluated by invariants, without principal stretches.
bool is_neo_hookean(const material::Hyperelastic& law) {
  return law.powers.size() == 1 && law.powers.front().exponent == 2.0 && law.polynomial.empty() &&
         law.saint_venant_shear == 0.0;
}

/// Neo-Hookean tetrahedra. With H = F^-T, m = 2 c J^(-2/3), I1 = F : F, h_a = H g_a, f_a = F g_a,
///   P = m F + s H,   s = p J - m I1/3,   p = kappa (Jm - 1) + kappa' (J - Jm),
///   K_ab = V { m (g_a . g_b) I - 2/3 m (f_a h_b^T + h_a f_b^T)
///              + (2/9 m I1 + p J + kappa' J^2) h_a h_b^T - s h_b h_a^T },
/// from dJ = J H : dF and dH = -H dF^T H. Without patches, Jm = J and kappa' = kappa, and the p of
/// the tangent may be that of SolidOutput::start.
template <bool kBlocks>
void evaluate_neo_hookean(const SolidGroup& group, int begin, int end, const double* points,
                          const SolidOutput& output, LaneMinimum& minimum) {
  const double c = group.law.powers.front().coefficient;
  const BulkModuli bulk(group);
  const double* patch_ratio = patch_ratios_of(group, output);
  for (std::int64_t b = begin; b < end; ++b) {
    const Batch<4, 1> batch(group, b, points);
    const Lanes volume = batch.weight(0);
    const Lanes3x3 f = batch.deformation(0), cof = material::cofactor(f);
    const Lanes j = material::determinant(f, cof);
    minimum.see(j, b);
    const Lanes root = material::detail::inverse_cube_root(j);
    const Lanes m = 2.0 * c * root * root;
    Lanes i1 = lanes(0.0);
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) i1 += f[r][k] * f[r][k];
    }
    const Dilatation shared = shared_dilatation(group, batch, b, {j}, patch_ratio, bulk.shared);
    const Lanes off = j - shared.ratio, own = bulk.own * off;
    const Lanes push = (shared.pressure + own) * j;
    const Lanes s = push - m * i1 / 3.0;
    output.energy[b] = sum(volume * (0.5 * m * i1 - 3.0 * c + 0.5 * own * off) + shared.energy);
    const Lanes inverse = 1.0 / j;
    Lanes g[4][3], h[4][3], fg[4][3];
    Sums<4> sums;
    for (int a = 1; a < 4; ++a) {
      for (int k = 0; k < 3; ++k) g[a][k] = batch.gradient(0, a, k);
      for (int r = 0; r < 3; ++r) {
        h[a][r] = inverse * (cof[r][0] * g[a][0] + cof[r][1] * g[a][1] + cof[r][2] * g[a][2]);
        fg[a][r] = f[r][0] * g[a][0] + f[r][1] * g[a][1] + f[r][2] * g[a][2];
        sums.force[a][r] = volume * (m * fg[a][r] + s * h[a][r]);
      }
    }
    for (int r = 0; r < 3; ++r) {
      sums.force[0][r] = -(sums.force[1][r] + sums.force[2][r] + sums.force[3][r]);
    }
    sums.store_vectors(sums.force, output.forces + 4 * (group.first_force + 4 * kLanes * b));
    if constexpr (kBlocks) {
      if (patch_ratio != nullptr) {
        for (int r = 0; r < 3; ++r) {
          sums.spread[0][r] = lanes(0.0);
          for (int a = 1; a < 4; ++a) {
            sums.spread[a][r] = volume * j * h[a][r];
            sums.spread[0][r] -= sums.spread[a][r];
          }
        }
        sums.store_vectors(sums.spread, spread_records(group, output, b));
      }
      Lanes lag = lanes(0.0);
      if (bulk.dominates && output.start != nullptr && patch_ratio == nullptr) {
        lag = j *
              (linear_pressure<4, 1>(group, batch, b, {f}, output, bulk.shared) - shared.pressure);
      }
      const Lanes vm = volume * m, vs = volume * (s + lag);
      const Lanes mixed = -2.0 / 3.0 * vm;
      const Lanes square = volume * (2.0 / 9.0 * m * i1 + push + lag + bulk.own * j * j);
      for (int bb = 1; bb < 4; ++bb) {
        Lanes right[3];  // factor of h_a
        for (int r = 0; r < 3; ++r) right[r] = mixed * fg[bb][r] + square * h[bb][r];
        for (int a = 1; a <= bb; ++a) {
          Lanes* k = sums.block[SolidGroup::pair(a, bb)];
          const Lanes diagonal =
              vm * (g[a][0] * g[bb][0] + g[a][1] * g[bb][1] + g[a][2] * g[bb][2]);
          for (int i = 0; i < 3; ++i) {
            const Lanes left = mixed * fg[a][i];
            const Lanes swapped = vs * h[bb][i];
            for (int r = 0; r < 3; ++r) {
              k[3 * i + r] = left * h[bb][r] + h[a][i] * right[r] - swapped * h[a][r];
            }
            k[4 * i] += diagonal;
          }
        }
      }
      sums.complete();
      sums.store_blocks(output.blocks +
                        kSolidBlock * (group.first_block + Sums<4>::kPairs * kLanes * b));
    }
  }
}

template <int N, int Q>
void evaluate_kind(const SolidGroup& group, int begin, int end, const double* points,
                   Tangent tangent, const SolidOutput& output, LaneMinimum& minimum) {
  if (tangent == Tangent::none) {
    evaluate<N, Q, false>(group, begin, end, points, tangent, output, minimum);
  } else {
    evaluate<N, Q, true>(group, begin, end, points, tangent, output, minimum);
  }
}

}  // namespace

SmallestRatio evaluate_solids(const SolidGroup& group, int begin, int end, const double* points,
                              Tangent tangent, const SolidOutput& output) {
  LaneMinimum minimum;
  const bool elastic = output.history.carried == nullptr && output.history.peak == nullptr;
  const bool fast = group.nodes == 4 && elastic && is_neo_hookean(group.law);
  if (fast && tangent == Tangent::exact) {
    evaluate_neo_hookean<true>(group, begin, end, points, output, minimum);
  } else if (fast && tangent == Tangent::none) {
    evaluate_neo_hookean<false>(group, begin, end, points, output, minimum);
  } else if (group.nodes == 4) {
    evaluate_kind<4, 1>(group, begin, end, points, tangent, output, minimum);
  } else if (group.nodes == 10) {
    evaluate_kind<10, 4>(group, begin, end, points, tangent, output, minimum);
  } else {
    evaluate_kind<8, 8>(group, begin, end, points, tangent, output, minimum);
  }
  return smallest(minimum, group.element, group.first_slot);
}

}  // namespace sinew::fem
