// The tables of chambers and springs.
#include "sinew/model/fluid_drive.hpp"
#include "sinew/model/spring_drive.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

std::shared_ptr<const KeyTable> patch_table() {
  return make_table(
      {.name = "surface: patch",
       .description = "The surface face nearest to a point, and all faces connected to it across "
                      "edges with less than the given angle.",
       .keys = {{.name = "point",
                 .forms = {vector(length())},
                 .example = "0 0 30 mm",
                 .description = "A point on or near the surface, in the mesh at rest.",
                 .required = true},
                {.name = "angle",
                 .forms = {quantity(angle(), positive())},
                 .example = "40 deg",
                 .default_text = "40 deg",
                 .description = "Largest angle between neighbouring faces."}}});
}

std::shared_ptr<const KeyTable> supply_table(bool gas) {
  KeyTable supply{
      .name = gas ? "supply of gas" : "supply of liquid",
      .description = gas ? "A regulator holds the commanded pressure before a valve. The flow "
                           "follows ISO 6358."
                         : "A pump holds the commanded pressure before a valve. The flow is the "
                           "conductance times the pressure difference.",
      .keys = {{.name = "conductance",
                .forms = {quantity(conductance(), positive())},
                .example = "2e-9 m^3/(s Pa)",
                .description = gas ? "Sonic conductance: choked flow, as volume at ambient "
                                     "pressure, divided by the absolute upstream pressure."
                                   : "Flow divided by pressure difference.",
                .required = true},
               {.name = "leak",
                .forms = {quantity(conductance(), non_negative())},
                .example = "1e-11 m^3/(s Pa)",
                .default_text = "0 m^3/(s Pa)",
                .description = "Conductance of the outlet from the chamber to ambient."}}};
  if (gas) {
    supply.keys.push_back(
        {.name = "critical_ratio",
         .forms = {quantity(plain_number(), {.min = 0.0, .max = 1.0, .below_max = true})},
         .example = "0.3",
         .default_text = "0.5",
         .description = "Critical pressure ratio, below which the flow is choked."});
  }
  return make_table(std::move(supply));
}

Key dead_volume_key() {
  return {.name = "dead_volume",
          .forms = {quantity(volume(), non_negative())},
          .example = "5 ml",
          .default_text = "0 ml",
          .description = "Dead volume of tubes and fittings."};
}

std::shared_ptr<const KeyTable> gas_table() {
  return make_table(
      {.name = "gas of a chamber",
       .description = "A compressible filling: for a given amount of gas, absolute pressure times "
                      "volume to the power of the exponent is constant.",
       .keys = {
           {.name = "ambient_pressure",
            .forms = {quantity(pressure(), positive())},
            .example = "101.325 kPa",
            .description = "Absolute ambient pressure, also the filling pressure at rest. Default: "
                           "the `ambient_pressure` of the chamber."},
           {.name = "polytropic_exponent",
            .forms = {quantity(plain_number(), {.min = 1.0})},
            .example = "1.4",
            .default_text = "1",
            .description = "1: slow, isothermal. 1.4: fast, adiabatic air."},
           dead_volume_key(),
           {.name = "supply",
            .forms = {table(supply_table(true))},
            .example = "{conductance: 2e-9 m^3/(s Pa), critical_ratio: 0.3}",
            .description =
                "Supply through a valve. Default: a commanded pressure acts at once."}}});
}

std::shared_ptr<const KeyTable> liquid_table() {
  return make_table(
      {.name = "liquid of a chamber",
       .description = "A nearly incompressible filling.",
       .keys = {{.name = "bulk_modulus",
                 .forms = {quantity(elastic_modulus(), positive())},
                 .example = "2.2 GPa",
                 .default_text = "2.2 GPa",
                 .description = "Bulk modulus of the liquid; water by default."},
                {.name = "density",
                 .forms = {quantity(density(), non_negative())},
                 .example = "1000 kg/m^3",
                 .default_text = "0 kg/m^3",
                 .description = "Density, for the weight in the chamber; inertia is neglected."},
                dead_volume_key(),
                {.name = "supply",
                 .forms = {table(supply_table(false))},
                 .example = "{conductance: 2e-9 m^3/(s Pa)}",
                 .description =
                     "Supply through a valve. Default: a commanded pressure acts at once."}}});
}

Key input(const char* name, const Measure& measure, const char* example, const char* description,
          Range range = any()) {
  return {.name = name,
          .forms = {quantity(measure, range), table(signal_table(measure, example))},
          .example = example,
          .description = description};
}

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

}  // namespace

