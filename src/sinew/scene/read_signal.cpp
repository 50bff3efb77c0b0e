#include <utility>
#include <vector>

#include "sinew/model/signal.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

model::Signal read_ramp(const Fields& fields) {
  model::Ramp ramp;
  fields.read("from", ramp.from);
  fields.read("to", ramp.to);
  fields.read("start", ramp.start);
  fields.read("duration", ramp.duration);
  return model::Signal::ramp(ramp);
}

model::Signal read_sine(const Fields& fields) {
  model::Sine sine;
  fields.read("mean", sine.mean);
  fields.read("amplitude", sine.amplitude);
  fields.read("period", sine.period);
  fields.read("phase", sine.phase);
  double frequency = 0.0;
  if (fields.read("frequency", frequency)) sine.period = 1.0 / frequency;
  return model::Signal::sine(sine);
}

model::Signal read_steps(const Fields& fields) {
  std::vector<std::pair<double, double>> steps;
  for (const Sample& sample : read_samples(*fields.find("steps"), fields.form("steps"))) {
    steps.emplace_back(sample.time, sample.value);
  }
  return model::Signal::steps(steps);
}

model::Signal read_sampled(const Fields& fields, const ReadContext& context) {
  TimeTable table = read_time_table(fields, 1, context);
  if (context.files == Files::ignore) return {};
  std::vector<double> values(table.values.data(), table.values.data() + table.values.size());
  return model::Signal::sampled(std::move(table.times), std::move(values));
}

}  // namespace

model::Signal read_signal(const Fields& fields, std::string_view key, const ReadContext& context) {
  double value = 0.0;
  if (fields.form(key).shape == Shape::quantity) {
    fields.read(key, value);
    return model::Signal::constant(value);
  }
  const Fields signal = fields.below(key);
  if (signal.find("file") != nullptr) {
    return at_place(signal.place("file"), [&] { return read_sampled(signal, context); });
  }
  if (signal.find("ramp") != nullptr) {
    return at_place(signal.place("ramp"), [&] { return read_ramp(signal.below("ramp")); });
  }
  if (signal.find("sine") != nullptr) {
    return at_place(signal.place("sine"), [&] { return read_sine(signal.below("sine")); });
  }
  return at_place(signal.place("steps"), [&] { return read_steps(signal); });
}

}  // namespace sinew::scene
