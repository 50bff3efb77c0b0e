// Sensors of actuators: types cable-length, cable-tension, pressure, volume and flow.
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> cable_length_table() {
  return sensor_table(
      "cable-length",
      "Length of a cable or spring pulled out from rest, m, as measured by an encoder.",
      {measured_actuator_key("long_0")}, position_output());
}

std::shared_ptr<const KeyTable> cable_tension_table() {
  return sensor_table(
      "cable-tension",
      "Tension of a cable or spring at its pull point, N, as measured by a load cell.",
      {measured_actuator_key("long_0")}, {force(), "0.05 N", "0.01 N", "0 50 N"});
}

std::shared_ptr<const KeyTable> chamber_pressure_table() {
  return sensor_table("pressure", "Pressure of a chamber above ambient, Pa.",
                      {measured_actuator_key("air")}, {stress(), "100 Pa", "10 Pa", "0 100 kPa"});
}

std::shared_ptr<const KeyTable> chamber_volume_table() {
  return sensor_table("volume", "Volume gained by a chamber from rest, m^3.",
                      {measured_actuator_key("air")}, {volume(), "0.1 ml", "0.01 ml", "0 50 ml"});
}

std::shared_ptr<const KeyTable> flow_table() {
  return sensor_table("flow",
                      "Flow into a chamber, m^3/s, mean over a time step: volume of its "
                      "gas at ambient pressure, or of its liquid; the rate of change of "
                      "the chamber's volume if it has neither.",
                      {measured_actuator_key("air")},
                      {volume_rate(), "0.1 ml/s", "0.01 ml/s", "-100 100 ml/s"});
}

}  // namespace
}  // namespace forms

namespace {

using Driven = sense::SensorDrive::What;

template <Driven what>
sense::MakeSource drive_source(const SensorSite& site) {
  return sense::SensorDrive{.what = what, .actuator = site.sensor.actuator};
}

}  // namespace

const SensorKind& cable_length_kind() {
  static const SensorKind kind{.word = "cable-length",
                               .description = "Length of cable pulled out.",
                               .table = forms::cable_length_table,
                               .source = drive_source<Driven::cable_length>,
                               .reads_motion = true,
                               .in_statics = true};
  return kind;
}

const SensorKind& cable_tension_kind() {
  static const SensorKind kind{.word = "cable-tension",
                               .description = "Tension of a cable.",
                               .table = forms::cable_tension_table,
                               .source = drive_source<Driven::cable_tension>,
                               .in_statics = true,
                               .reads_force = true};
  return kind;
}

const SensorKind& pressure_sensor_kind() {
  static const SensorKind kind{.word = "pressure",
                               .description = "Pressure of a chamber.",
                               .table = forms::chamber_pressure_table,
                               .source = drive_source<Driven::pressure>,
                               .in_statics = true,
                               .reads_force = true};
  return kind;
}

const SensorKind& volume_sensor_kind() {
  static const SensorKind kind{.word = "volume",
                               .description = "Volume gained by a chamber.",
                               .table = forms::chamber_volume_table,
                               .source = drive_source<Driven::volume>,
                               .reads_motion = true,
                               .in_statics = true};
  return kind;
}

const SensorKind& flow_kind() {
  static const SensorKind kind{.word = "flow",
                               .description = "Flow into a chamber.",
                               .table = forms::flow_table,
                               .source = drive_source<Driven::flow>};
  return kind;
}

}  // namespace sinew::scene
