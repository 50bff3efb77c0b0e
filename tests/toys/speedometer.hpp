/// @file
/// A kind of sensor that the library does not know: the speed of a point of a body.
#pragma once

#include <memory>
#include <span>

#include "sinew/builder/attacher.hpp"
#include "sinew/run/run.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"
#include "sinew/sense/sensor_source.hpp"

namespace sinew::testing {

class SpeedSource : public sense::SensorSource {
 public:
  explicit SpeedSource(mechanics::MaterialPoint point)
      : SensorSource({{"", "m/s"}}), point_(point) {}
  void read(const run::Run& run, std::span<const double> /*memory*/,
            std::span<double> values) const override {
    values[0] = run.world.configuration().velocity(point_).norm();
  }

 private:
  mechanics::MaterialPoint point_;
};

inline std::shared_ptr<const scene::KeyTable> speedometer_table() {
  using namespace scene::forms;
  return sensor_table("speedometer", "Speed of a point, m/s.",
                      {body_key(),
                       {.name = "at",
                        .forms = {vector(length())},
                        .example = "0 0 60 mm",
                        .description = "Point of the body, at rest.",
                        .required = true},
                       outside_key()},
                      {speed(), "1 mm/s", "0.1 mm/s", "0 2 m/s"});
}

inline void read_speedometer(const scene::Fields& fields, const scene::ReadContext& /*context*/,
                             scene::SensorDescription& sensor) {
  fields.read("at", sensor.own.emplace<Vector3>());
}

inline sense::MakeSource speed_source(const scene::SensorSite& site) {
  return [body = site.body(), at = *site.sensor.as<Vector3>()](const sense::SourceSite& made) {
    return sense::MadeSource{std::make_unique<SpeedSource>(made.attacher.point(body, at))};
  };
}

inline constexpr scene::SensorKind kSpeedometer{.word = "speedometer",
                                                .description = "Speed of a point.",
                                                .table = speedometer_table,
                                                .read = read_speedometer,
                                                .source = speed_source};

}  // namespace sinew::testing
