#include <fmt/format.h>

#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"

namespace sinew::scene {

namespace {

void read_limit(const Fields& fields, std::string_view key, model::Limits& limit) {
  const Fields values = fields.below(key);
  values.read("min", limit.min);
  values.read("max", limit.max);
  values.read("rate", limit.rate);
  if (limit.min <= limit.max) return;
  throw Error(ErrorKind::contradictory_limits, values.place("max"),
              fmt::format("max {} is below min {} (SI)", limit.max, limit.min),
              "give a max that is at least min");
}

// The grammar lets a command have exactly one key: a quantity of the actuator.
void read_command(const Fields& fields, ActuatorDescription& actuator, const ReadContext& context) {
  if (fields.find("command") == nullptr) return;
  const Fields command = fields.below("command");
  const std::string& key = command.map().entries().front().key;
  const model::ActuatorKind& words = *actuator.kind->words;
  using Kind = model::CommandKind;
  actuator.command.kind = key == words.effort.name   ? Kind::effort
                          : key == words.motion.name ? Kind::motion
                                                     : Kind::input;
  if (actuator.kind->take_command != nullptr) {
    actuator.kind->take_command(actuator.own, key, command.place(key));
  }
  actuator.command.signal = read_signal(command, key, context);
}

}  // namespace

void read_limits(const Fields& fields, const model::ActuatorKind& kind, model::Limits& effort,
                 model::Limits& motion) {
  const Fields limits = fields.below("limits");
  read_limit(limits, kind.effort.name, effort);
  read_limit(limits, kind.motion.name, motion);
}

void read_outside(const Fields& fields, mesh::Outside& outside) {
  fields.read_choice("outside", outside,
                     {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
}

PointList read_line_points(const Fields& fields, const ReadContext& context) {
  PointList line = read_points(fields, "points", context);
  const Points& points = line.points;
  if (points.rows() < 2 && !(points.rows() == 0 && context.files == Files::ignore)) {
    throw Error(ErrorKind::too_few_points, line.place,
                fmt::format("the line has {} point", points.rows()),
                "give its first point and at least one more");
  }
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    if (points.row(i) != points.row(i - 1)) continue;
    throw Error(ErrorKind::degenerate_cable, line.places[static_cast<std::size_t>(i)],
                fmt::format("points {} and {} of the line are the same", i, i + 1),
                "remove one of the two");
  }
  return line;
}

void read_surface(const Fields& fields, SurfaceDescription& surface, const ReadContext& context) {
  surface.place = fields.map().place();
  if (fields.read("inside", surface.point)) {
    surface.kind = SurfaceDescription::Kind::inside;
    surface.place = fields.place("inside");
  } else if (fields.find("patch") != nullptr) {
    surface.kind = SurfaceDescription::Kind::patch;
    surface.place = fields.place("patch");
    fields.below("patch").read("point", surface.point);
    fields.below("patch").read("angle", surface.angle);
  } else if (fields.find("file") != nullptr) {
    surface.kind = SurfaceDescription::Kind::file;
    surface.place = fields.place("file");
    surface.file = context.path(fields, "file");
    fields.read("unit", surface.unit);
  } else {
    surface.region = read_region(fields);
    surface.place = surface.region.place;
  }
}

ActuatorDescription read_actuator(const Node::Entry& entry, const ReadContext& context) {
  ActuatorDescription actuator;
  actuator.name = entry.key;
  actuator.place = entry.key_place;
  const Form& form = form_of(grammar(), "actuators", Shape::names).items.front();
  const Fields fields(entry.value, form);
  actuator.kind = &actuator_kind(read_text(*entry.value.find(form.telltale)));
  actuator.own = actuator.kind->read(fields, context);
  if (actuator.kind->on_body) {
    fields.read("body", actuator.body);
    actuator.body_place = fields.place("body");
  }
  read_command(fields, actuator, context);
  return actuator;
}

}  // namespace sinew::scene
