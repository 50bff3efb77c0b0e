/// @file
/// A spring along a line of points.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/spring_drive.hpp"

namespace sinew::builder {

/// The kind of springs and shape-memory springs.
inline constexpr model::ActuatorKind kSpringKind{
    .word = "spring",
    .effort = {"tension", "N"},
    .motion = {"displacement", "m"},
    .inputs = {model::SmaDrive::kPower, model::SmaDrive::kPhase},
    .is_line = true,
    .number = 3};

/// A spring, a tendon, or a shape-memory spring.
struct SpringLineSettings {
  std::string name;
  Location place;
  int body = 0;
  Points points;  ///< (n, 3) m; those between the ends guide it without friction
  std::vector<Location> point_places;
  bool pull_from_world = false;  ///< whether the first point is fixed to the world
  mesh::Outside outside = mesh::Outside::error;
  std::variant<model::SpringSettings, model::SmaSettings> spring;
  bool free_at_rest = false;  ///< whether the length at rest replaces the free length of `spring`
  model::Command command{model::CommandKind::effort, {}};
};

}  // namespace sinew::builder
