// Sensors of type marker.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> marker_table() {
  std::vector<Key> keys = spot_keys();
  keys.insert(keys.begin(), body_key());
  keys.push_back(outside_key());
  KeyTable marker =
      *sensor_table("marker", "Position of a point, (3,) m, as a motion-capture marker.",
                    std::move(keys), position_output());
  marker.alternatives = {{{"point", "points", "set"}, true}};
  return make_table(std::move(marker));
}

}  // namespace
}  // namespace forms

namespace {

sense::MakeSource position_source(const SensorSite& site) {
  SpotDescription spot = *site.sensor.as<SpotDescription>();
  spot.body = site.sensor.body;
  return sense::SensorMarker{spot_of(spot, site.body_of)};
}

EffectorDescription marked_effector(const SensorDescription& sensor) {
  using Kind = EffectorDescription::Kind;
  const auto& spot = *sensor.as<SpotDescription>();
  EffectorDescription effector;
  effector.points = spot.points;
  effector.kind = spot.region                      ? Kind::set
                  : spot.points.points.rows() == 1 ? Kind::point
                                                   : Kind::points;
  if (spot.region) effector.set = spot.region->set;
  return effector;
}

}  // namespace

const SensorKind& marker_kind() {
  static const SensorKind kind{
      .word = "marker",
      .description = "Position of a point.",
      .table = forms::marker_table,
      .read = [](const Fields& fields, const ReadContext& context,
                 SensorDescription& sensor) { sensor.own = read_spot(fields, context); },
      .source = position_source,
      .numbers = axis_numbers,
      .effector = marked_effector,
      .in_statics = true};
  return kind;
}

}  // namespace sinew::scene
