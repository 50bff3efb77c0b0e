#include <fmt/format.h>

#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

void read_limit(const Fields& fields, std::string_view key, LimitDescription& limit) {
  limit.place = fields.place(key);
  const Fields values = fields.below(key);
  values.read("min", limit.min);
  values.read("max", limit.max);
  values.read("rate", limit.rate);
  if (limit.min <= limit.max) return;
  throw Error(ErrorKind::contradictory_limits, values.place("max"),
              fmt::format("max {} is below min {} (SI)", limit.max, limit.min),
              "give a max that is at least min");
}

void read_command(const Fields& fields, const char* effort, ActuatorDescription& actuator,
                  const ReadContext& context) {
  if (fields.find("command") == nullptr) return;
  const Fields command = fields.below("command");
  CommandDescription result;
  const bool is_effort = command.find(effort) != nullptr;
  const char* key = is_effort ? effort : "displacement";
  result.kind = is_effort ? CommandDescription::Kind::effort : CommandDescription::Kind::motion;
  result.place = command.place(key);
  result.signal = read_signal(command, key, context);
  actuator.command = std::move(result);
}

void read_cable(const Fields& fields, ActuatorDescription& cable, const ReadContext& context) {
  cable.points = read_points(fields, "points", context);
  fields.read_choice("pull", cable.pull, {{"world", PullPoint::world}, {"body", PullPoint::body}});
  fields.read("geometric_stiffness", cable.geometric_stiffness);
  const Points& points = cable.points.points;
  if (points.rows() < 2 && !(points.rows() == 0 && context.files == Files::ignore)) {
    throw Error(ErrorKind::too_few_points, cable.points.place,
                fmt::format("the cable has {} point", points.rows()),
                "give the pull point and at least one more");
  }
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    if (points.row(i) != points.row(i - 1)) continue;
    throw Error(ErrorKind::degenerate_cable, cable.points.places[static_cast<std::size_t>(i)],
                fmt::format("points {} and {} of the cable are the same", i, i + 1),
                "remove one of the two");
  }
}

void read_force(const Fields& fields, ActuatorDescription& force) {
  fields.read("point", force.point);
  force.point_place = fields.place("point");
  fields.read_direction("direction", force.direction);
}

}  // namespace

ActuatorDescription read_actuator(const Node::Entry& entry, const ReadContext& context) {
  ActuatorDescription actuator;
  actuator.name = entry.key;
  actuator.place = entry.key_place;
  const Form& form = form_of(grammar(), "actuators", Shape::names).items.front();
  const Fields fields(entry.value, form);
  fields.read("body", actuator.body);
  actuator.body_place = fields.place("body");
  fields.read_choice("outside", actuator.outside,
                     {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
  const bool is_cable = read_text(*entry.value.find(form.telltale)) == "cable";
  actuator.type = is_cable ? ActuatorDescription::Type::cable : ActuatorDescription::Type::force;
  const char* effort = is_cable ? "tension" : "force";
  if (is_cable) {
    actuator.effort.min = 0.0;
    read_cable(fields, actuator, context);
  } else {
    read_force(fields, actuator);
  }
  const Fields limits = fields.below("limits");
  read_limit(limits, effort, actuator.effort);
  read_limit(limits, "displacement", actuator.motion);
  read_command(fields, effort, actuator, context);
  return actuator;
}

}  // namespace sinew::scene
