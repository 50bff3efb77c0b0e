#include "sinew/fem/element_points.hpp"

#include <array>
#include <vector>

#include "sinew/fem/element_batches.hpp"
#include "sinew/fem/element_gradient.hpp"
#include "sinew/fem/element_history.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/fem/solid_kernel.hpp"
#include "sinew/material/response.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;
using material::Lanes;
using material::Lanes3x3;
using material::load;

Lanes3x3 load_matrix(const LaneRow (&rows)[3][3]) {
  Lanes3x3 m;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m[r][c] = load(rows[r][c].value);
  }
  return m;
}

Lanes3x3 cauchy_of(const Lanes3x3& piola, const Lanes3x3& f) {
  const Lanes inverse = 1.0 / material::determinant(f, material::cofactor(f));
  Lanes3x3 s;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      s[r][c] = inverse * (piola[r][0] * f[c][0] + piola[r][1] * f[c][1] + piola[r][2] * f[c][2]);
    }
  }
  return s;
}

template <material::Law law>
void respond(const BatchConstants& batch, PointBatch& point) {
  const material::Response response =
      material::respond<law>(point.deformation, {load(batch.mu.value), load(batch.lambda.value)});
  point.piola = response.stress;
  point.cauchy = law == material::Law::linear ? response.stress
                                              : cauchy_of(response.stress, point.deformation);
  point.energy = response.energy;
}

void visit_tetrahedra(const HasMaterial& body,
                      const std::function<void(const PointBatch&)>& visit) {
  const ElementBatches& elements = body.material().elements().elements();
  const std::span<const std::int32_t> numbers(elements.tetrahedron), nodes(elements.nodes);
  PointBatch point;
  for (int b = 0; b < elements.batches(); ++b) {
    const auto slot = static_cast<std::size_t>(b) * kLanes;
    const BatchConstants& batch = elements.constants[static_cast<std::size_t>(b)];
    point.element = numbers.subspan(slot, kLanes);
    point.node = nodes.subspan(4 * slot, 4 * std::size_t{kLanes});
    point.weight = load(batch.volume.value);
    point.deformation = deformation_gradient(batch, point.node.data(), body.positions(),
                                             body.material().elements().mesh().nodes);
    for (int c = 0; c < 3; ++c) {
      point.gradient[0][c] = material::lanes(0.0);
      for (int a = 1; a < 4; ++a) {
        point.gradient[a][c] = load(batch.gradient[a - 1][c].value);
        point.gradient[0][c] -= point.gradient[a][c];
      }
    }
    if (b < elements.linear_batches) {
      respond<material::Law::linear>(batch, point);
    } else {
      respond<material::Law::corotational>(batch, point);
    }
    visit(point);
  }
}

void visit_solids(const SolidGroup& group, const std::vector<double>& positions,
                  const PointHistory& history,
                  const std::function<void(const PointBatch&)>& visit) {
  const std::span<const std::int32_t> numbers(group.element), nodes(group.node);
  const auto count = static_cast<std::size_t>(group.nodes);
  std::array<SolidState, 8> states;
  const auto at = std::span(states).first(static_cast<std::size_t>(group.points));
  const std::vector<double> ratios = patch_ratios(group, positions.data());
  const double* patch_ratio = ratios.empty() ? nullptr : ratios.data();
  PointBatch point;
  point.nodes = count;
  for (int b = 0; b < group.batches(); ++b) {
    const auto slot = static_cast<std::size_t>(b) * kLanes;
    state_batch(group, b, positions.data(), patch_ratio, history, at);
    point.element = numbers.subspan(slot, kLanes);
    point.node = nodes.subspan(count * slot, count * kLanes);
    for (const SolidState& state : at) {
      point.weight = load(state.weight.value);
      point.deformation = load_matrix(state.deformation);
      point.piola = load_matrix(state.piola);
      point.cauchy = cauchy_of(point.piola, point.deformation);
      point.energy = load(state.energy.value);
      for (std::size_t a = 0; a < count; ++a) {
        for (int c = 0; c < 3; ++c) point.gradient[a][c] = load(state.gradient[a][c].value);
      }
      visit(point);
    }
  }
}

}  // namespace

void visit_points(const HasMaterial& body,
                  const std::function<void(const PointBatch&)>& visit_scaled) {
  const double factor = body.stiffness_factor();
  const auto visit = [&](const PointBatch& point) {
    if (factor == 1.0) return visit_scaled(point);
    PointBatch own = point;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        own.piola[r][c] *= factor;
        own.cauchy[r][c] *= factor;
      }
    }
    own.energy *= factor;
    visit_scaled(own);
  };
  visit_tetrahedra(body, visit);
  const auto& solids = body.material().elements().solids();
  if (solids.empty()) return;
  std::vector<double> padded(4 * static_cast<std::size_t>(body.positions().rows()), 0.0);
  for (Eigen::Index i = 0; i < body.positions().rows(); ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      padded[static_cast<std::size_t>(4 * i + c)] = body.positions()(i, c);
    }
  }
  std::vector<LaneRow> overstress;
  for (std::size_t g = 0; g < solids.size(); ++g) {
    visit_solids(solids[g], padded, body.history().present(g, overstress), visit);
  }
}

}  // namespace sinew::fem
