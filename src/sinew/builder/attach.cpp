#include "sinew/builder/attach.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

int attach_mean(mechanics::BodyModel& body, const Points& points, mesh::Outside outside,
                const std::string& what, const Location& place) {
  if (points.rows() == 0) {
    throw Error(ErrorKind::too_few_points, place, "there is no point", "give `point: x y z mm`");
  }
  if (points.rows() == 1) {
    return body.attach(points.row(0), outside, fmt::format("point 0 of {}", what));
  }
  return body.attach_mean(points, outside, what);
}

int attach_mean(mechanics::BodyModel& body, std::span<const NodeId> nodes) {
  const std::vector<double> weights(nodes.size(), 1.0 / static_cast<double>(nodes.size()));
  return body.attach_nodes(nodes, weights);
}

int attach_node(mechanics::BodyModel& body, NodeId node) { return attach_mean(body, {&node, 1}); }

Points rest_positions(const model::ModelData& data,
                      const std::vector<mechanics::MaterialPoint>& points) {
  Points result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) =
        data.body(points[i].body).rest_position(points[i].number).transpose();
  }
  return result;
}

}  // namespace sinew::builder
