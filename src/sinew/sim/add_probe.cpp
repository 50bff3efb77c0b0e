// ModelBuilder::add_probe(): attaches what a probe measures.
#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "sinew/constraint/probe.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::sim {

namespace {

using mechanics::MaterialPoint;

/// Attaches points of one probe to the bodies.
class Attacher {
 public:
  /// @param model the body of a number, checked. @param settings for messages.
  Attacher(std::function<mechanics::BodyModel&(int)> model, const ProbeSettings& settings)
      : model_(std::move(model)), settings_(settings) {}

  MaterialPoint point(int body, const Vector3& rest) {
    const std::string what = fmt::format("point {} of probe '{}'", count_++, settings_.name);
    return {body, model_(body).attach(rest, settings_.outside, what)};
  }
  std::vector<MaterialPoint> nodes(int body, const std::vector<NodeId>& list) {
    if (list.empty()) {
      throw Error(ErrorKind::empty_region, settings_.place, "there are no nodes to measure",
                  "choose a set or a region that has some");
    }
    std::vector<MaterialPoint> result;
    result.reserve(list.size());
    const double one = 1.0;
    for (const NodeId node : list) {
      result.push_back({body, model_(body).attach_nodes({&node, 1}, {&one, 1})});
    }
    return result;
  }
  MaterialPoint mean(const ProbeSpot& spot) {
    if (spot.nodes.empty()) {
      return {spot.body, attach_mean(model_(spot.body), spot.points, settings_.outside,
                                     "probe '" + settings_.name + "'", settings_.place)};
    }
    const std::vector<double> weights(spot.nodes.size(),
                                      1.0 / static_cast<double>(spot.nodes.size()));
    return {spot.body, model_(spot.body).attach_nodes(spot.nodes, weights)};
  }
  Points rest(const std::vector<MaterialPoint>& points) {
    Points result(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
      result.row(static_cast<Eigen::Index>(i)) =
          model_(points[i].body).rest_position(points[i].point).transpose();
    }
    return result;
  }

 private:
  std::function<mechanics::BodyModel&(int)> model_;
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

int ModelBuilder::add_probe(const ProbeSettings& settings) {
  const auto same = [&](const auto& other) { return other->name() == settings.name; };
  if (std::ranges::any_of(model_->probes_, same)) {
    throw Error(ErrorKind::duplicate_key, settings.place,
                fmt::format("two probes are called '{}'", settings.name), "rename one");
  }
  const auto model = [&](int index) -> mechanics::BodyModel& {
    check_body(index, settings.place);
    return body(index);
  };
  try {
    model_->probes_.push_back(std::visit(Make{{model, settings}, settings}, settings.what));
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
  return static_cast<int>(model_->probes_.size()) - 1;
}

}  // namespace sinew::sim
