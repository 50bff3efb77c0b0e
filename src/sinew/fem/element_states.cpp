#include "sinew/fem/element_states.hpp"

#include <array>

#include <Eigen/LU>

#include "sinew/fem/element_batches.hpp"
#include "sinew/fem/element_gradient.hpp"
#include "sinew/fem/solid_kernel.hpp"
#include "sinew/material/response.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;

Matrix3 lane_of(const material::Lanes3x3& m, std::size_t lane) {
  Matrix3 result;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result(r, c) = m[r][c][lane];
  }
  return result;
}

Matrix3 lane_of(const LaneRow (&m)[3][3], std::size_t lane) {
  Matrix3 result;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result(r, c) = m[r][c].value[lane];
  }
  return result;
}

template <material::Law law>
void add_batch(const FemBody& body, int number, ElementStates& states) {
  const ElementBatches& elements = body.fem_model().elements().elements();
  const BatchConstants& batch = elements.constants[static_cast<std::size_t>(number)];
  const std::int32_t* nodes = elements.nodes.data() + std::ptrdiff_t{4} * kLanes * number;
  const auto f =
      deformation_gradient(batch, nodes, body.positions(), body.fem_model().mesh().nodes);
  const material::Response response = material::respond<law>(
      f, {material::load(batch.mu.value), material::load(batch.lambda.value)});
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto slot = static_cast<std::size_t>(number) * kLanes + lane;
    if (elements.tetrahedron[slot] < 0) continue;
    const auto e = static_cast<std::size_t>(elements.tetrahedron[slot]);
    const double volume = batch.volume.value[lane];
    states.volume[e] = volume;
    states.deformation[e] = lane_of(f, lane);
    states.piola[e] = lane_of(response.stress, lane);
    states.cauchy[e] = law == material::Law::linear
                           ? states.piola[e]
                           : Matrix3(states.piola[e] * states.deformation[e].transpose() /
                                     states.deformation[e].determinant());
    Vector3 rest = Vector3::Zero();
    for (std::size_t a = 1; a < 4; ++a) {
      Vector3 g;
      for (int c = 0; c < 3; ++c) g[c] = batch.gradient[a - 1][c].value[lane];
      const Vector3 force = -volume * (states.piola[e] * g);
      states.forces.row(nodes[kLanes * a + lane]) += force.transpose();
      rest -= force;
    }
    states.forces.row(nodes[lane]) += rest.transpose();
  }
}

void add_group(const SolidGroup& group, const std::vector<double>& points,
               const PointHistory& history, ElementStates& states) {
  std::array<SolidState, 8> at;
  const auto count = static_cast<std::size_t>(group.points);
  const std::vector<double> ratios = patch_ratios(group, points.data());
  const double* patch_ratio = ratios.empty() ? nullptr : ratios.data();
  for (int b = 0; b < group.batches(); ++b) {
    state_batch(group, b, points.data(), patch_ratio, history, std::span(at).first(count));
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t slot = static_cast<std::size_t>(b) * kLanes + lane;
      if (group.element[slot] < 0) continue;
      const auto e = static_cast<std::size_t>(group.element[slot]);
      for (std::size_t q = 0; q < count; ++q) {
        const double weight = at[q].weight.value[lane];
        const Matrix3 f = lane_of(at[q].deformation, lane), p = lane_of(at[q].piola, lane);
        states.volume[e] += weight;
        states.deformation[e] += weight * f;
        states.piola[e] += weight * p;
        states.cauchy[e] += weight * p * f.transpose() / f.determinant();
        for (std::size_t a = 0; a < static_cast<std::size_t>(group.nodes); ++a) {
          Vector3 g;
          for (int c = 0; c < 3; ++c) g[c] = at[q].gradient[a][c].value[lane];
          states.forces.row(group.node_of(slot, a)) -= weight * (p * g).transpose();
        }
      }
      for (Matrix3* mean : {&states.deformation[e], &states.piola[e], &states.cauchy[e]}) {
        *mean /= states.volume[e];
      }
    }
  }
}

}  // namespace

ElementStates element_states(const FemBody& body) {
  const FemModel& model = body.fem_model().elements();
  const ElementList list(body.fem_model().mesh());
  const auto count = static_cast<std::size_t>(list.count());
  ElementStates states;
  states.volume.assign(count, 0.0);
  for (auto* tensors : {&states.deformation, &states.piola, &states.cauchy}) {
    tensors->assign(count, Matrix3::Zero());
  }
  states.forces.setZero(body.positions().rows(), 3);
  const ElementBatches& elements = model.elements();
  for (int b = 0; b < elements.batches(); ++b) {
    if (b < elements.linear_batches) {
      add_batch<material::Law::linear>(body, b, states);
    } else {
      add_batch<material::Law::corotational>(body, b, states);
    }
  }
  if (model.solids().empty()) return states;
  std::vector<double> points(4 * static_cast<std::size_t>(body.positions().rows()), 0.0);
  for (Eigen::Index i = 0; i < body.positions().rows(); ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      points[static_cast<std::size_t>(4 * i + c)] = body.positions()(i, c);
    }
  }
  std::vector<LaneRow> overstress;
  for (std::size_t g = 0; g < model.solids().size(); ++g) {
    add_group(model.solids()[g], points, body.history().present(g, overstress), states);
  }
  return states;
}

Points reactions(const FemBody& body, const ElementStates& states, std::span<const double> effort,
                 std::span<const Vector3> directions, const mechanics::RowPattern& rows,
                 int index) {
  const FemBodyModel& model = body.fem_model();
  const FemModel& elements = model.elements();
  Points sum = states.forces + body.external_forces() + body.load_forces();
  for (NodeId node = 0; node < static_cast<NodeId>(sum.rows()); ++node) {
    sum.row(node) += elements.load_mass()[node] * model.settings().gravity.transpose();
  }
  for (int k = 0; k < rows.rows(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (auto e = rows.row_start[row]; e < rows.row_start[row + 1]; ++e) {
      const auto& point = rows.point[static_cast<std::size_t>(e)];
      if (point.body != index) continue;
      const auto& attached = model.attachment(point.point);
      for (std::size_t a = 0; a < attached.nodes.size(); ++a) {
        sum.row(attached.nodes[a]) +=
            effort[row] * attached.weights[a] * directions[static_cast<std::size_t>(e)].transpose();
      }
    }
  }
  Points result = Points::Zero(sum.rows(), 3);
  const auto free = elements.free_index();
  for (NodeId node = 0; node < static_cast<NodeId>(sum.rows()); ++node) {
    if (free[static_cast<std::size_t>(node)] < 0) result.row(node) = -sum.row(node);
  }
  for (const std::int32_t held : elements.held()) {
    const NodeId node = elements.free_nodes()[static_cast<std::size_t>(held / 3)];
    result(node, held % 3) = -sum(node, held % 3);
  }
  return result;
}

}  // namespace sinew::fem
