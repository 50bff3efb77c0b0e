// Evaluations of hyperelastic elements without forces: volume ratios, states and strain history.
#include "sinew/fem/lane_minimum.hpp"
#include "sinew/fem/lane_stretch.hpp"
#include "sinew/fem/solid_batch.hpp"
#include "sinew/fem/solid_kernel.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;
using material::Lanes;
using material::lanes;
using material::Lanes3x3;

template <int N, int Q>
void measure(const SolidGroup& group, int begin, int end, const double* points,
             LaneMinimum& minimum) {
  for (std::int64_t b = begin; b < end; ++b) {
    const Batch<N, Q> batch(group, b, points);
    for (int q = 0; q < Q; ++q) {
      const Lanes3x3 f = batch.deformation(q);
      minimum.see(material::determinant(f, material::cofactor(f)), b);
    }
  }
}

template <int N, int Q>
void measure_stretch(const SolidGroup& group, int begin, int end, const double* points,
                     LaneMinimum& minimum) {
  for (std::int64_t b = begin; b < end; ++b) {
    const Batch<N, Q> batch(group, b, points);
    for (int q = 0; q < Q; ++q) minimum.see(-largest_stretch(batch.deformation(q)), b);
  }
}

template <int N, int Q>
void measure_relaxing(const SolidGroup& group, int number, const double* points,
                      const PointHistory& history, LaneRow* stress, LaneRow* energy) {
  const BatchHistory past(group, history, number);
  const Batch<N, Q> batch(group, number, points);
  for (int q = 0; q < Q; ++q) {
    const material::Principal at = material::principal(batch.deformation(q));
    material::store(energy[q].value, material::respond(group.law, at).energy);
    const material::LanesSymmetric s = material::second_piola(at, past.respond(group.law, at, q));
    Lanes scale = lanes(1.0);
    if (group.law.saint_venant_shear == 0.0) {
      const Lanes root = 1.0 / material::detail::inverse_cube_root(at.determinant);
      scale = root * root;
    }
    const Lanes* parts[6] = {&s.xx, &s.yy, &s.zz, &s.xy, &s.xz, &s.yz};
    for (int c = 0; c < 6; ++c) material::store(stress[6 * q + c].value, scale * *parts[c]);
  }
}

template <int N, int Q>
void measure_states(const SolidGroup& group, int number, const double* points,
                    const double* patch_ratio, const PointHistory& history,
                    std::span<SolidState> result) {
  const BulkModuli bulk(group);
  const BatchHistory past(group, history, number);
  const Batch<N, Q> batch(group, number, points);
  Lanes3x3 f[Q];
  Lanes ratio[Q];
  for (int q = 0; q < Q; ++q) {
    f[q] = batch.deformation(q);
    ratio[q] = material::determinant(f[q], material::cofactor(f[q]));
  }
  const Dilatation shared =
      shared_dilatation(group, batch, number, ratio, patch_ratio, bulk.shared);
  for (int q = 0; q < Q; ++q) {
    const material::Principal at = material::principal(f[q]);
    material::LanesLogResponse response = past.respond(group.law, at, q);
    const Lanes off = ratio[q] - shared.ratio;
    const Lanes pressure = shared.pressure + bulk.own * off;
    response.energy += 0.5 * (shared.pressure * (shared.ratio - 1.0) + bulk.own * off * off);
    for (Lanes& first : response.first) first += pressure * ratio[q];
    Lanes3x3 stress = material::first_piola(f[q], at, response);
    if (past.carried != nullptr) {
      const bool split = group.law.saint_venant_shear == 0.0;
      Overstress(past.carried + 6 * q, split, f[q], material::cofactor(f[q]), ratio[q])
          .add_stress(stress);
    }
    SolidState& to = result[static_cast<std::size_t>(q)];
    material::store(to.weight.value, batch.weight(q));
    material::store(to.energy.value, response.energy);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        material::store(to.deformation[r][c].value, f[q][r][c]);
        material::store(to.piola[r][c].value, stress[r][c]);
      }
    }
    for (int a = 0; a < N; ++a) {
      for (int c = 0; c < 3; ++c) {
        material::store(to.gradient[a][c].value, batch.gradient(q, a, c));
      }
    }
  }
}

}  // namespace

void state_batch(const SolidGroup& group, int batch, const double* points,
                 const double* patch_ratio, const PointHistory& history,
                 std::span<SolidState> result) {
  if (group.nodes == 4) {
    measure_states<4, 1>(group, batch, points, patch_ratio, history, result);
  } else if (group.nodes == 10) {
    measure_states<10, 4>(group, batch, points, nullptr, history, result);
  } else {
    measure_states<8, 8>(group, batch, points, nullptr, history, result);
  }
}

void relaxing_stress(const SolidGroup& group, int batch, const double* points,
                     const PointHistory& history, LaneRow* stress, LaneRow* energy) {
  if (group.nodes == 4) {
    measure_relaxing<4, 1>(group, batch, points, history, stress, energy);
  } else if (group.nodes == 10) {
    measure_relaxing<10, 4>(group, batch, points, history, stress, energy);
  } else {
    measure_relaxing<8, 8>(group, batch, points, history, stress, energy);
  }
}

void volume_ratios(const SolidGroup& group, int begin, int end, const double* points,
                   double* ratios) {
  for (std::int64_t b = begin; b < end; ++b) {
    const Batch<4, 1> batch(group, b, points);
    const Lanes3x3 f = batch.deformation(0);
    material::store(ratios + kLanes * b, material::determinant(f, material::cofactor(f)));
  }
}

SmallestRatio measure_solids(const SolidGroup& group, int begin, int end, const double* points) {
  LaneMinimum minimum;
  if (group.nodes == 4) {
    measure<4, 1>(group, begin, end, points, minimum);
  } else if (group.nodes == 10) {
    measure<10, 4>(group, begin, end, points, minimum);
  } else {
    measure<8, 8>(group, begin, end, points, minimum);
  }
  return smallest(minimum, group.element, group.first_slot);
}

SmallestRatio measure_solid_stretch(const SolidGroup& group, int begin, int end,
                                    const double* points) {
  LaneMinimum minimum;
  if (group.nodes == 4) {
    measure_stretch<4, 1>(group, begin, end, points, minimum);
  } else if (group.nodes == 10) {
    measure_stretch<10, 4>(group, begin, end, points, minimum);
  } else {
    measure_stretch<8, 8>(group, begin, end, points, minimum);
  }
  return smallest(minimum, group.element, group.first_slot);
}

}  // namespace sinew::fem
