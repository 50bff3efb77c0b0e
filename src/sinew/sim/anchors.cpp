#include "sinew/sim/anchors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <Eigen/Geometry>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/sim/attach.hpp"
#include "sinew/sim/model_data.hpp"

namespace sinew::sim {

namespace {

// Three nodes that are far apart: the farthest from the centre, the farthest from that one, and the
// farthest from the line through both.
std::array<NodeId, 3> spread_nodes(const Points& nodes) {
  const Eigen::RowVector3d middle = nodes.colwise().mean();
  std::array<Eigen::Index, 3> found{};
  (nodes.rowwise() - middle).rowwise().squaredNorm().maxCoeff(&found[0]);
  const Eigen::RowVector3d a = nodes.row(found[0]);
  (nodes.rowwise() - a).rowwise().squaredNorm().maxCoeff(&found[1]);
  const Vector3 along = (nodes.row(found[1]) - a).normalized();
  double farthest = -1.0;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const double distance = along.cross(Vector3(nodes.row(i) - a)).norm();
    if (distance <= farthest) continue;
    farthest = distance;
    found[2] = i;
  }
  return {static_cast<NodeId>(found[0]), static_cast<NodeId>(found[1]),
          static_cast<NodeId>(found[2])};
}

// N/m, of the order of the body's own stiffness. For a rigid body, which has none, any value
// serves, since its matrix consists only of the anchors.
double anchor_stiffness(const mechanics::BodyModel& body) {
  constexpr double kOfRigidBody = 1e3;
  const auto* own = mechanics::as<const fem::HasElements>(body);
  if (own == nullptr) return kOfRigidBody;
  return fem::stiffest_modulus(own->settings().elements) * std::cbrt(own->elements().volume());
}

}  // namespace

void add_anchors(ModelData& data, int body, std::span<const NodeId> nodes) {
  mechanics::BodyModel& on = data.body(body);
  const double stiffness = anchor_stiffness(on);
  const Points& all = on.mesh().nodes;
  std::array<NodeId, 3> chosen = spread_nodes(nodes.empty() ? all : Points(all(nodes, Eigen::all)));
  for (NodeId& node : chosen) {
    if (!nodes.empty()) node = nodes[static_cast<std::size_t>(node)];
  }
  for (const NodeId node : chosen) {
    const int constraint = data.declare(std::make_unique<constraint::PointEffector>(
        "anchor", mechanics::MaterialPoint{body, attach_node(on, node)}));
    data.anchors.push_back({body, constraint, stiffness});
  }
}

}  // namespace sinew::sim
