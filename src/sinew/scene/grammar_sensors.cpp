// The keys that sensors share, with those of their channel.
#include <iterator>
#include <utility>

#include "sinew/scene/sensor_fields.hpp"

namespace sinew::scene::forms {

namespace {

std::vector<Key> transport_keys() {
  return {{.name = "rate",
           .forms = {quantity(frequency(), positive())},
           .example = "100 Hz",
           .description = "Samples per second: a sample every k-th time step, with integer k. "
                          "Default: one sample per step."},
          {.name = "delay",
           .forms = {quantity(time(), non_negative())},
           .example = "20 ms",
           .default_text = "0 s",
           .description = "Time from taking a sample to its delivery. It arrives at the first step "
                          "after that time."},
          {.name = "dropout",
           .forms = {quantity(plain_number(), {.min = 0.0, .max = 1.0})},
           .example = "1 %",
           .default_text = "0",
           .description = "Probability that a sample is lost; the previous one then remains."},
          {.name = "timeout",
           .forms = {quantity(time(), positive())},
           .example = "100 ms",
           .description = "Age from which a sample is no longer valid. Default: no limit."},
          {.name = "seed",
           .forms = {integer(0, 2'000'000'000)},
           .example = "1",
           .default_text = "0",
           .description = "Seed of the random numbers, which also depend on the sensor's name."}};
}

std::vector<Key> file_keys(const Measure& measure) {
  std::vector<Key> keys = {
      {.name = "file",
       .forms = {file()},
       .example = "measured.csv",
       .description =
           "CSV file with samples of a real sensor, which replace the simulated ones: times in s "
           "in the first column, then values; or with headings, as in sensors.csv. `delay` is "
           "added to the times. `noise` then states the accuracy of the sensor."},
      {.name = "columns",
       .forms = {list({text()})},
       .example = "[marker_x, marker_y, marker_z]",
       .description = "Headings of the columns with the values. Default: the headings of "
                      "sensors.csv, or else all columns after the time.",
       .only_with = "file"},
      {.name = "missing",
       .forms = {choice({{"error", "Cells that are empty or nan, and gaps in time, are errors."},
                         {"lost", "They count as lost samples."}})},
       .example = "lost",
       .default_text = "error",
       .description = "Meaning of samples that are missing from the file. With `rate`, times more "
                      "than one and a half periods apart are a gap.",
       .only_with = "file"}};
  if (*measure.unit != '\0') {
    keys.push_back(
        {.name = "unit",
         .forms = {unit(measure)},
         .example = measure.unit,
         .description = "Unit of the file's values. Default: the unit in the headings, or else SI.",
         .only_with = "file"});
  }
  return keys;
}

std::vector<Key> error_keys(const OutputWords& said) {
  const std::string zero = std::string("0 ") + said.measure.unit;
  return {
      {.name = "noise",
       .forms = {quantity(said.measure, non_negative())},
       .example = said.error,
       .default_text = zero,
       .description = "Standard deviation of the white noise on each component of each sample."},
      {.name = "bias",
       .forms = {quantity(said.measure)},
       .example = said.error,
       .default_text = zero,
       .description = "Constant error."},
      {.name = "drift",
       .forms = {quantity(said.measure, non_negative())},
       .example = said.error,
       .default_text = zero,
       .description =
           "Standard deviation of a random walk after 1 s; it grows with the square root of time."},
      {.name = "quantum",
       .forms = {quantity(said.measure, positive())},
       .example = said.quantum,
       .description = "Step to which values are rounded. Default: no rounding."},
      {.name = "range",
       .forms = {vector(said.measure, 2)},
       .example = said.range,
       .description =
           "Smallest and largest value, at which the sensor saturates. Default: no limits."}};
}

void append(std::vector<Key>& keys, std::vector<Key> more) {
  std::ranges::move(more, std::back_inserter(keys));
}

std::vector<Key> channel_keys(const OutputWords& said) {
  std::vector<Key> keys = error_keys(said);
  append(keys, transport_keys());
  append(keys, file_keys(said.measure));
  return keys;
}

// A table of the keys of all sensors, used only for the reference.
std::shared_ptr<const KeyTable> channel_table() {
  static const auto table = make_table(
      {.name = "keys of all sensors",
       .description = "Errors, timing and files. Errors, quantum and range have the unit of the "
                      "measured quantity; the table shows them for a length.",
       .keys = channel_keys(position_output())});
  return table;
}

std::shared_ptr<const KeyTable> table_of(const char* type, const char* description,
                                         std::vector<Key> own, std::vector<Key> channel) {
  KeyTable sensor{.name = std::string("sensor: type ") + type,
                  .description = description,
                  .keys = std::move(own),
                  .shared = channel_table()};
  append(sensor.keys, std::move(channel));
  return make_table(std::move(sensor));
}

}  // namespace

std::shared_ptr<const KeyTable> sensor_table(const char* type, const char* description,
                                             std::vector<Key> own, const OutputWords& output) {
  return table_of(type, description, std::move(own), channel_keys(output));
}

std::shared_ptr<const KeyTable> sensor_table(const char* type, const char* description,
                                             std::vector<Key> own) {
  std::vector<Key> channel = transport_keys();
  append(channel, file_keys(plain_number()));
  return table_of(type, description, std::move(own), std::move(channel));
}

OutputWords position_output() { return {length(), "0.1 mm", "0.01 mm", "-0.5 0.5 m"}; }

Key measured_actuator_key(const char* example) {
  return {.name = "actuator",
          .forms = {reference("actuators")},
          .example = example,
          .description = "The actuator that it measures.",
          .required = true};
}

std::vector<Key> sensed_line_keys() {
  return {body_key(),
          {.name = "line",
           .forms = {table(point_file_table()), list({vector(length())}, 2)},
           .example = "[0 0 0 mm, 0 0 195 mm]",
           .description = "Corners of the sensor's line, in the mesh at rest.",
           .required = true},
          outside_key()};
}

Key line_samples_key() {
  return {.name = "samples",
          .forms = {integer(2, 10000)},
          .example = "21",
          .default_text = "21",
          .description =
              "Number of points along the line, evenly spaced at rest; the "
              "corners are always included."};
}

Key positive_key(const char* name, const Measure& measure, const char* example,
                 const char* description) {
  return {.name = name,
          .forms = {quantity(measure, positive())},
          .example = example,
          .description = description,
          .required = true};
}

}  // namespace sinew::scene::forms
