#include <fmt/format.h>

#include "sinew/mesh/embedding.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/sim/torque_settings.hpp"

namespace sinew::scene {

namespace {

void read_limit(const Fields& fields, std::string_view key, sim::Limits& limit) {
  const Fields values = fields.below(key);
  values.read("min", limit.min);
  values.read("max", limit.max);
  values.read("rate", limit.rate);
  if (limit.min <= limit.max) return;
  throw Error(ErrorKind::contradictory_limits, values.place("max"),
              fmt::format("max {} is below min {} (SI)", limit.max, limit.min),
              "give a max that is at least min");
}

// An input belongs to what fills a chamber.
void check_input(const ActuatorDescription& actuator, std::string_view input,
                 const Location& place) {
  const bool has = (input != "gas" || actuator.gas) && (input != "liquid" || actuator.liquid);
  if (has) return;
  throw Error(ErrorKind::conflicting_keys, place,
              fmt::format("the chamber has no {} to add to", show(std::string(input))),
              fmt::format("give the chamber `{}: {{}}`, or command its pressure", input));
}

// The grammar lets a command have exactly one key: a quantity of the actuator.
void read_command(const Fields& fields, ActuatorDescription& actuator, const ReadContext& context) {
  if (fields.find("command") == nullptr) return;
  const Fields command = fields.below("command");
  const std::string& key = command.map().entries().front().key;
  const sim::ActuatorWords& words = sim::actuator_words(actuator.type);
  using Kind = sim::CommandKind;
  actuator.command.kind = key == words.effort.name   ? Kind::effort
                          : key == words.motion.name ? Kind::motion
                                                     : Kind::input;
  if (actuator.command.kind == Kind::input) check_input(actuator, key, command.place(key));
  if (auto* wire = std::get_if<sim::SmaSettings>(&actuator.spring)) {
    wire->by_phase = key == sim::SmaDrive::kPhase.name;
  }
  actuator.command.signal = read_signal(command, key, context);
}

void read_line(const Fields& fields, ActuatorDescription& cable, const ReadContext& context) {
  cable.points = read_points(fields, "points", context);
  fields.read_choice("pull", cable.pull, {{"world", PullPoint::world}, {"body", PullPoint::body}});
  const Points& points = cable.points.points;
  if (points.rows() < 2 && !(points.rows() == 0 && context.files == Files::ignore)) {
    throw Error(ErrorKind::too_few_points, cable.points.place,
                fmt::format("the line has {} point", points.rows()),
                "give its first point and at least one more");
  }
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    if (points.row(i) != points.row(i - 1)) continue;
    throw Error(ErrorKind::degenerate_cable, cable.points.places[static_cast<std::size_t>(i)],
                fmt::format("points {} and {} of the line are the same", i, i + 1),
                "remove one of the two");
  }
}

void read_force(const Fields& fields, ActuatorDescription& force) {
  fields.read("point", force.point);
  force.point_place = fields.place("point");
  fields.read_direction("direction", force.direction);
}

std::optional<sim::Supply> read_supply(const Fields& fields) {
  if (fields.find("supply") == nullptr) return std::nullopt;
  sim::Supply supply;
  const Fields values = fields.below("supply");
  values.read("conductance", supply.conductance);
  values.read("leak", supply.leak);
  return supply;
}

void read_pressure(const Fields& fields, ActuatorDescription& chamber, const ReadContext& context) {
  read_surface(fields.below("surface"), chamber.surface, context);
  fields.read("cap", chamber.cap);
  fields.read("load_stiffness", chamber.load_stiffness);
  if (fields.find("gas") != nullptr) {
    const Fields values = fields.below("gas");
    sim::GasSettings& gas = chamber.gas.emplace();
    values.read("ambient_pressure", gas.ambient_pressure);
    values.read("polytropic_exponent", gas.exponent);
    values.read("dead_volume", gas.dead_volume);
    gas.supply = read_supply(values);
    if (gas.supply) values.below("supply").read("critical_ratio", gas.supply->critical_ratio);
  }
  if (fields.find("liquid") != nullptr) {
    const Fields values = fields.below("liquid");
    sim::LiquidSettings& liquid = chamber.liquid.emplace();
    values.read("bulk_modulus", liquid.bulk_modulus);
    values.read("density", liquid.density);
    values.read("dead_volume", liquid.dead_volume);
    liquid.supply = read_supply(values);
  }
}

double read_stiffness(const Fields& fields) {
  double stiffness = 0.0;
  if (fields.form("stiffness").shape == Shape::quantity) {
    fields.read("stiffness", stiffness);
    return stiffness;
  }
  const Fields coil = fields.below("stiffness");
  double modulus = 0.0, wire = 0.0, diameter = 0.0, coils = 0.0;
  coil.read("shear_modulus", modulus);
  coil.read("wire_diameter", wire);
  coil.read("mean_diameter", diameter);
  coil.read("coils", coils);
  return sim::coil_stiffness(modulus, wire, diameter, coils);
}

void read_spring(const Fields& fields, ActuatorDescription& line) {
  double free_length = 0.0, damping = 0.0;
  line.free_at_rest = !fields.read("free_length", free_length);
  fields.read("damping", damping);
  if (fields.find("stiffness") != nullptr) {
    sim::SpringSettings spring;
    spring.stiffness = read_stiffness(fields);
    spring.free_length = free_length;
    spring.damping = damping;
    fields.read("tension_only", spring.tension_only);
    line.spring = spring;
    return;
  }
  const Fields values = fields.below("shape_memory");
  sim::SmaSettings wire;
  wire.free_length = free_length;
  wire.damping = damping;
  values.read("wire_diameter", wire.wire);
  values.read("mean_diameter", wire.mean_diameter);
  values.read("coils", wire.coils);
  values.read("martensite_modulus", wire.martensite_modulus);
  values.read("austenite_modulus", wire.austenite_modulus);
  values.read("heat_capacity", wire.heat_capacity);
  values.read("heat_loss", wire.heat_loss);
  values.read("ambient", wire.ambient);
  values.read("austenite_start", wire.austenite_start);
  values.read("austenite_end", wire.austenite_end);
  values.read("martensite_start", wire.martensite_start);
  values.read("martensite_end", wire.martensite_end);
  line.spring = wire;
}

}  // namespace

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

