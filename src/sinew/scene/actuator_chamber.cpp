// Actuators of type chamber.
#include <algorithm>
#include <any>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/builder/chamber_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/scale.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/model/fluid_drive.hpp"
#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

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
  DriveWords words{.kind = &builder::kChamberKind};
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
  words.inputs = {
      input_key(model::GasDrive::kInput.name, volume(), "5 ml",
                "Gas added, as volume at ambient pressure. Only for chambers with `gas`."),
      input_key(model::LiquidDrive::kInput.name, volume(), "5 ml",
                "Liquid added. Only for chambers with `liquid`.")};
  words.undriven = "Command. Default: no pressure until commanded.";
  for (Key& key : drive_keys(words)) chamber.keys.push_back(std::move(key));
  return make_table(std::move(chamber));
}

}  // namespace
}  // namespace forms

namespace {

// Checks that the chamber has the fluid to which an input refers.
void check_input(const builder::ChamberSettings& chamber, std::string_view input,
                 const Location& place) {
  const bool has = (input != "gas" || chamber.gas) && (input != "liquid" || chamber.liquid);
  if (has) return;
  throw Error(ErrorKind::conflicting_keys, place,
              fmt::format("the chamber has no {} to add to", show(std::string(input))),
              fmt::format("give the chamber `{}: {{}}`, or command its pressure", input));
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
  read_limits(fields, builder::kChamberKind, settings.pressure, settings.volume_growth);
  return chamber;
}

// Reads a closed surface in the frame of the body's mesh file, with the same scale and pose.
mesh::Surface read_closed(const SurfaceDescription& surface, const BodyDescription& body) {
  try {
    mesh::SurfaceOptions options;
    options.unit = surface.unit;
    mesh::Surface read = mesh::read_surface(surface.file, options);
    mesh::require_closed(read);
    mesh::scale(read, body.mesh.scale);
    place_in_world(body, read.nodes);
    return read;
  } catch (const Error& error) {
    throw error.at(surface.place);
  }
}

// Counts the pressures of a chamber from that of the water that wets its faces.
void add_head(builder::ChamberSettings& chamber, double head) {
  if (head <= 0.0) return;
  const double air = chamber.gas ? chamber.gas->ambient_pressure : model::kAtmosphere;
  chamber.ambient_pressure = chamber.ambient_pressure.value_or(air) + head;
}

void add_chamber(const ActuatorSite& site) {
  const auto& chamber = *site.actuator.as<ChamberDescription>();
  const std::string& name = site.actuator.body;
  builder::ChamberSettings settings = site.on_body(chamber.settings);
  if (chamber.surface.kind == SurfaceDescription::Kind::file) {
    settings.surface = read_closed(
        chamber.surface, *std::ranges::find(site.scene.bodies, name, &BodyDescription::name));
  } else {
    const mechanics::BodyModel& body = *site.body_of(name).model;
    std::vector<mesh::Face> faces = faces_of(chamber.surface, body.mesh());
    add_head(settings, water_head(site.scene, name, body, faces));
    settings.surface = std::move(faces);
  }
  site.builder.add_chamber(settings);
}

void free_chamber(std::any& own) {
  auto& settings = std::any_cast<ChamberDescription&>(own).settings;
  settings.pressure = settings.volume_growth = {};
  if (settings.gas) settings.gas->supply.reset();
  if (settings.liquid) settings.liquid->supply.reset();
}

}  // namespace

const ActuatorKind& chamber_kind() {
  static const ActuatorKind kind{
      .words = &builder::kChamberKind,
      .description = "A chamber under pressure.",
      .table = forms::chamber_table,
      .read = [](const Fields& fields, const ReadContext& context) -> std::any {
        return read_chamber(fields, context);
      },
      .add = add_chamber,
      .take_command =
          [](std::any& own, const std::string& key, const Location& place) {
            check_input(std::any_cast<ChamberDescription&>(own).settings, key, place);
          },
      .free_effort = free_chamber};
  return kind;
}

}  // namespace sinew::scene
