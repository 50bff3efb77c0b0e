#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "sinew/constraint/cable.hpp"
#include "sinew/core/error.hpp"
#include "sinew/sim/add_parts.hpp"
#include "sinew/sim/find_body.hpp"
#include "sinew/sim/line.hpp"
#include "sinew/sim/model_data.hpp"
#include "sinew/sim/spring_drive.hpp"
#include "sinew/sim/spring_line_settings.hpp"

namespace sinew::sim {

int add_spring(ModelData& data, const SpringLineSettings& settings) {
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
    ActuatorModel actuator{settings.name, ActuatorType::spring, -1, -1, {}, {}, settings.command};
    const double length = line->rest_length();
    std::visit(
        [&](auto spring) {
          using Wire = std::is_same<decltype(spring), SmaSettings>;
          using Kind = std::conditional_t<Wire::value, SmaDrive, SpringDrive>;
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

}  // namespace sinew::sim
