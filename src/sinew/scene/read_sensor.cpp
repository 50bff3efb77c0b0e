#include <array>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/axis_names.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

std::vector<std::string> axes() { return {kAxisNames.begin(), kAxisNames.end()}; }

// Types differ in their keys.
bool may_have(const Fields& fields, const char* key) { return fields.table().find(key) != nullptr; }
bool has(const Fields& fields, const char* key) {
  return may_have(fields, key) && fields.find(key) != nullptr;
}

PointList one_point(const Fields& fields, std::string_view key) {
  Vector3 point;
  fields.read(key, point);
  const Location place = fields.place(key);
  return {.place = place, .points = point.transpose(), .places = {place}};
}

void read_marker(const Fields& fields, SensorDescription& sensor, const ReadContext& context) {
  FixedRegion set;
  set.kind = FixedRegion::Kind::set;
  if (fields.read("set", set.set)) {
    set.place = fields.place("set");
    sensor.region = std::move(set);
  } else if (fields.find("point") != nullptr) {
    sensor.points = one_point(fields, "point");
  } else {
    sensor.points = read_points(fields, "points", context);
  }
}

void read_places(const Fields& fields, SensorDescription& sensor) {
  const Form& form = fields.form("places");
  for (const Node& item : fields.find("places")->items()) {
    sensor.places.push_back(read_numbers(item, select_form(item, form.items, {})).front());
  }
  fields.read("gauge", sensor.gauge);
  if (const Node* about = fields.find("about")) {
    sensor.about = read_axis(*about, {fields.form("about")});
  }
}

void read_electrode(const Fields& fields, SurfaceDescription& surface) {
  if (fields.find("patch") == nullptr) {
    surface.region = read_region(fields);
    surface.place = surface.region.place;
    return;
  }
  surface.kind = SurfaceDescription::Kind::patch;
  surface.place = fields.place("patch");
  fields.below("patch").read("point", surface.point);
  fields.below("patch").read("angle", surface.angle);
}

void read_electrodes(const Fields& fields, SensorDescription& sensor) {
  const Form& form = fields.form("electrodes");
  for (std::size_t k = 0; k < 2; ++k) {
    const Node& item = fields.find("electrodes")->items()[k];
    const Fields electrode(item, select_form(item, form.items, {}));
    read_electrode(electrode, sensor.electrodes[k]);
    sensor.electrode_bodies[k] = sensor.body;
    electrode.read("body", sensor.electrode_bodies[k]);
  }
  fields.read("permittivity", sensor.permittivity);
}

void read_patch(const Fields& fields, SensorDescription& sensor) {
  fields.read("contact", sensor.contact);
  if (fields.find("patch") == nullptr) return;
  const Fields patch = fields.below("patch");
  sensor.region = read_region(patch);
  patch.read("body", sensor.patch_body);
}

// Reads the measured quantity. @return the names of its components.
std::vector<std::string> read_measured(const Fields& fields, SensorDescription& sensor,
                                       const ReadContext& context) {
  const std::string& type = sensor.type;
  if (type == "marker") {
    read_marker(fields, sensor, context);
    return axes();
  }
  if (has(fields, "at")) {
    const bool single = fields.form("at").shape == Shape::quantity;
    sensor.points = single ? one_point(fields, "at") : read_points(fields, "at", context);
    return type == "orientation" ? std::vector<std::string>{"rx", "ry", "rz"} : axes();
  }
  if (has(fields, "line")) sensor.points = read_points(fields, "line", context);
  if (type == "curvature") {
    read_places(fields, sensor);
    std::vector<std::string> names;
    for (std::size_t k = 0; k < sensor.places.size(); ++k) names.push_back(std::to_string(k));
    return names.size() == 1 ? std::vector<std::string>{} : names;
  }
  if (type == "capacitance") read_electrodes(fields, sensor);
  if (type == "contact-force" || type == "touch") read_patch(fields, sensor);
  if (type == "touch") fields.read("threshold", sensor.threshold);
  if (may_have(fields, "samples")) fields.read("samples", sensor.samples);
  if (type == "resistance") {
    fields.read("resistance", sensor.resistance);
    fields.read("gauge_factor", sensor.gauge_factor);
  }
  if (type == "attenuation") {
    fields.read("loss_per_length", sensor.loss_per_length);
    fields.read("loss_per_turn", sensor.loss_per_turn);
  }
  if (type == "motor-current") {
    sensor.turns = fields.read("torque_constant", sensor.motor_constant);
    if (!sensor.turns) fields.read("force_constant", sensor.motor_constant);
    fields.read("radius", sensor.radius);
  }
  return {};
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
  if (!may_have(fields, "noise")) return;
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

SensorDescription read_sensor(const Node::Entry& entry, const ReadContext& context) {
  SensorDescription sensor;
  sensor.name = entry.key;
  sensor.place = entry.key_place;
  const Form& form = form_of(grammar(), "sensors", Shape::names).items.front();
  const Fields fields(entry.value, form);
  sensor.type = read_text(*entry.value.find(form.telltale));
  if (may_have(fields, "body")) fields.read("body", sensor.body);
  if (may_have(fields, "actuator")) fields.read("actuator", sensor.actuator);
  if (may_have(fields, "outside")) {
    fields.read_choice("outside", sensor.outside,
                       {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
  }
  const auto numbers = read_measured(fields, sensor, context);
  read_channel(fields, sensor);
  if (fields.find("file") == nullptr) return sensor;
  check_record(fields, sensor.channel);
  sensor.record = read_sensor_record(fields, sensor, numbers, context);
  return sensor;
}

}  // namespace sinew::scene
