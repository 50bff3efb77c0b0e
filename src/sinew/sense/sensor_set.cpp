#include "sinew/sense/sensor_set.hpp"

#include "sinew/core/named_hash.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/named_index.hpp"
#include "sinew/sense/sensor_source.hpp"
#include "sinew/sense/sensors.hpp"

namespace sinew::sense {

namespace {

const std::vector<SensorModel>& list_of(const SensorSet* set) {
  static const std::vector<SensorModel> kNone;
  return set != nullptr ? set->sensors : kNone;
}

}  // namespace

std::uint64_t SensorSet::hash() const {
  ValueHash hash;
  for (const SensorModel& sensor : sensors) {
    hash.add(sensor.name, sensor.kind, sensor.source->size(), sensor.source->memory_size());
  }
  return hash.value();
}

std::unique_ptr<run::Instrument> SensorSet::start(const run::Run& run) const {
  return std::make_unique<Sensors>(*this, run);
}

const std::vector<SensorModel>& sensors_of(const model::Model& model) {
  return list_of(model.instrument<const SensorSet>());
}

const std::vector<SensorModel>& sensors_of(const model::ModelData& data) {
  return list_of(data.instrument<const SensorSet>());
}

int sensor_index(const model::Model& model, std::string_view name) {
  return model::index_of_name(sensors_of(model), name, "sensor",
                              [](const auto& s) { return s.name; });
}

}  // namespace sinew::sense
