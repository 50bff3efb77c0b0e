#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/builder/instrument_in.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"

namespace sinew::estimate {

namespace {

// The covariance of all instants has 9 kMaxLags^2 numbers for a force.
constexpr int kMaxLags = 100;

EstimatorSensor sensor_of(const model::ModelData& data, const std::string& name,
                          const Location& place, const model::Model& robot) {
  const std::vector<sense::SensorModel>& sensors = sense::sensors_of(data);
  const auto found = std::ranges::find(sensors, name, &sense::SensorModel::name);
  if (found == sensors.end()) {
    throw Error(ErrorKind::unknown_name, place, fmt::format("there is no sensor '{}'", name),
                "name a sensor of the scene");
  }
  const sense::ChannelSettings& channel = found->channel;
  const double deviation = channel.standard_deviation();
  if (!(deviation > 0.0)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("'{}' has no noise, and an estimator weighs sensors by it", name),
                "give the sensor noise or a quantum: how exact it is");
  }
  EstimatorSensor sensor;
  sensor.index = static_cast<int>(found - sensors.begin());
  const auto same = std::ranges::find(robot.effectors(), name, &model::EffectorModel::name);
  if (same != robot.effectors().end()) {
    sensor.effector = static_cast<int>(same - robot.effectors().begin());
  }
  sensor.deviation = deviation;
  sensor.delay = channel.delay;
  sensor.period = channel.rate > 0.0 ? 1.0 / channel.rate : data.step.time_step;
  sensor.size = found->source->size();
  return sensor;
}

}  // namespace

int add_estimator(builder::ModelBuilder& builder, const EstimatorSettings& settings) {
  model::ModelData& data = builder.data();
  if (const auto* present = data.instrument<const EstimatorSet>()) {
    model::check_new_name(present->estimators, &EstimatorModel::name, "estimators", settings.name,
                          settings.place);
  }
  EstimatorModel estimator{settings.name, settings.robot, {}, settings.unknowns, settings.loads, 0,
                           settings.rank};
  for (std::size_t k = 0; k < settings.sensors.size(); ++k) {
    const Location& place = settings.sensor_places[k];
    const EstimatorSensor sensor = sensor_of(data, settings.sensors[k], place, *settings.robot);
    // A sample is delivered at the first step at or after the delay.
    const double steps = std::ceil(sensor.delay / data.step.time_step - 1e-6);
    if (!(steps <= kMaxLags)) {
      throw Error(ErrorKind::out_of_range, place,
                  fmt::format("'{}' is {:g} steps late, and an estimator remembers {}",
                              settings.sensors[k], steps, kMaxLags),
                  "give a shorter delay, or a longer time_step");
    }
    estimator.lags = std::max(estimator.lags, whole<int>(steps));
    estimator.sensors.push_back(sensor);
  }
  std::vector<EstimatorModel>& all = builder::instrument_in<EstimatorSet>(data).estimators;
  all.push_back(std::move(estimator));
  return static_cast<int>(all.size()) - 1;
}

}  // namespace sinew::estimate
