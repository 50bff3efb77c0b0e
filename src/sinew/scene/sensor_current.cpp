// Sensors of type motor-current.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> current_table() {
  KeyTable sensor = *sensor_table(
      "motor-current",
      "Current of a motor, A: its torque, or tension times drum radius, divided by "
      "`torque_constant`; or its force divided by `force_constant`.",
      {measured_actuator_key("drive"),
       {.name = "torque_constant",
        .forms = {quantity(torque_constant(), positive())},
        .example = "0.05 N m/A",
        .description = "Torque per current of a rotary motor, including one that winds a cable."},
       {.name = "force_constant",
        .forms = {quantity(force_constant(), positive())},
        .example = "10 N/A",
        .description = "Force per current of a linear motor."},
       {.name = "radius",
        .forms = {quantity(length(), positive())},
        .example = "8 mm",
        .description = "Radius of the drum that winds the cable. Only for cables."}},
      {current(), "10 mA", "1 mA", "-5 5 A"});
  sensor.alternatives = {{{"torque_constant", "force_constant"}, true}};
  return make_table(std::move(sensor));
}

}  // namespace
}  // namespace forms

namespace {

void read_current(const Fields& fields, const ReadContext& /*context*/, SensorDescription& sensor) {
  sense::SensorDrive drive{.what = sense::SensorDrive::What::motor_current};
  drive.turns = fields.read("torque_constant", drive.motor_constant);
  if (!drive.turns) fields.read("force_constant", drive.motor_constant);
  fields.read("radius", drive.radius);
  sensor.own = std::move(drive);
}

sense::MakeSource current_source(const SensorSite& site) {
  sense::SensorDrive drive = *site.sensor.as<sense::SensorDrive>();
  drive.actuator = site.sensor.actuator;
  return drive;
}

}  // namespace

const SensorKind& motor_current_kind() {
  static const SensorKind kind{.word = "motor-current",
                               .description = "Current of a motor.",
                               .table = forms::current_table,
                               .read = read_current,
                               .source = current_source,
                               .in_statics = true,
                               .reads_force = true};
  return kind;
}

}  // namespace sinew::scene
