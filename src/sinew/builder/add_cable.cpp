#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/line.hpp"
#include "sinew/constraint/cable.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

namespace {

void check_numbers(const CableSettings& settings) {
  if (settings.tension.min < 0.0) {
    throw Error(
        ErrorKind::out_of_range, settings.place,
        fmt::format("tension: min {:g} N is negative; a cable cannot push", settings.tension.min),
        "give zero or more");
  }
  const auto check = [&](double value, const char* what, const char* unit, const char* remedy) {
    if (value >= 0.0 && std::isfinite(value)) return;
    throw Error(ErrorKind::out_of_range, settings.place,
                fmt::format("{} is {:g}{}", what, value, unit), remedy);
  };
  check(settings.friction, "the coefficient of friction", "",
        "give zero or more; 0.1 to 0.3 is usual for a cord in a tube");
  check(settings.guide_radius, "the guides' radius", " m",
        "give zero or more: that of the tubes that the cable runs through");
  check(settings.guide_spacing, "the guides' spacing", " m",
        "give the distance between guides, or zero for none between the points");
}

std::vector<int> bodies_of(model::ModelData& data, const CableSettings& settings) {
  const auto count = static_cast<std::size_t>(settings.points.rows());
  if (settings.point_bodies.empty()) return std::vector<int>(count, settings.body);
  if (settings.point_bodies.size() != count) {
    throw Error(ErrorKind::wrong_length, settings.place,
                fmt::format("{} points have {} bodies", count, settings.point_bodies.size()),
                "name one body for each point");
  }
  for (const int body : settings.point_bodies) find_body(data, body, settings.place);
  return settings.point_bodies;
}

}  // namespace

int add_cable(model::ModelData& data, const CableSettings& settings) {
  find_body(data, settings.body, settings.place);
  check_numbers(settings);
  try {
    LinePath path{settings.points, settings.point_places, bodies_of(data, settings)};
    const bool friction = settings.friction > 0.0;
    auto cable = attach_line(data, {.kind = "cable",
                                    .name = settings.name,
                                    .place = settings.place,
                                    .path = set_guides(std::move(path), settings.guide_spacing),
                                    .from_world = settings.pull_from_world,
                                    .outside = settings.outside,
                                    .friction = friction,
                                    .guide_radius = settings.guide_radius});
    const int vias = friction ? cable->via_count() : 0;
    const int index = add_actuator(data,
                                   {settings.name, &kCableKind, -1, -1, settings.tension,
                                    settings.displacement, settings.command},
                                   std::move(cable), settings.place);
    const model::ActuatorModel& actuator = data.actuators.back();
    for (int via = 0; via < vias; ++via) {
      data.guides.push_back({index, via, actuator.row + 1 + via, settings.friction});
    }
    if (settings.geometric_stiffness || data.step.tangent == mechanics::Tangent::exact) {
      data.geometric_stiffness.in_steps.push_back(actuator.constraint);
    }
    return index;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
