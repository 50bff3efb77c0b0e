#include <variant>

#include <fmt/format.h>

#include "sinew/scene/readers.hpp"

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

void read_limits(const Fields& fields, model::ActuatorType type, model::Limits& effort,
                 model::Limits& motion) {
  const model::ActuatorWords& words = model::actuator_words(type);
  const Fields limits = fields.below("limits");
  read_limit(limits, words.effort.name, effort);
  read_limit(limits, words.motion.name, motion);
}

void read_outside(const Fields& fields, mesh::Outside& outside) {
  fields.read_choice("outside", outside,
                     {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
}

// Checks that the chamber has the fluid to which an input refers.
void check_input(const builder::ChamberSettings& chamber, std::string_view input,
                 const Location& place) {
  const bool has = (input != "gas" || chamber.gas) && (input != "liquid" || chamber.liquid);
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
  const model::ActuatorWords& words = model::actuator_words(actuator.type);
  using Kind = model::CommandKind;
  actuator.command.kind = key == words.effort.name   ? Kind::effort
                          : key == words.motion.name ? Kind::motion
                                                     : Kind::input;
  if (const auto* chamber = std::get_if<ChamberDescription>(&actuator.own)) {
    check_input(chamber->settings, key, command.place(key));
  }
  if (auto* line = std::get_if<builder::SpringLineSettings>(&actuator.own)) {
    auto* wire = std::get_if<model::SmaSettings>(&line->spring);
    if (wire != nullptr) wire->by_phase = key == model::SmaDrive::kPhase.name;
  }
  actuator.command.signal = read_signal(command, key, context);
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

// Reads the keys that cables and springs share.
template <class Settings>
void set_line(const Fields& fields, const PointList& points, Settings& line) {
  line.points = points.points;
  line.point_places = points.places;
  fields.read_choice("pull", line.pull_from_world, {{"world", true}, {"body", false}});
  read_outside(fields, line.outside);
}

CableDescription read_cable(const Fields& fields, const ReadContext& context) {
  CableDescription cable;
  const PointList points = read_line_points(fields, context);
  cable.points_place = points.place;
  cable.point_bodies = points.bodies;
  builder::CableSettings& settings = cable.settings;
  set_line(fields, points, settings);
  fields.read("geometric_stiffness", settings.geometric_stiffness);
  fields.read("friction", settings.friction);
  cable.guide_radius_given = fields.read("guide_radius", settings.guide_radius);
  fields.read("guide_spacing", settings.guide_spacing);
  read_limits(fields, model::ActuatorType::cable, settings.tension, settings.displacement);
  return cable;
}

builder::ForceSettings read_force(const Fields& fields) {
  builder::ForceSettings force;
  fields.read("point", force.point);
  fields.read_direction("direction", force.direction);
  read_outside(fields, force.outside);
  read_limits(fields, model::ActuatorType::force, force.force, force.displacement);
  return force;
}

std::optional<model::Supply> read_supply(const Fields& fields) {
  if (fields.find("supply") == nullptr) return std::nullopt;
  model::Supply supply;
  const Fields values = fields.below("supply");
  values.read("conductance", supply.conductance);
  values.read("leak", supply.leak);
  return supply;
}

void read_ambient(const Fields& fields, const Fields& gas, builder::ChamberSettings& chamber) {
  double own = 0.0, of_gas = 0.0;
  const bool given = fields.read("ambient_pressure", own);
  const bool gas_given = fields.find("gas") != nullptr && gas.read("ambient_pressure", of_gas);
  if (given && gas_given && own != of_gas) {
    throw Error(
        ErrorKind::conflicting_keys, gas.place("ambient_pressure"),
        fmt::format("the gas has an ambient pressure of {:g} Pa, its chamber one of {:g} Pa",
                    of_gas, own),
        "give it once, in the chamber");
  }
  if (given) chamber.ambient_pressure = own;
}

void read_filling(const Fields& fields, builder::ChamberSettings& chamber) {
  if (fields.find("gas") != nullptr) {
    const Fields values = fields.below("gas");
    model::GasSettings& gas = chamber.gas.emplace();
    values.read("ambient_pressure", gas.ambient_pressure);
    values.read("polytropic_exponent", gas.exponent);
    values.read("dead_volume", gas.dead_volume);
    gas.supply = read_supply(values);
    if (gas.supply) values.below("supply").read("critical_ratio", gas.supply->critical_ratio);
  }
  if (fields.find("liquid") != nullptr) {
    const Fields values = fields.below("liquid");
    model::LiquidSettings& liquid = chamber.liquid.emplace();
    values.read("bulk_modulus", liquid.bulk_modulus);
    values.read("density", liquid.density);
    values.read("dead_volume", liquid.dead_volume);
    liquid.supply = read_supply(values);
  }
}

ChamberDescription read_chamber(const Fields& fields, const ReadContext& context) {
  ChamberDescription chamber;
  read_surface(fields.below("surface"), chamber.surface, context);
  builder::ChamberSettings& settings = chamber.settings;
  fields.read("cap", settings.cap);
  fields.read("load_stiffness", settings.load_stiffness);
  read_outside(fields, settings.outside);
  read_filling(fields, settings);
  read_ambient(fields, fields.below("gas"), settings);
  read_limits(fields, model::ActuatorType::chamber, settings.pressure, settings.volume_growth);
  return chamber;
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
  return model::coil_stiffness(modulus, wire, diameter, coils);
}

model::SmaSettings read_wire(const Fields& values) {
  model::SmaSettings wire;
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
  return wire;
}

builder::SpringLineSettings read_spring(const Fields& fields, const ReadContext& context) {
  builder::SpringLineSettings line;
  set_line(fields, read_line_points(fields, context), line);
  if (fields.find("stiffness") != nullptr) {
    auto& spring = line.spring.emplace<model::SpringSettings>();
    spring.stiffness = read_stiffness(fields);
    fields.read("tension_only", spring.tension_only);
  } else {
    line.spring = read_wire(fields.below("shape_memory"));
  }
  std::visit(
      [&](auto& spring) {
        line.free_at_rest = !fields.read("free_length", spring.free_length);
        fields.read("damping", spring.damping);
      },
      line.spring);
  return line;
}

builder::TorqueSettings read_torque(const Fields& fields) {
  using Towards = builder::TorqueSettings::Towards;
  builder::TorqueSettings torque;
  fields.read("segment", torque.segment);
  fields.read_choice("towards", torque.towards,
                     {{"side", Towards::side}, {"across", Towards::across}});
  read_limits(fields, model::ActuatorType::torque, torque.torque, torque.angle);
  return torque;
}

MotorDescription read_motor(const Fields& fields, model::ActuatorType type) {
  MotorDescription motor;
  fields.read("joint", motor.joint);
  motor.joint_place = fields.place("joint");
  motor.settings.linear = type == model::ActuatorType::linear_motor;
  read_limits(fields, type, motor.settings.effort, motor.settings.motion);
  return motor;
}

decltype(ActuatorDescription::own) read_own(const Fields& fields, model::ActuatorType type,
                                            const ReadContext& context) {
  using model::ActuatorType;
  switch (type) {
    case ActuatorType::cable:
      return read_cable(fields, context);
    case ActuatorType::force:
      return read_force(fields);
    case ActuatorType::chamber:
      return read_chamber(fields, context);
    case ActuatorType::spring:
      return read_spring(fields, context);
    case ActuatorType::torque:
      return read_torque(fields);
    case ActuatorType::motor:
    case ActuatorType::linear_motor:
      return read_motor(fields, type);
  }
  return {};
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

ActuatorDescription read_actuator(const Node::Entry& entry, const ReadContext& context) {
  ActuatorDescription actuator;
  actuator.name = entry.key;
  actuator.place = entry.key_place;
  const Form& form = form_of(grammar(), "actuators", Shape::names).items.front();
  const Fields fields(entry.value, form);
  // The grammar allows no other word.
  actuator.type = model::actuator_type(read_text(*entry.value.find(form.telltale))).value();
  actuator.own = read_own(fields, actuator.type, context);
  if (!std::holds_alternative<MotorDescription>(actuator.own)) {
    fields.read("body", actuator.body);
    actuator.body_place = fields.place("body");
  }
  read_command(fields, actuator, context);
  return actuator;
}

}  // namespace sinew::scene
