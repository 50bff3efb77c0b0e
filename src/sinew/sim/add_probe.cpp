#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "sinew/constraint/probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/add_parts.hpp"
#include "sinew/sim/attach.hpp"
#include "sinew/sim/find_body.hpp"
#include "sinew/sim/model_data.hpp"
#include "sinew/sim/new_name.hpp"
#include "sinew/sim/probe_settings.hpp"

namespace sinew::sim {

namespace {

using mechanics::MaterialPoint;

/// Attaches points of one probe to the bodies.
class Attacher {
 public:
  Attacher(ModelData& data, const ProbeSettings& settings) : data_(data), settings_(settings) {}

  MaterialPoint point(int body, const Vector3& rest) {
    const std::string what = fmt::format("point {} of probe '{}'", count_++, settings_.name);
    return {body, on(body).attach(rest, settings_.outside, what)};
  }
  std::vector<MaterialPoint> nodes(int body, const std::vector<NodeId>& list) {
    if (list.empty()) {
      throw Error(ErrorKind::empty_region, settings_.place, "there are no nodes to measure",
                  "choose a set or a region that has some");
    }
    std::vector<MaterialPoint> result;
    result.reserve(list.size());
    for (const NodeId node : list) result.push_back({body, attach_node(on(body), node)});
    return result;
  }
  MaterialPoint mean(const ProbeSpot& spot) {
    if (!spot.nodes.empty()) return {spot.body, attach_mean(on(spot.body), spot.nodes)};
    return {spot.body, attach_mean(on(spot.body), spot.points, settings_.outside,
                                   "probe '" + settings_.name + "'", settings_.place)};
  }
  Points rest(const std::vector<MaterialPoint>& points) const {
    return rest_positions(data_, points);
  }

 private:
  mechanics::BodyModel& on(int body) { return find_body(data_, body, settings_.place); }

  ModelData& data_;
  const ProbeSettings& settings_;
  int count_ = 0;
};

/// Corners, and points between them at even distances.
std::vector<Vector3> sample(const Points& corners, int samples) {
  double length = 0.0;
  for (Eigen::Index k = 1; k < corners.rows(); ++k) {
    length += (corners.row(k) - corners.row(k - 1)).norm();
  }
  std::vector<Vector3> result = {corners.row(0).transpose()};
  for (Eigen::Index k = 1; k < corners.rows(); ++k) {
    const Vector3 from = corners.row(k - 1).transpose(), to = corners.row(k).transpose();
    const double share = length > 0.0 ? (to - from).norm() / length : 0.0;
    const int pieces = std::max(1, static_cast<int>(std::lround(share * (samples - 1))));
    for (int i = 1; i <= pieces; ++i) result.emplace_back(from + (to - from) * i / pieces);
  }
  return result;
}

/// Makes the probe that the settings ask for.
struct Make {
  Attacher attacher;
  const ProbeSettings& settings;

  std::unique_ptr<constraint::Probe> operator()(const ProbeSpot& spot) {
    return std::make_unique<constraint::PointProbe>(settings.name, attacher.mean(spot));
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeLine& line) {
    if (line.corners.rows() < 2 || line.samples < 2) {
      throw Error(ErrorKind::too_few_points, settings.place, "a line needs two points or more",
                  "give its ends");
    }
    std::vector<MaterialPoint> points;
    for (const Vector3& rest : sample(line.corners, line.samples)) {
      points.push_back(attacher.point(line.body, rest));
    }
    return std::make_unique<constraint::LineProbe>(settings.name, std::move(points));
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeBend& bend) {
    std::array<constraint::ProbeFace, 2> faces;
    for (std::size_t k = 0; k < 2; ++k) {
      faces[k].points = attacher.nodes(bend.faces[k].body, bend.faces[k].nodes);
      faces[k].rest = attacher.rest(faces[k].points);
      faces[k].normal = bend.faces[k].normal;
    }
    return std::make_unique<constraint::BendProbe>(settings.name, std::move(faces), bend.about);
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeDistance& distance) {
    return std::make_unique<constraint::DistanceProbe>(
        settings.name,
        std::array{attacher.mean(distance.ends[0]), attacher.mean(distance.ends[1])});
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeExtent& extent) {
    return std::make_unique<constraint::ExtentProbe>(
        settings.name, attacher.nodes(extent.body, extent.nodes), extent.axis, extent.way);
  }
};

}  // namespace

int add_probe(ModelData& data, const ProbeSettings& settings) {
  const auto name_of = [](const auto& other) { return other->name(); };
  check_new_name(data.probes, name_of, "probes", settings.name, settings.place);
  try {
    data.probes.push_back(std::visit(Make{{data, settings}, settings}, settings.what));
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
  return static_cast<int>(data.probes.size()) - 1;
}

}  // namespace sinew::sim
