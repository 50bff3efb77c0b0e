#include <memory>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/constraint/point_force.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

int add_force(model::ModelData& data, const ForceSettings& settings) {
  mechanics::BodyModel& on = find_body(data, settings.body, settings.place);
  try {
    const int point = on.attach(settings.point, settings.outside,
                                fmt::format("the point of force '{}'", settings.name));
    auto force = std::make_unique<constraint::PointForce>(
        settings.name, mechanics::MaterialPoint{settings.body, point}, settings.direction,
        on.rest_position(point));
    return add_actuator(data,
                        {settings.name, &kForceKind, -1, -1, settings.force, settings.displacement,
                         settings.command},
                        std::move(force), settings.place);
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
