#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/attach.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/joint_settings.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

// Points of the first body, each paired with the coincident point of the second.
std::vector<constraint::Tie::Pair> attach_pairs(model::ModelData& data,
                                                const WeldSettings& settings) {
  mechanics::BodyModel &first = data.body(settings.first), &second = data.body(settings.second);
  std::vector<int> points;
  if (!settings.nodes.empty()) {
    find_capable<mechanics::MovesByNodes>(data, settings.first, settings.place, "weld of nodes");
  }
  for (const NodeId node : settings.nodes) points.push_back(attach_node(first, node));
  for (Eigen::Index i = 0; i < settings.points.rows(); ++i) {
    points.push_back(first.attach(settings.points.row(i), settings.outside,
                                  fmt::format("point {} of weld '{}'", i, settings.name)));
  }
  if (points.empty()) {
    throw Error(ErrorKind::too_few_points, settings.place, "the weld has no point",
                "name a region of the first body, or points");
  }
  std::vector<constraint::Tie::Pair> pairs;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector3 at = first.rest_position(points[k]);
    const int on_second =
        second.attach(at, settings.outside,
                      fmt::format("point {} of weld '{}', {:.4g} {:.4g} {:.4g} m, on body '{}'", k,
                                  settings.name, at[0], at[1], at[2], second.name()));
    pairs.push_back({{settings.first, points[k]}, {settings.second, on_second}});
  }
  return pairs;
}

}  // namespace

int add_weld(model::ModelData& data, const WeldSettings& settings) {
  find_body(data, settings.first, settings.place);
  find_body(data, settings.second, settings.place);
  model::check_new_name(data.joints, &model::JointModel::name, "joints", settings.name,
                        settings.place);
  if (settings.first == settings.second) {
    throw Error(ErrorKind::bad_argument, settings.place, "a body cannot be welded to itself",
                "name two bodies");
  }
  try {
    auto tie = std::make_unique<constraint::Tie>(settings.name, attach_pairs(data, settings));
    const int number = data.declare(std::move(tie));
    data.joints.push_back({settings.name, settings.first, settings.second, number});
    return static_cast<int>(data.joints.size()) - 1;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
