/// @file
/// Sensors of a model: sources and channels.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/model/instrument_model.hpp"
#include "sinew/sense/channel.hpp"

namespace sinew::builder {
class ModelBuilder;
}

namespace sinew::model {
class Model;
struct ModelData;
}  // namespace sinew::model

namespace sinew::sense {

struct SensorSettings;
class SensorSource;

/// Samples of a real sensor, in the order of their arrival.
struct SensorRecord {
  std::vector<double> arrivals;  ///< (n,) s, not decreasing
  std::vector<double> times;     ///< (n,) s, when each sample was taken
  MatrixX values;                ///< (n, size) in SI units; NaN: missing
};

/// The immutable part of a sensor.
struct SensorModel {
  std::string name;
  std::string kind;        ///< type in scenes: "marker", "cable-length"
  std::string observable;  ///< observable that it measures: "long_0.displacement"; its own
                           ///< NAME.true if there is no other
  std::shared_ptr<const SensorSource> source;
  ChannelSettings channel;
  std::shared_ptr<const SensorRecord> record = {};  ///< replaces the source; null: none
};

/// The sensors of a model.
class SensorSet : public model::InstrumentModel {
 public:
  std::uint64_t hash() const override;
  std::unique_ptr<run::Instrument> start(const run::Run& run) const override;

  std::vector<SensorModel> sensors;
};

/// The sensors of a model; an empty list if it has none. @param model with them.
const std::vector<SensorModel>& sensors_of(const model::Model& model);
/// @param data of a model that is being built.
const std::vector<SensorModel>& sensors_of(const model::ModelData& data);
/// Index in sensors_of(). Throws Error(unknown-name) with a suggestion.
/// @param model with the sensor. @param name of the sensor.
int sensor_index(const model::Model& model, std::string_view name);

/// Adds a sensor, after the actuators and contacts that it reads. @return its index.
/// Throws Error: as Channel does, out-of-range (a period that is not a multiple of the time step, a
/// position beyond the end of its line), unknown-name, wrong-actuator-type, missing-key and
/// conflicting-keys (the radius of a drum), wrong-length, degenerate-orientation, too-few-points,
/// point-outside-mesh, empty-region, zero-volume.
/// @param builder of the model. @param settings of the sensor.
int add_sensor(builder::ModelBuilder& builder, const SensorSettings& settings);

}  // namespace sinew::sense
