#include <array>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/attach.hpp"
#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

std::unique_ptr<constraint::Effector> make_section(mechanics::BodyModel& on,
                                                   const EffectorSettings& settings) {
  auto* rigid = mechanics::as<mechanics::AttachesOrientations>(on);
  if (rigid == nullptr) {
    throw Error(ErrorKind::wrong_length, settings.place,
                fmt::format("one point for the orientation of body '{}', which deforms everywhere",
                            on.name()),
                "give three points that span a triangle");
  }
  const int site = rigid->attach_orientation(settings.points.row(0), settings.outside,
                                             fmt::format("effector '{}'", settings.name));
  return std::make_unique<constraint::SectionOrientation>(
      settings.name, mechanics::Orientation{{settings.body, site}});
}

std::unique_ptr<constraint::Effector> make_orientation(mechanics::BodyModel& on,
                                                       const EffectorSettings& settings) {
  if (settings.points.rows() == 1) return make_section(on, settings);
  if (settings.points.rows() != 3) {
    throw Error(ErrorKind::wrong_length, settings.place,
                fmt::format("an orientation needs three points or, of an arm, one; got {}",
                            settings.points.rows()),
                "give three points that span a triangle");
  }
  std::array<mechanics::MaterialPoint, 3> points;
  std::array<Vector3, 3> rest;
  for (std::size_t k = 0; k < 3; ++k) {
    const int point = on.attach(settings.points.row(static_cast<Eigen::Index>(k)), settings.outside,
                                fmt::format("point {} of effector '{}'", k, settings.name));
    points[k] = {{settings.body, point}};
    rest[k] = on.rest_position(point);
  }
  return std::make_unique<constraint::TriangleOrientation>(settings.name, points, rest);
}

int attach_set(mechanics::BodyModel& on, const EffectorSettings& settings) {
  if (!settings.nodes.empty()) return attach_mean(on, settings.nodes);
  throw Error(ErrorKind::empty_region, settings.place, "the effector's set has no nodes",
              "name a set that has some");
}

std::unique_ptr<constraint::Effector> make_effector(mechanics::BodyModel& on,
                                                    const EffectorSettings& settings) {
  if (settings.kind == EffectorSettings::Kind::orientation) return make_orientation(on, settings);
  const int point = settings.kind == EffectorSettings::Kind::nodes
                        ? attach_set(on, settings)
                        : attach_mean(on, settings.points, settings.outside,
                                      fmt::format("effector '{}'", settings.name), settings.place);
  return std::make_unique<constraint::PointEffector>(
      settings.name, mechanics::MaterialPoint{settings.body, point}, settings.directions);
}

}  // namespace

int add_effector(model::ModelData& data, const EffectorSettings& settings) {
  mechanics::BodyModel& on = find_body(data, settings.body, settings.place);
  model::check_new_name(data.effectors, &model::EffectorModel::name, "effectors", settings.name,
                        settings.place);
  std::unique_ptr<constraint::Effector> effector;
  try {
    effector = make_effector(on, settings);
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
  const int number = data.declare(std::move(effector));
  data.effectors.push_back({settings.name, number});
  return static_cast<int>(data.effectors.size()) - 1;
}

}  // namespace sinew::builder
