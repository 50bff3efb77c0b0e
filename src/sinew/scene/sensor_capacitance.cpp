// Sensors of type capacitance.
#include <iterator>
#include <utility>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> electrode_table() {
  KeyTable electrode{
      .name = "electrode",
      .description = "Faces of a body's surface: exactly one of patch, box, sphere, plane and set.",
      .keys = {*surface_table()->find("patch")},
      .alternatives = {{{"patch", "box", "sphere", "plane", "set"}, true}}};
  std::ranges::move(region_keys("Faces with all their nodes"), std::back_inserter(electrode.keys));
  Key body = body_key();
  body.required = false;
  body.description = "The body that has the faces. Default: the sensor's body.";
  electrode.keys.push_back(std::move(body));
  return make_table(std::move(electrode));
}

std::shared_ptr<const KeyTable> capacitance_table() {
  return sensor_table(
      "capacitance",
      "Capacitance of two electrodes that follow the body, F: permittivity times area over "
      "distance, summed over faces, as for parallel plates without fringe fields.",
      {body_key(),
       {.name = "electrodes",
        .forms = {list({table(electrode_table())}, 2, 2)},
        .example = "[{set: bottom}, {set: top}]",
        .description = "The two electrodes.",
        .required = true},
       {.name = "permittivity",
        .forms = {quantity(plain_number(), {.min = 1.0})},
        .example = "2.8",
        .default_text = "1",
        .description = "Relative permittivity of the material between them."}},
      {capacitance(), "0.01 pF", "0.001 pF", "0 100 pF"});
}

}  // namespace
}  // namespace forms

namespace {

void read_electrode(const Fields& fields, SurfaceDescription& surface) {
  if (fields.find("patch") == nullptr) {
    surface.region = read_region(fields);
    surface.place = surface.region.place;
    return;
  }
  surface.kind = SurfaceDescription::Kind::patch;
  surface.place = fields.place("patch");
  fields.below("patch").read("point", surface.point);
  fields.below("patch").read("angle", surface.angle);
}

void read_capacitance(const Fields& fields, const ReadContext& /*context*/,
                      SensorDescription& sensor) {
  CapacitanceDescription capacitance;
  const Form& form = fields.form("electrodes");
  for (std::size_t k = 0; k < 2; ++k) {
    const Node& item = fields.find("electrodes")->items()[k];
    const Fields electrode(item, select_form(item, form.items, {}));
    read_electrode(electrode, capacitance.electrodes[k]);
    electrode.read("body", sensor.further_bodies.emplace_back());
  }
  fields.read("permittivity", capacitance.permittivity);
  sensor.own = std::move(capacitance);
}

sense::MakeSource capacitance_source(const SensorSite& site) {
  const auto& capacitance = *site.sensor.as<CapacitanceDescription>();
  sense::SensorCapacitance plates;
  plates.relative_permittivity = capacitance.permittivity;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string& name = site.sensor.further_bodies[k];
    const BuiltBody on = site.body_of(name.empty() ? site.sensor.body : name);
    plates.electrodes[k] = {on.number, faces_of(capacitance.electrodes[k], on.model->mesh())};
  }
  return plates;
}

}  // namespace

const SensorKind& capacitance_kind() {
  static const SensorKind kind{.word = "capacitance",
                               .description = "Two electrodes on a body.",
                               .table = forms::capacitance_table,
                               .read = read_capacitance,
                               .source = capacitance_source};
  return kind;
}

}  // namespace sinew::scene
