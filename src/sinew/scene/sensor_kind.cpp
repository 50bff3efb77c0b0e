#include "sinew/scene/sensor_kind.hpp"

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/kind_list.hpp"

namespace sinew::scene {

namespace {

KindList<SensorKind>& kinds_of_sensors() {
  static KindList<SensorKind> list(
      "sensor",
      {&marker_kind(), &orientation_kind(), &gyroscope_kind(), &accelerometer_kind(),
       &cable_length_kind(), &cable_tension_kind(), &pressure_sensor_kind(), &volume_sensor_kind(),
       &flow_kind(), &motor_current_kind(), &stretch_kind(), &resistance_kind(), &curvature_kind(),
       &attenuation_kind(), &capacitance_kind(), &contact_force_kind(), &touch_kind()});
  return list;
}

}  // namespace

const std::vector<const SensorKind*>& sensor_kinds() { return kinds_of_sensors().all(); }

void register_sensor_kind(const SensorKind& kind) { kinds_of_sensors().add(kind); }

const SensorKind& sensor_kind(std::string_view word) { return kinds_of_sensors().get(word); }

void add_sensor(builder::ModelBuilder& builder, const SensorSite& site) {
  const SensorDescription& sensor = site.sensor;
  sense::SensorSettings settings;
  settings.name = sensor.name;
  settings.place = sensor.place;
  settings.rate_place = sensor.rate_place;
  settings.kind = sensor.kind->word;
  settings.outside = sensor.outside;
  settings.channel = sensor.channel;
  settings.record = sensor.record;
  settings.what = sensor.kind->source(site);
  sense::add_sensor(builder, settings);
}

Form forms::sensor_form() { return variants("type", kinds_of_sensors().choices()); }

}  // namespace sinew::scene
