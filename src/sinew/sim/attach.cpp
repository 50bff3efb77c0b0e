#include "sinew/sim/attach.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/sim/model_data.hpp"

namespace sinew::sim {

int attach_mean(mechanics::BodyModel& body, const Points& points, mesh::Outside outside,
                const std::string& what, const Location& place) {
  if (points.rows() == 0) {
    throw Error(ErrorKind::too_few_points, place, "there is no point", "give `point: x y z mm`");
  }
  const auto name = [&](Eigen::Index i) { return fmt::format("point {} of {}", i, what); };
  if (points.rows() == 1) return body.attach(points.row(0), outside, name(0));
  const auto* elements = mechanics::as<fem::HasElements>(body);
  if (elements == nullptr) {
    throw Error(ErrorKind::wrong_type, place,
                "the mean of several points needs a finite-element body", "give one point");
  }
  std::vector<NodeId> nodes;
  std::vector<double> weights;
  const double share = 1.0 / static_cast<double>(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const auto& a = elements->attachment(body.attach(points.row(i), outside, name(i)));
    for (std::size_t k = 0; k < a.nodes.size(); ++k) {
      nodes.push_back(a.nodes[k]);
      weights.push_back(share * a.weights[k]);
    }
  }
  return body.attach_nodes(nodes, weights);
}

int attach_mean(mechanics::BodyModel& body, std::span<const NodeId> nodes) {
  const std::vector<double> weights(nodes.size(), 1.0 / static_cast<double>(nodes.size()));
  return body.attach_nodes(nodes, weights);
}

int attach_node(mechanics::BodyModel& body, NodeId node) { return attach_mean(body, {&node, 1}); }

Points rest_positions(const ModelData& data, const std::vector<mechanics::MaterialPoint>& points) {
  Points result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) =
        data.body(points[i].body).rest_position(points[i].number).transpose();
  }
  return result;
}

}  // namespace sinew::sim