std::shared_ptr<const KeyTable> surface_table() {
  KeyTable surface{
      .name = "surface",
      .description = "Faces of a body, or a closed surface in it: exactly one of these.",
      .keys =
          {{.name = "inside",
            .forms = {vector(length())},
            .example = "0 0 30 mm",
            .description =
                "A point in a void enclosed by the body. It selects the whole wall of the void."},
           {.name = "patch",
            .forms = {table(patch_table())},
            .example = "{point: 0 0 30 mm, angle: 40 deg}",
            .description = "Faces around a point."},
           {.name = "file",
            .forms = {file()},
            .example = "chamber.stl",
            .description =
                "A closed surface as STL, OBJ or PLY, embedded in the body. It has the coordinates "
                "of the body's mesh file and shares the body's scale, rotation and position. "
                "Triangles larger than the elements are split."},
           file_unit_key("file")},
      .alternatives = {{{"inside", "patch", "file", "box", "sphere", "plane", "set"}, true}}};
  for (Key& key : region_keys("Faces with all their nodes")) surface.keys.push_back(std::move(key));
  return make_table(std::move(surface));
}

std::shared_ptr<const KeyTable> chamber_table() {
  KeyTable chamber{
      .name = "actuator: type chamber",
      .description =
          "A chamber: uniform pressure on a closed surface of a body, as a follower load.",
      .keys =
          {body_key(),
           {.name = "surface",
            .forms = {table(surface_table())},
            .example = "{inside: 0 0 30 mm}",
            .description = "Surface on which the pressure acts.",
            .required = true},
           {.name = "cap",
            .forms = {boolean()},
            .example = "true",
            .default_text = "false",
            .description =
                "Closes openings of the surface with lids of zero stiffness that transfer "
                "their force to the rim. An opening ends in one plane, or in planes that meet, "
                "such as the clamp of half a robot and its plane of symmetry. If false, an open "
                "surface is an error."},
           {.name = "load_stiffness",
            .forms = {boolean()},
            .example = "false",
            .default_text = "true",
            .description = "Adds the stiffness of the loaded surface to every step; static "
                           "solutions always have it."},
           {.name = "ambient_pressure",
            .forms = {quantity(pressure(), positive())},
            .example = "101.325 kPa",
            .default_text = "101.325 kPa",
            .description =
                "Absolute pressure at zero `pressure`. Pressures down to minus this, vacuum, are "
                "possible: commands below are refused, and controllers stay above. In water "
                "with a `level`, pressures count from that at the surface; where the water wets "
                "the chamber's faces, as in a body that only `cap` closes, from that of the water "
                "there, whose head is then added to this. In water without a level, pressures "
                "count from that around the body, so add the water's head."},
           {.name = "gas",
            .forms = {table(gas_table())},
            .example = "{dead_volume: 5 ml}",
            .description = "Gas in the chamber. Without gas or liquid, the pressure or volume "
                           "follows its command directly."},
           {.name = "liquid",
            .forms = {table(liquid_table())},
            .example = "{bulk_modulus: 2.2 GPa}",
            .description = "Liquid in the chamber."},
           outside_key()},
      .alternatives = {{{"gas", "liquid"}, false}}};
  DriveWords words{.kind = "chamber", .type = model::ActuatorType::chamber};
  words.effort_measure = pressure();
  words.effort_rate = pressure_rate();
  words.effort_range = any();
  words.effort_example = "50 kPa";
  words.effort_rate_example = "100 kPa/s";
  words.effort_value = "20 kPa";
  words.motion_measure = volume();
  words.motion_rate = volume_rate();
  words.motion_example = "20 ml";
  words.motion_rate_example = "5 ml/s";
  words.motion_value = "2 ml";
  words.motion_text = "Volume gained by the chamber.";
  words.inputs = {input(model::GasDrive::kInput.name, volume(), "5 ml",
                        "Gas added, as volume at ambient pressure. Only for chambers with `gas`."),
                  input(model::LiquidDrive::kInput.name, volume(), "5 ml",
                        "Liquid added. Only for chambers with `liquid`.")};
  words.undriven = "Command. Default: no pressure until commanded.";
  for (Key& key : drive_keys(words)) chamber.keys.push_back(std::move(key));
  return make_table(std::move(chamber));
}

std::shared_ptr<const KeyTable> spring_table() {
  const auto command = make_table(
      {.name = "command of a spring",
       .description = "Only for shape-memory springs: heating power, or a prescribed phase.",
       .keys = {input(model::SmaDrive::kPower.name, power(), "2 W", "Electric power into the wire.",
                      non_negative()),
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

}  // namespace sinew::scene::forms
