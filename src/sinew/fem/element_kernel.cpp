#include "sinew/fem/element_kernel.hpp"

#include "sinew/fem/lane_minimum.hpp"
#include "sinew/fem/lane_stretch.hpp"
#include "sinew/fem/transpose.hpp"
#include "sinew/material/response.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;
using material::Lanes;
using material::lanes;
using material::Lanes3x3;
using material::LanesSymmetric;
using material::Law;
using material::sum;

SINEW_INLINE Lanes row(const LaneRow& source) { return material::load(source.value); }

/// One vector per node of an element: v[a][component].
struct NodeVectors {
  Lanes v[4][3];

  /// Computes v[0]: shape gradients sum to zero over the nodes, and so does everything linear in
  /// them.
  SINEW_INLINE void complete() {
    for (int c = 0; c < 3; ++c) v[0][c] = -(v[1][c] + v[2][c] + v[3][c]);
  }
  SINEW_INLINE void store(double* records, int stride) const {
    const Lanes zero = lanes(0.0);
    for (int a = 0; a < 4; a += 2) {
      const Lanes rows[8] = {v[a][0],     v[a][1],     v[a][2],     zero,
                             v[a + 1][0], v[a + 1][1], v[a + 1][2], zero};
      store_records(rows, records + 4 * a, stride);
    }
  }
};

SINEW_INLINE Lanes3x3 deformation_gradient(const BatchConstants& batch, const std::int32_t* nodes,
                                           const double* points) {
  Lanes origin[3], point[3];
  load_points(points, nodes, origin);
  Lanes3x3 f{};
  for (int a = 1; a < 4; ++a) {
    load_points(points, nodes + kLanes * a, point);
    for (int r = 0; r < 3; ++r) {
      const Lanes edge = point[r] - origin[r];
      for (int c = 0; c < 3; ++c) f[r][c] += edge * row(batch.gradient[a - 1][c]);
    }
  }
  return f;
}

/// scale m g_a for all nodes.
SINEW_INLINE NodeVectors on_gradients(const Lanes3x3& m, const BatchConstants& batch,
                                      const Lanes& scale) {
  NodeVectors result;
  for (int a = 1; a < 4; ++a) {
    const LaneRow(&g)[3] = batch.gradient[a - 1];
    for (int r = 0; r < 3; ++r) {
      result.v[a][r] = scale * (m[r][0] * row(g[0]) + m[r][1] * row(g[1]) + m[r][2] * row(g[2]));
    }
  }
  result.complete();
  return result;
}

SINEW_INLINE NodeVectors on_vectors(const LanesSymmetric& m, const NodeVectors& x) {
  NodeVectors result;
  for (int a = 1; a < 4; ++a) {
    result.v[a][0] = m.xx * x.v[a][0] + m.xy * x.v[a][1] + m.xz * x.v[a][2];
    result.v[a][1] = m.xy * x.v[a][0] + m.yy * x.v[a][1] + m.yz * x.v[a][2];
    result.v[a][2] = m.xz * x.v[a][0] + m.yz * x.v[a][1] + m.zz * x.v[a][2];
  }
  result.complete();
  return result;
}

/// Record layout of kExactRecord.
SINEW_INLINE void store_exact(const NodeVectors& h, const material::ExactTangent& tangent,
                              const Lanes& mu, double* records) {
  const NodeVectors p = on_vectors(tangent.g, h);
  const Lanes kappa = tangent.kappa / mu;
  Lanes rows[kExactRecord];
  for (int a = 0; a < 4; ++a) {
    for (int c = 0; c < 3; ++c) {
      rows[4 * a + c] = h.v[a][c];
      rows[kStretchedPosition + 4 * a + c] = p.v[a][c];
    }
    for (int b = 0; b <= a; ++b) {
      rows[kPairPosition[4 * a + b]] =
          kappa * (h.v[a][0] * p.v[b][0] + h.v[a][1] * p.v[b][1] + h.v[a][2] * p.v[b][2]);
    }
  }
  const LanesSymmetric& g = tangent.g;
  const Lanes columns[3][3] = {{g.xx, g.xy, g.xz}, {g.xy, g.yy, g.yz}, {g.xz, g.yz, g.zz}};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) rows[kColumnsPosition + 4 * c + r] = columns[c][r];
  }
  rows[kKappaPosition] = -kappa;
  for (int k = kKappaPosition + 1; k < kExactRecord; ++k) rows[k] = lanes(0.0);
  for (int k = 0; k < kExactRecord; k += 8) store_records(rows + k, records + k, kExactRecord);
}

struct Minima {
  LaneMinimum volume, stretch;  // of BatchMeasures
};

