#include "sinew/sim/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/core/named_hash.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/sensor_source.hpp"

namespace sinew::sim {

namespace {

// A hash as an integer that a double represents exactly.
double signature_of(const std::vector<SensorModel>& sensors) {
  ValueHash hash;
  for (const SensorModel& sensor : sensors) {
    hash.add(sensor.name, sensor.kind, sensor.source->size(), sensor.source->memory_size());
  }
  return static_cast<double>(hash.value() >> 12);
}

}  // namespace

Sensors::Sensors(const Model& model) : signature_(signature_of(model.sensors())) {
  for (const SensorModel& sensor : model.sensors()) {
    const std::size_t size = sensor.source->size();
    sensors_.push_back({&sensor, Channel(sensor.channel, size),
                        std::vector<double>(sensor.source->memory_size()), 0,
                        std::vector<double>(size)});
  }
}

void Sensors::sample(const Run& run, Sensor& sensor) {
  if (sensor.model->record) {
    replay(run, sensor);
    if (!sensor.channel.received()) return;  // no sample has arrived yet
  } else {
    sensor.model->source->read(run, sensor.memory, sensor.truth);
  }
  sensor.channel.offer(run.time(), sensor.truth);
}

// Delivers the samples that have arrived by now.
void Sensors::replay(const Run& run, Sensor& sensor) {
  const SensorRecord& record = *sensor.model->record;
  for (; sensor.row < record.arrivals.size(); ++sensor.row) {
    if (record.arrivals[sensor.row] > run.time() + Channel::kSameTime) return;
    const auto row = static_cast<Eigen::Index>(sensor.row);
    for (std::size_t c = 0; c < sensor.truth.size(); ++c) {
      sensor.truth[c] = record.values(row, static_cast<Eigen::Index>(c));
    }
    sensor.channel.receive(record.times[sensor.row], sensor.truth);
  }
}

void Sensors::restart(const Run& run) {
  for (Sensor& sensor : sensors_) {
    sensor.channel.restart();
    sensor.row = 0;
    sensor.model->source->begin(run, sensor.memory);
    sample(run, sensor);
  }
}

void Sensors::advance(const Run& run) {
  for (Sensor& sensor : sensors_) {
    sensor.model->source->advance(run, run.model->step().time_step, sensor.memory);
    sample(run, sensor);
  }
}

void Sensors::settle(const Run& run) {
  for (Sensor& sensor : sensors_) {
    sensor.model->source->begin(run, sensor.memory);
    if (sensor.model->record) continue;
    sensor.model->source->read(run, sensor.memory, sensor.truth);
    sensor.channel.settle(run.time(), sensor.truth);
  }
}

void Sensors::read_true(const Run& run, int index, std::span<double> values) const {
  const Sensor& sensor = at(index);
  sensor.model->source->read(run, sensor.memory, values);
}

void Sensors::save(std::vector<double>& memory) const {
  memory.clear();
  if (sensors_.empty()) return;
  memory.push_back(signature_);
  for (const Sensor& sensor : sensors_) {
    memory.push_back(static_cast<double>(sensor.row));
    memory.insert(memory.end(), sensor.memory.begin(), sensor.memory.end());
    sensor.channel.save(memory);
  }
}

bool Sensors::load(std::span<const double> memory) {
  if (sensors_.empty()) return true;
  if (memory.empty() || memory.front() != signature_) return false;
  memory = memory.subspan(1);
  for (Sensor& sensor : sensors_) {
    if (memory.size() < 1 + sensor.memory.size()) return false;
    sensor.row = whole<std::size_t>(memory.front());
    std::copy_n(memory.begin() + 1, sensor.memory.size(), sensor.memory.begin());
    memory = memory.subspan(1 + sensor.memory.size());
    if (!sensor.channel.load(memory)) return false;
  }
  return memory.empty();
}

}  // namespace sinew::sim
