#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/line.hpp"
#include "sinew/builder/spring_line_settings.hpp"
#include "sinew/constraint/cable.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/spring_drive.hpp"

namespace sinew::builder {

int add_spring(model::ModelData& data, const SpringLineSettings& settings) {
  find_body(data, settings.body, settings.place);
  try {
    const auto count = static_cast<std::size_t>(settings.points.rows());
    auto line = attach_line(data, {.kind = "spring",
                                   .name = settings.name,
                                   .place = settings.place,
                                   .path = {settings.points, settings.point_places,
                                            std::vector<int>(count, settings.body)},
                                   .from_world = settings.pull_from_world,
                                   .outside = settings.outside});
    model::ActuatorModel actuator{settings.name, &kSpringKind, -1, -1, {}, {}, settings.command};
    const double length = line->rest_length();
    std::visit(
        [&](auto spring) {
          using Wire = std::is_same<decltype(spring), model::SmaSettings>;
          using Kind = std::conditional_t<Wire::value, model::SmaDrive, model::SpringDrive>;
          if (settings.free_at_rest) spring.free_length = length;
          actuator.drive = std::make_shared<const Kind>(spring, length);
        },
        settings.spring);
    const int index = add_actuator(data, std::move(actuator), std::move(line), settings.place);
    // A stretched spring is about as stiff across its line as along it: without its geometric
    // stiffness, a slack robot would swing.
    data.geometric_stiffness.in_steps.push_back(data.actuators.back().constraint);
    return index;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