namespace {

bool moves_joint(ActuatorDescription::Type type) {
  return type == ActuatorDescription::Type::motor ||
         type == ActuatorDescription::Type::linear_motor;
}

bool has_points(ActuatorDescription::Type type) {
  return type != ActuatorDescription::Type::torque && !moves_joint(type);
}

}  // namespace

ActuatorDescription read_actuator(const Node::Entry& entry, const ReadContext& context) {
  ActuatorDescription actuator;
  actuator.name = entry.key;
  actuator.place = entry.key_place;
  const Form& form = form_of(grammar(), "actuators", Shape::names).items.front();
  const Fields fields(entry.value, form);
  using Type = ActuatorDescription::Type;
  // The grammar lets no other word through.
  actuator.type = sim::actuator_type(read_text(*entry.value.find(form.telltale))).value();
  if (has_points(actuator.type)) {
    fields.read_choice("outside", actuator.outside,
                       {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
  }
  if (!moves_joint(actuator.type)) {
    fields.read("body", actuator.body);
    actuator.body_place = fields.place("body");
  }
  switch (actuator.type) {
    case Type::cable:
      actuator.effort.min = 0.0;
      read_line(fields, actuator, context);
      fields.read("geometric_stiffness", actuator.geometric_stiffness);
      fields.read("friction", actuator.friction);
      if (double radius = 0.0; fields.read("guide_radius", radius)) {
        actuator.guide_radius = radius;
      }
      fields.read("guide_spacing", actuator.guide_spacing);
      break;
    case Type::force:
      read_force(fields, actuator);
      break;
    case Type::pressure:
      read_pressure(fields, actuator, context);
      break;
    case Type::motor:
    case Type::linear_motor:
      fields.read("joint", actuator.joint);
      actuator.joint_place = fields.place("joint");
      break;
    case Type::torque:
      fields.read("segment", actuator.segment);
      fields.read_choice("towards", actuator.towards,
                         {{"side", sim::TorqueSettings::Towards::side},
                          {"across", sim::TorqueSettings::Towards::across}});
      break;
    case Type::spring:
      actuator.pull = PullPoint::body;
      read_line(fields, actuator, context);
      read_spring(fields, actuator);
      break;
  }
  if (actuator.type != Type::spring) {
    const sim::ActuatorWords& words = sim::actuator_words(actuator.type);
    const Fields limits = fields.below("limits");
    read_limit(limits, words.effort.name, actuator.effort);
    read_limit(limits, words.motion.name, actuator.motion);
  }
  read_command(fields, actuator, context);
  return actuator;
}

}  // namespace sinew::scene
