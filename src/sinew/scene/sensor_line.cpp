// Sensors along a line of a body: types stretch, resistance and attenuation.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::vector<Key> sampled_line_keys() {
  std::vector<Key> keys = sensed_line_keys();
  keys.push_back(line_samples_key());
  return keys;
}

std::shared_ptr<const KeyTable> stretch_table() {
  return sensor_table("stretch", "Strain of a line: L/L_0 - 1.", sampled_line_keys(),
                      {plain_number(), "0.001", "1e-4", "-0.5 1"});
}

std::shared_ptr<const KeyTable> resistance_table() {
  std::vector<Key> keys = sampled_line_keys();
  keys.push_back(positive_key("resistance", resistance(), "1 kOhm", "Resistance at rest R_0."));
  keys.push_back(positive_key("gauge_factor", plain_number(), "2", "Gauge factor G."));
  return sensor_table("resistance",
                      "A resistive strain gauge along a line: R_0 (1 + G (L/L_0 - 1)), Ohm.",
                      std::move(keys), {resistance(), "1 Ohm", "0.1 Ohm", "0 2 kOhm"});
}

Key loss_key(const char* name, const Measure& measure, const char* example,
             const char* description) {
  return {.name = name,
          .forms = {quantity(measure, non_negative())},
          .example = example,
          .default_text = "0",
          .description = description};
}

std::shared_ptr<const KeyTable> attenuation_table() {
  std::vector<Key> keys = sampled_line_keys();
  keys.push_back(
      loss_key("loss_per_length", curvature(), "20 dB/m", "Coefficient a, loss per length."));
  keys.push_back(loss_key("loss_per_turn", plain_number(), "1.5 dB",
                          "Coefficient b, loss per turning angle, dB/rad."));
  return sensor_table("attenuation",
                      "Loss of light in a waveguide along a line, dB: a L + b times the total "
                      "turning angle (the integral of the curvature's magnitude).",
                      std::move(keys), {plain_number(), "0.01 dB", "0.01 dB", "0 40 dB"});
}

}  // namespace
}  // namespace forms

namespace {

using Line = sense::SensorLine;

Line read_line(Line::What what, const Fields& fields, const ReadContext& context) {
  Line line{.what = what};
  line.line.corners = read_points(fields, "line", context).points;
  fields.read("samples", line.line.samples);
  return line;
}

void read_stretch(const Fields& fields, const ReadContext& context, SensorDescription& sensor) {
  sensor.own = read_line(Line::What::stretch, fields, context);
}

void read_resistance(const Fields& fields, const ReadContext& context, SensorDescription& sensor) {
  Line line = read_line(Line::What::resistance, fields, context);
  fields.read("resistance", line.resistance);
  fields.read("gauge_factor", line.gauge_factor);
  sensor.own = std::move(line);
}

void read_attenuation(const Fields& fields, const ReadContext& context, SensorDescription& sensor) {
  Line line = read_line(Line::What::attenuation, fields, context);
  fields.read("loss_per_length", line.loss_per_length);
  fields.read("loss_per_turn", line.loss_per_turn);
  sensor.own = std::move(line);
}

sense::MakeSource line_source(const SensorSite& site) {
  Line line = *site.sensor.as<Line>();
  line.line.body = site.body();
  return line;
}

}  // namespace

const SensorKind& stretch_kind() {
  static const SensorKind kind{.word = "stretch",
                               .description = "Strain along a line.",
                               .table = forms::stretch_table,
                               .read = read_stretch,
                               .source = line_source};
  return kind;
}

const SensorKind& resistance_kind() {
  static const SensorKind kind{.word = "resistance",
                               .description = "Resistive strain gauge along a line.",
                               .table = forms::resistance_table,
                               .read = read_resistance,
                               .source = line_source};
  return kind;
}

const SensorKind& attenuation_kind() {
  static const SensorKind kind{.word = "attenuation",
                               .description = "Loss of light along a line.",
                               .table = forms::attenuation_table,
                               .read = read_attenuation,
                               .source = line_source};
  return kind;
}

}  // namespace sinew::scene
