#include "sinew/fem/nodal_fields.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/fem/element_batches.hpp"
#include "sinew/fem/element_gradient.hpp"
#include "sinew/fem/solid_kernel.hpp"
#include "sinew/material/response.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;
using material::Lanes;
using material::lanes;
using material::Lanes3x3;
using material::Law;

// |dev m|^2 of the symmetric part.
SINEW_INLINE Lanes deviator_square(const Lanes3x3& m) {
  const Lanes mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
  Lanes square = lanes(0.0);
  for (int r = 0; r < 3; ++r) {
    const Lanes d = m[r][r] - mean;
    square += d * d;
    for (int c = 0; c < r; ++c) {
      const Lanes s = 0.5 * (m[r][c] + m[c][r]);
      square += 2.0 * s * s;
    }
  }
  return square;
}

// R^T F - I.
SINEW_INLINE Lanes3x3 biot_strain(const Lanes3x3& f, const Lanes3x3& rotation) {
  Lanes3x3 e;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      e[r][c] = rotation[0][r] * f[0][c] + rotation[1][r] * f[1][c] + rotation[2][r] * f[2][c] -
                (r == c ? 1.0 : 0.0);
    }
  }
  return e;
}

SINEW_INLINE Lanes3x3 cauchy_stress(const Lanes3x3& f, const material::Response& response) {
  Lanes3x3 s;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      s[r][c] = (response.stress[r][0] * f[c][0] + response.stress[r][1] * f[c][1] +
                 response.stress[r][2] * f[c][2]) /
                response.determinant;
    }
  }
  return s;
}

template <Law law>
Lanes von_mises_stress(const Lanes3x3& f, const material::LaneModuli& moduli) {
  const material::Response response = material::respond<law>(f, moduli);
  const Lanes3x3 s = law == Law::linear ? response.stress : cauchy_stress(f, response);
  return material::square_root(1.5 * deviator_square(s));
}

template <Law law>
Lanes equivalent_strain(const Lanes3x3& f, const material::LaneModuli& moduli) {
  const material::Response response = material::respond<law>(f, moduli);
  return material::square_root(2.0 / 3.0 * deviator_square(biot_strain(f, response.rotation)));
}

/// Adds a value to all nodes of an element.
void add_share(const SolidGroup& group, std::size_t slot, double value, std::span<double> nodes) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(group.nodes); ++a) {
    nodes[static_cast<std::size_t>(group.node_of(slot, a))] += value;
  }
}

}  // namespace

NodalFields::NodalFields(const FemBodyModel& model)
    : model_(model),
      shares_(static_cast<std::size_t>(model.mesh().nodes.rows()), 0.0),
      forces_(Points::Zero(model.mesh().nodes.rows(), 3)) {
  const ElementBatches& elements = model.elements().elements();
  for (std::size_t slot = 0; slot < elements.tetrahedron.size(); ++slot) {
    const std::size_t batch = slot / kLanes, lane = slot % kLanes;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto node = elements.nodes[(4 * batch + a) * kLanes + lane];
      shares_[static_cast<std::size_t>(node)] += elements.constants[batch].volume.value[lane];
    }
  }
  for (const SolidGroup& group : model.elements().solids()) {
    for (std::size_t slot = 0; slot < group.element.size(); ++slot) {
      for (int q = 0; q < group.points; ++q) add_share(group, slot, group.weight(slot, q), shares_);
    }
    points_.resize(4 * static_cast<std::size_t>(model.mesh().nodes.rows()));
  }
}

void NodalFields::displacement(const FemBody& body, std::span<double> values) const {
  const Points& rest = model_.mesh().nodes;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    values[static_cast<std::size_t>(i)] = (body.positions().row(i) - rest.row(i)).norm();
  }
}

template <NodalFields::Measure measure>
void NodalFields::evaluate(const FemBody& body, std::span<double> values) {
  std::ranges::fill(values, 0.0);
  const ElementBatches& elements = model_.elements().elements();
  for (int b = 0; b < elements.batches(); ++b) {
    const BatchConstants& batch = elements.constants[static_cast<std::size_t>(b)];
    const std::int32_t* nodes = elements.nodes.data() + std::ptrdiff_t{4} * kLanes * b;
    const Lanes3x3 f = deformation_gradient(batch, nodes, body.positions(), model_.mesh().nodes);
    const material::LaneModuli moduli{material::load(batch.mu.value),
                                      material::load(batch.lambda.value)};
    const bool linear = b < elements.linear_batches;
    Lanes value;
    if constexpr (measure == Measure::strain) {
      value = linear ? equivalent_strain<Law::linear>(f, moduli)
                     : equivalent_strain<Law::corotational>(f, moduli);
    } else {
      value = linear ? von_mises_stress<Law::linear>(f, moduli)
                     : von_mises_stress<Law::corotational>(f, moduli);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const double volume = batch.volume.value[lane];
      if (volume == 0.0) continue;  // fills up the batch
      for (int a = 0; a < 4; ++a) {
        values[static_cast<std::size_t>(nodes[kLanes * a + lane])] += volume * value[lane];
      }
    }
  }
  add_solids(body, measure, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (shares_[i] > 0.0) values[i] /= shares_[i];
  }
}

void NodalFields::add_solids(const FemBody& body, Measure measure, std::span<double> values) {
  if (model_.elements().solids().empty()) return;
  for (Eigen::Index i = 0; i < body.positions().rows(); ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      points_[static_cast<std::size_t>(4 * i + c)] = body.positions()(i, c);
    }
  }
  std::array<SolidMeasures, 8> measures;
  for (std::size_t g = 0; g < model_.elements().solids().size(); ++g) {
    const SolidGroup& group = model_.elements().solids()[g];
    std::vector<LaneRow> overstress;
    const PointHistory history = body.history().present(g, overstress);
    const auto points = static_cast<std::size_t>(group.points);
    for (int b = 0; b < group.batches(); ++b) {
      measure_batch(group, b, points_.data(), history, std::span(measures).first(points));
      for (std::size_t q = 0; q < points; ++q) {
        const SolidMeasures& m = measures[q];
        const LaneRow& value = measure == Measure::strain ? m.strain : m.von_mises;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          if (m.weight.value[lane] == 0.0) continue;
          add_share(group, kLanes * static_cast<std::size_t>(b) + lane,
                    m.weight.value[lane] * value.value[lane], values);
        }
      }
    }
  }
}

void NodalFields::strain(const FemBody& body, std::span<double> values) {
  evaluate<Measure::strain>(body, values);
}

void NodalFields::stress(const FemBody& body, std::span<double> values) {
  evaluate<Measure::stress>(body, values);
}

void NodalFields::row_force(const FemBody& body, std::span<const double> effort,
                            std::span<double> values) {
  forces_.setZero();
  body.add_row_forces(effort, forces_);
  for (Eigen::Index i = 0; i < forces_.rows(); ++i) {
    values[static_cast<std::size_t>(i)] = forces_.row(i).norm();
  }
}

}  // namespace sinew::fem