/// F^-T, which maps gradients to the current shape. The determinant counts as at least 0.1, for
/// crushed elements.
SINEW_INLINE Lanes3x3 to_present(const Lanes3x3& f) {
  constexpr double kMinRatio = 0.1;
  const Lanes3x3 cof = material::cofactor(f);
  const Lanes ratio = material::maximum(material::determinant(f, cof), lanes(kMinRatio));
  Lanes3x3 result;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result[r][c] = cof[r][c] / ratio;
  }
  return result;
}

template <Law law, Tangent tangent>
void evaluate(const ElementBatches& elements, int begin, int end, const double* points,
              const ElementOutput& output, Minima& minima) {
  for (std::int64_t b = begin; b < end; ++b) {
    const BatchConstants& batch = elements.constants[static_cast<std::size_t>(b)];
    const material::LaneModuli moduli{row(batch.mu), row(batch.lambda)};
    const Lanes3x3 f = deformation_gradient(batch, elements.nodes.data() + 4 * kLanes * b, points);
    const material::Response response = material::respond<law>(f, moduli);
    const Lanes volume = row(batch.volume);
    on_gradients(response.stress, batch, volume)
        .store(output.forces + kForceRecord * kLanes * b, kForceRecord);
    output.energy[b] = sum(volume * response.energy);
    minima.volume.see(response.determinant, b);
    minima.stretch.see(-squared_norm(f), b);
    if constexpr (tangent == Tangent::rates && law == Law::corotational) {
      on_gradients(to_present(f), batch, row(batch.root))
          .store(output.records + kCorotatedRecord * kLanes * b, kCorotatedRecord);
    } else if constexpr (tangent != Tangent::none) {
      const NodeVectors h = on_gradients(response.rotation, batch, row(batch.root));
      if constexpr (tangent == Tangent::corotated || tangent == Tangent::rates) {
        h.store(output.records + kCorotatedRecord * kLanes * b, kCorotatedRecord);
      } else {
        const material::ExactTangent full =
            tangent == Tangent::exact ? material::exact_tangent<law>(f, moduli, response)
                                      : material::projected_tangent<law>(f, moduli, response);
        store_exact(h, full, moduli.mu, output.records + kExactRecord * kLanes * b);
      }
    }
  }
}

template <Tangent tangent>
void evaluate_laws(const ElementBatches& elements, int begin, int end, const double* points,
                   const ElementOutput& output, Minima& minima) {
  const int linear = elements.linear_batches;
  const int split = begin > linear ? begin : (end < linear ? end : linear);
  evaluate<Law::linear, tangent>(elements, begin, split, points, output, minima);
  evaluate<Law::corotational, tangent>(elements, split, end, points, output, minima);
}

}  // namespace

BatchMeasures evaluate_batches(const ElementBatches& elements, int begin, int end,
                               const double* points, Tangent tangent, const ElementOutput& output) {
  Minima minima;
  switch (tangent) {
    case Tangent::none:
      evaluate_laws<Tangent::none>(elements, begin, end, points, output, minima);
      break;
    case Tangent::corotated:
      evaluate_laws<Tangent::corotated>(elements, begin, end, points, output, minima);
      break;
    case Tangent::rates:
      evaluate_laws<Tangent::rates>(elements, begin, end, points, output, minima);
      break;
    case Tangent::projected:
      evaluate_laws<Tangent::projected>(elements, begin, end, points, output, minima);
      break;
    case Tangent::exact:
      evaluate_laws<Tangent::exact>(elements, begin, end, points, output, minima);
      break;
  }
  return {smallest(minima.volume, elements.tetrahedron, 0),
          smallest(minima.stretch, elements.tetrahedron, 0)};
}

SmallestRatio measure_batches(const ElementBatches& elements, int begin, int end,
                              const double* points) {
  LaneMinimum minimum;
  for (std::int64_t b = begin; b < end; ++b) {
    const BatchConstants& batch = elements.constants[static_cast<std::size_t>(b)];
    const std::int32_t* nodes = elements.nodes.data() + 4 * kLanes * b;
    const Lanes3x3 f = deformation_gradient(batch, nodes, points);
    minimum.see(material::determinant(f, material::cofactor(f)), b);
  }
  return smallest(minimum, elements.tetrahedron, 0);
}

SmallestRatio measure_batch_stretch(const ElementBatches& elements, int begin, int end,
                                    const double* points) {
  LaneMinimum minimum;
  for (std::int64_t b = begin; b < end; ++b) {
    const BatchConstants& batch = elements.constants[static_cast<std::size_t>(b)];
    const std::int32_t* nodes = elements.nodes.data() + 4 * kLanes * b;
    minimum.see(-largest_stretch(deformation_gradient(batch, nodes, points)), b);
  }
  return smallest(minimum, elements.tetrahedron, 0);
}

}  // namespace sinew::fem
