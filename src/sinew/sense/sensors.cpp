#include "sinew/sense/sensors.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/run.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"

namespace sinew::sense {

Sensors::Sensors(const SensorSet& set, const run::Run& run) : run_(run) {
  for (const SensorModel& sensor : set.sensors) {
    const std::size_t size = sensor.source->size();
    sensors_.push_back({&sensor, Channel(sensor.channel, size),
                        std::vector<double>(sensor.source->memory_size()), 0,
                        std::vector<double>(size)});
  }
}

void Sensors::sample(Sensor& sensor) {
  if (sensor.model->record) {
    replay(sensor);
    if (!sensor.channel.received()) return;  // no sample has arrived yet
  } else {
    sensor.model->source->read(run_, sensor.memory, sensor.truth);
  }
  sensor.channel.offer(run_.time(), sensor.truth);
}

// Delivers the samples that have arrived by now.
void Sensors::replay(Sensor& sensor) {
  const SensorRecord& record = *sensor.model->record;
  for (; sensor.row < record.arrivals.size(); ++sensor.row) {
    if (record.arrivals[sensor.row] > run_.time() + Channel::kSameTime) return;
    const auto row = static_cast<Eigen::Index>(sensor.row);
    for (std::size_t c = 0; c < sensor.truth.size(); ++c) {
      sensor.truth[c] = record.values(row, static_cast<Eigen::Index>(c));
    }
    sensor.channel.receive(record.times[sensor.row], sensor.truth);
  }
}

void Sensors::begin() {
  for (Sensor& sensor : sensors_) {
    sensor.channel.restart();
    sensor.row = 0;
    sensor.model->source->begin(run_, sensor.memory);
    sample(sensor);
  }
}

void Sensors::advance() {
  for (Sensor& sensor : sensors_) {
    sensor.model->source->advance(run_, run_.model->step().time_step, sensor.memory);
    sample(sensor);
  }
}

void Sensors::settle(run::Rest rest) {
  if (rest == run::Rest::end_of_path) return;
  for (Sensor& sensor : sensors_) {
    sensor.model->source->begin(run_, sensor.memory);
    if (sensor.model->record) continue;
    sensor.model->source->read(run_, sensor.memory, sensor.truth);
    sensor.channel.settle(run_.time(), sensor.truth);
  }
}

void Sensors::read_true(int index, std::span<double> values) const {
  const Sensor& sensor = at(index);
  sensor.model->source->read(run_, sensor.memory, values);
}

std::vector<double> Sensors::truth(int index) const {
  std::vector<double> values(at(index).channel.size());
  read_true(index, values);
  return values;
}

void Sensors::feed(int index, double time, std::span<const double> value) {
  sensors_[static_cast<std::size_t>(index)].channel.receive(time, value);
}

void Sensors::save(std::vector<double>& memory) const {
  for (const Sensor& sensor : sensors_) {
    memory.push_back(static_cast<double>(sensor.row));
    memory.insert(memory.end(), sensor.memory.begin(), sensor.memory.end());
    sensor.channel.save(memory);
  }
}

void Sensors::load(std::span<const double> memory) {
  if (take(memory)) return;
  throw Error(ErrorKind::wrong_length, {.item = "sensors of the state"}, "their memory is damaged",
              "take the state from a simulation of the same model");
}

bool Sensors::take(std::span<const double> memory) {
  for (Sensor& sensor : sensors_) {
    if (memory.size() < 1 + sensor.memory.size()) return false;
    sensor.row = whole<std::size_t>(memory.front());
    std::copy_n(memory.begin() + 1, sensor.memory.size(), sensor.memory.begin());
    memory = memory.subspan(1 + sensor.memory.size());
    if (!sensor.channel.load(memory)) return false;
  }
  return memory.empty();
}

std::vector<run::Reading> Sensors::readings() const {
  std::vector<run::Reading> all;
  for (const Sensor& sensor : sensors_) {
    const std::string& name = sensor.model->name;
    const auto& numbers = sensor.model->source->components();
    std::vector<run::Observable> parts;
    const auto add = [&](const char* quantity) {
      run::Observable one =
          observable_of(run::ObservableKind::sensor, name, quantity, numbers.front().unit);
      if (numbers.size() > 1) {
        one.shape = {numbers.size()};
        one.components.clear();
        for (const auto& number : numbers) {
          one.components.push_back(fmt::format("{}_{}", one.name, number.name));
        }
      }
      parts.push_back(std::move(one));
    };
    add("measured");
    add("true");
    parts.push_back(observable_of(run::ObservableKind::sensor, name, "sample_time", "s"));
    all.push_back({std::move(parts), [this, &sensor](std::span<double> to) {
                     const std::size_t size = sensor.channel.size();
                     std::ranges::copy(sensor.channel.value(), to.begin());
                     sensor.model->source->read(run_, sensor.memory, to.subspan(size, size));
                     to.back() = sensor.channel.time();
                   }});
  }
  return all;
}

}  // namespace sinew::sense
