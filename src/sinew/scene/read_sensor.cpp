#include <utility>

#include <fmt/format.h>

#include "sinew/core/axis_names.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/scene/sensor_kind.hpp"

namespace sinew::scene {

namespace {

bool has(const Fields& fields, const char* key) {
  return fields.may_have(key) && fields.find(key) != nullptr;
}

void read_channel(const Fields& fields, SensorDescription& sensor) {
  sense::ChannelSettings& channel = sensor.channel;
  fields.read("rate", channel.rate);
  sensor.rate_place = fields.place("rate");
  fields.read("delay", channel.delay);
  fields.read("dropout", channel.dropout);
  fields.read("timeout", channel.timeout);
  int seed = 0;
  if (fields.read("seed", seed)) channel.seed = static_cast<std::uint64_t>(seed);
  if (!fields.may_have("noise")) return;
  fields.read("noise", channel.noise);
  fields.read("bias", channel.bias);
  fields.read("drift", channel.drift);
  fields.read("quantum", channel.quantum);
  std::vector<double> range;
  if (!fields.read_numbers("range", range)) return;
  channel.min = range[0];
  channel.max = range[1];
  if (channel.min < channel.max) return;
  throw Error(
      ErrorKind::contradictory_limits, fields.place("range"),
      fmt::format("the range ends at {:g}, before its start at {:g}", channel.max, channel.min),
      "give the least value first");
}

// Refuses simulated errors for recorded samples, since a real sensor has its own errors.
void check_record(const Fields& fields, const sense::ChannelSettings& channel) {
  const std::pair<const char*, bool> simulated[] = {
      {"bias", channel.bias != 0.0},       {"drift", channel.drift != 0.0},
      {"quantum", channel.quantum != 0.0}, {"range", has(fields, "range")},
      {"dropout", channel.dropout != 0.0}, {"seed", channel.seed != 0}};
  for (const auto& [key, asked] : simulated) {
    if (!asked) continue;
    throw Error(ErrorKind::conflicting_keys, fields.place(key),
                fmt::format("'{}' with 'file': a real sensor's samples are taken as they are", key),
                fmt::format("remove {}, or file", key));
  }
}

}  // namespace

std::vector<std::string> axis_numbers(const SensorDescription& /*sensor*/) {
  return {kAxisNames.begin(), kAxisNames.end()};
}

SensorDescription read_sensor(const Node::Entry& entry, const ReadContext& context) {
  SensorDescription sensor;
  sensor.name = entry.key;
  sensor.place = entry.key_place;
  const Form& form = form_of(grammar(), "sensors", Shape::names).items.front();
  const Fields fields(entry.value, form);
  sensor.kind = &sensor_kind(read_text(*entry.value.find(form.telltale)));
  if (fields.may_have("body")) fields.read("body", sensor.body);
  if (fields.may_have("actuator")) fields.read("actuator", sensor.actuator);
  if (fields.may_have("outside")) read_outside(fields, sensor.outside);
  if (sensor.kind->read != nullptr) sensor.kind->read(fields, context, sensor);
  read_channel(fields, sensor);
  if (fields.find("file") == nullptr) return sensor;
  check_record(fields, sensor.channel);
  const auto numbers = sensor.kind->numbers;
  sensor.record = read_sensor_record(
      fields, sensor, numbers == nullptr ? std::vector<std::string>{} : numbers(sensor), context);
  return sensor;
}

}  // namespace sinew::scene
