#include "sinew/fem/element_states.hpp"

#include <array>
#include <numeric>

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/element_points.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/fem/membrane.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/mechanics/capabilities.hpp"

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

// Adds one element of a batch to the means, and its forces to those of the nodes.
void add_point(const PointBatch& point, std::size_t lane, ElementStates& states) {
  const auto e = static_cast<std::size_t>(point.element[lane]);
  const double weight = point.weight[lane];
  const Matrix3 piola = lane_of(point.piola, lane);
  states.volume[e] += weight;
  states.deformation[e] += weight * lane_of(point.deformation, lane);
  states.piola[e] += weight * piola;
  states.cauchy[e] += weight * lane_of(point.cauchy, lane);
  for (std::size_t a = 0; a < point.nodes; ++a) {
    Vector3 gradient;
    for (int c = 0; c < 3; ++c) gradient[c] = point.gradient[a][c][lane];
    states.forces.row(point.node[kLanes * a + lane]) -= weight * (piola * gradient).transpose();
  }
}

// Adds the forces of the membranes on all nodes, of which those of the body omit the fixed ones.
void add_membranes(const HasMaterial& body, Points& forces) {
  const FemBodySettings& settings = body.material().settings();
  if (settings.elements.membranes.empty()) return;
  const auto count = static_cast<int>(forces.rows());
  std::vector<NodeId> every(static_cast<std::size_t>(count));
  std::iota(every.begin(), every.end(), NodeId{0});
  const auto diagonal =
      linalg::BlockPattern::from_cliques(count, std::array<std::int32_t, 1>{}, {});
  const Membranes membranes(*settings.mesh, settings.elements.membranes, every, diagonal);
  std::vector<double> gradient(3 * every.size(), 0.0);
  membranes.add(body.positions(), Tangent::none, 0.0, gradient, {});
  for (Eigen::Index i = 0; i < forces.rows(); ++i) {
    forces.row(i) -= Eigen::RowVector3d::Map(&gradient[static_cast<std::size_t>(3 * i)]);
  }
}

// Calls visit(node, weight) for the nodes on which an entry of a row acts.
template <class Visit>
void visit_nodes(const mechanics::MovesByNodes& model, const mechanics::RowValues& values,
                 std::int32_t entry, int site, Visit&& visit) {
  const auto e = static_cast<std::size_t>(entry);
  if (!values.patch.empty() && values.patch[e].nodes[0] >= 0) {
    const mechanics::Patch& patch = values.patch[e];
    for (std::size_t a = 0; a < patch.nodes.size() && patch.nodes[a] >= 0; ++a) {
      visit(patch.nodes[a], patch.weights[a]);
    }
    return;
  }
  const mechanics::Attachment& attached = model.attachment(site);
  for (std::size_t a = 0; a < attached.nodes.size(); ++a) {
    visit(attached.nodes[a], attached.weights[a]);
  }
}

}  // namespace

ElementStates element_states(const HasMaterial& body) {
  const auto count =
      static_cast<std::size_t>(ElementList(body.material().elements().mesh()).count());
  ElementStates states;
  states.volume.assign(count, 0.0);
  for (auto* tensors : {&states.deformation, &states.piola, &states.cauchy}) {
    tensors->assign(count, Matrix3::Zero());
  }
  states.forces.setZero(body.positions().rows(), 3);
  visit_points(body, [&](const PointBatch& point) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (point.element[lane] >= 0) add_point(point, lane, states);
    }
  });
  for (auto* tensors : {&states.deformation, &states.piola, &states.cauchy}) {
    for (std::size_t e = 0; e < count; ++e) (*tensors)[e] /= states.volume[e];
  }
  add_membranes(body, states.forces);
  return states;
}

Points nodal_balance(const HasMaterial& body, const ElementStates& states,
                     std::span<const double> effort, const mechanics::RowValues& values,
                     const mechanics::RowPattern& rows, int index) {
  const HasElements& model = body.material();
  const auto& nodes = *mechanics::as<const mechanics::MovesByNodes>(model);
  Points sum = states.forces + body.external_forces() + body.load_forces();
  for (NodeId node = 0; node < static_cast<NodeId>(sum.rows()); ++node) {
    sum.row(node) += model.elements().load_mass()[node] * model.settings().gravity.transpose();
  }
  for (int k = 0; k < rows.rows(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (effort[row] == 0.0) continue;
    for (auto e = rows.row_start[row]; e < rows.row_start[row + 1]; ++e) {
      const auto& site = rows.site[static_cast<std::size_t>(e)];
      if (site.body != index) continue;
      const Vector3 force = effort[row] * values.direction[static_cast<std::size_t>(e)];
      visit_nodes(nodes, values, e, site.number,
                  [&](NodeId node, double weight) { sum.row(node) += weight * force.transpose(); });
    }
  }
  return sum;
}

Points reactions(const HasMaterial& body, const ElementStates& states,
                 std::span<const double> effort, const mechanics::RowValues& values,
                 const mechanics::RowPattern& rows, int index) {
  const FemModel& elements = body.material().elements();
  const Points sum = nodal_balance(body, states, effort, values, rows, index);
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
