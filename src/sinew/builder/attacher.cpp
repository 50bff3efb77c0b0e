#include "sinew/builder/attacher.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/builder/attach.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/probe_settings.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

using mechanics::MaterialPoint;

namespace {

/// The corners, and evenly spaced points between them.
std::vector<Vector3> sample(const Points& corners, int samples) {
  double length = 0.0;
  for (Eigen::Index k = 1; k < corners.rows(); ++k) {
    length += (corners.row(k) - corners.row(k - 1)).norm();
  }
  std::vector<Vector3> result = {corners.row(0).transpose()};
  for (Eigen::Index k = 1; k < corners.rows(); ++k) {
    const Vector3 from = corners.row(k - 1).transpose(), to = corners.row(k).transpose();
    const double share = length > 0.0 ? (to - from).norm() / length : 0.0;
    const int pieces = whole<int>(std::round(share * (samples - 1)), 1, std::max(1, samples - 1));
    for (int i = 1; i <= pieces; ++i) result.emplace_back(from + (to - from) * i / pieces);
  }
  return result;
}

}  // namespace

mechanics::BodyModel& Attacher::on(int body) const { return find_body(data_, body, place_); }

MaterialPoint Attacher::point(int body, const Vector3& rest) {
  const std::string name = fmt::format("point {} of {}", count_++, what_);
  return {body, on(body).attach(rest, outside_, name)};
}

std::vector<MaterialPoint> Attacher::nodes(int body, const std::vector<NodeId>& list) {
  if (list.empty()) {
    throw Error(ErrorKind::empty_region, place_, "there are no nodes to measure",
                "choose a set or a region that has some");
  }
  std::vector<MaterialPoint> result;
  result.reserve(list.size());
  for (const NodeId node : list) result.push_back({body, attach_node(on(body), node)});
  return result;
}

MaterialPoint Attacher::mean(const ProbeSpot& spot) {
  if (!spot.nodes.empty()) return {spot.body, attach_mean(on(spot.body), spot.nodes)};
  return {spot.body, attach_mean(on(spot.body), spot.points, outside_, what_, place_)};
}

std::vector<MaterialPoint> Attacher::line(const ProbeLine& line) {
  if (line.corners.rows() < 2 || line.samples < 2) {
    throw Error(ErrorKind::too_few_points, place_, "a line needs two points or more",
                "give its ends");
  }
  std::vector<MaterialPoint> points;
  for (const Vector3& rest : sample(line.corners, line.samples)) {
    points.push_back(point(line.body, rest));
  }
  return points;
}

Points Attacher::rest(const std::vector<MaterialPoint>& points) const {
  return rest_positions(data_, points);
}

}  // namespace sinew::builder
