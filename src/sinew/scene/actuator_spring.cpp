// Actuators of type spring, also of shape-memory alloys.
#include <any>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sinew/builder/model_builder.hpp"
#include "sinew/builder/spring_line_settings.hpp"
#include "sinew/model/spring_drive.hpp"
#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

Key coil(const char* name, const Measure& measure, const char* example, const char* description) {
  return {.name = name,
          .forms = {quantity(measure, positive())},
          .example = example,
          .description = description,
          .required = true};
}

std::vector<Key> coil_keys() {
  return {
      coil("wire_diameter", length(), "0.5 mm", "Diameter of the wire."),
      coil("mean_diameter", length(), "2.4 mm", "Mean diameter of the coil, between wire centres."),
      coil("coils", plain_number(), "10", "Number of active coils.")};
}

std::shared_ptr<const KeyTable> helical_table() {
  KeyTable helical{.name = "stiffness: coil",
                   .description =
                       "A helical spring: stiffness G d^4/(8 n D^3) with wire diameter d, mean "
                       "diameter D and n coils.",
                   .keys = coil_keys()};
  helical.keys.push_back(
      coil("shear_modulus", elastic_modulus(), "79 GPa", "Shear modulus of the wire."));
  return make_table(std::move(helical));
}

Key positive_key(const char* name, const Measure& measure, const char* example,
                 const char* default_text, const char* description) {
  return {.name = name,
          .forms = {quantity(measure, positive())},
          .example = example,
          .default_text = default_text,
          .description = description};
}

std::shared_ptr<const KeyTable> wire_table() {
  KeyTable wire{.name = "shape memory of a spring",
                .description =
                    "A helical spring whose shear modulus depends on its phase, which follows the "
                    "temperature with hysteresis.",
                .keys = coil_keys()};
  for (Key& key :
       std::vector<Key>{positive_key("martensite_modulus", elastic_modulus(), "14.1 GPa",
                                     "14.1 GPa", "Shear modulus when cold."),
                        positive_key("austenite_modulus", elastic_modulus(), "24.7 GPa", "24.7 GPa",
                                     "Shear modulus when hot."),
                        positive_key("heat_capacity", heat_capacity(), "0.1 J/K", "0.1 J/K",
                                     "Heat capacity of the wire."),
                        positive_key("heat_loss", heat_loss(), "0.01 W/K", "0.01 W/K",
                                     "Heat loss to the surroundings per kelvin."),
                        positive_key("ambient", temperature(), "293.15 K", "293.15 K",
                                     "Temperature of the surroundings, and of the wire at rest."),
                        positive_key("austenite_start", temperature(), "341 K", "341 K",
                                     "Austenite start temperature, on heating."),
                        positive_key("austenite_end", temperature(), "351 K", "351 K",
                                     "Austenite finish temperature."),
                        positive_key("martensite_start", temperature(), "325 K", "325 K",
                                     "Martensite start temperature, on cooling."),
                        positive_key("martensite_end", temperature(), "315 K", "315 K",
                                     "Martensite finish temperature.")}) {
    wire.keys.push_back(std::move(key));
  }
  return make_table(std::move(wire));
}

std::shared_ptr<const KeyTable> spring_table() {
  const auto command = make_table(
      {.name = "command of a spring",
       .description = "Only for shape-memory springs: heating power, or a prescribed phase.",
       .keys = {input_key(model::SmaDrive::kPower.name, power(), "2 W",
                          "Electric power into the wire.", non_negative()),
                {.name = model::SmaDrive::kPhase.name,
                 .forms = {quantity(plain_number(), {.min = 0.0, .max = 1.0})},
                 .example = "1",
                 .description = "Austenite fraction of the wire, 0 to 1."}},
       .alternatives = {{{model::SmaDrive::kPower.name, model::SmaDrive::kPhase.name}, true}}});
  return make_table(
      {.name = "actuator: type spring",
       .description = "A spring or elastic band routed through points of a body without friction. "
                      "Its tension depends on its length.",
       .keys = {body_key(),
                {.name = "points",
                 .forms = {table(point_file_table()), list({vector(length())}, 2)},
                 .example = "[0 0 20 mm, 0 0 60 mm]",
                 .description = "Routing points in the mesh at rest.",
                 .required = true},
                {.name = "pull",
                 .forms = {choice({{"world", "Does not move."}, {"body", "Moves with the body."}})},
                 .example = "world",
                 .default_text = "body",
                 .description = "Attachment of the first point."},
                outside_key(),
                {.name = "stiffness",
                 .forms = {quantity(stiffness(), positive()),
                           table(helical_table(), "wire_diameter")},
                 .example = "200 N/m",
                 .description = "Force per stretch."},
                {.name = "shape_memory",
                 .forms = {table(wire_table())},
                 .example = "{wire_diameter: 0.5 mm, mean_diameter: 2.4 mm, coils: 10}",
                 .description = "A shape-memory spring, in place of `stiffness`."},
                {.name = "free_length",
                 .forms = {quantity(length(), non_negative())},
                 .example = "30 mm",
                 .description = "Free length. Default: the length at rest."},
                {.name = "damping",
                 .forms = {quantity(damper(), non_negative())},
                 .example = "0.5 N s/m",
                 .default_text = "0 N s/m",
                 .description = "Force per rate of stretch."},
                {.name = "tension_only",
                 .forms = {boolean()},
                 .example = "true",
                 .default_text = "false",
                 .description = "A band that goes slack instead of pushing.",
                 .only_with = "stiffness"},
                {.name = "command",
                 .forms = {table(command)},
                 .example = "{power: 2 W}",
                 .description = "Command of the wire.",
                 .only_with = "shape_memory"}},
       .alternatives = {{{"stiffness", "shape_memory"}, true}}});
}

}  // namespace
}  // namespace forms

namespace {

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

void add_spring(const ActuatorSite& site) {
  site.builder.add_spring(site.on_body(*site.actuator.as<builder::SpringLineSettings>()));
}

// A wire is commanded by its power or by its phase.
void take_command(std::any& own, const std::string& key, const Location&) {
  auto* wire =
      std::get_if<model::SmaSettings>(&std::any_cast<builder::SpringLineSettings&>(own).spring);
  if (wire != nullptr) wire->by_phase = key == model::SmaDrive::kPhase.name;
}

}  // namespace

const ActuatorKind& spring_kind() {
  static const ActuatorKind kind{
      .words = &builder::kSpringKind,
      .description = "A spring.",
      .table = forms::spring_table,
      .read = [](const Fields& fields, const ReadContext& context) -> std::any {
        return read_spring(fields, context);
      },
      .add = add_spring,
      .take_command = take_command};
  return kind;
}

}  // namespace sinew::scene
