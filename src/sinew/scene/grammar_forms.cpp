#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

Measure plain_number() { return {dimension::kNone, ""}; }
Measure length() { return {dimension::kLength, "m"}; }
Measure time() { return {dimension::kTime, "s"}; }
Measure angle() { return {dimension::kNone, "rad"}; }
Measure acceleration() { return {dimension::kAcceleration, "m/s^2"}; }
Measure stress() { return {dimension::kPressure, "Pa"}; }
Measure pressure() { return {dimension::kPressure, "Pa", Usual::pressure}; }
Measure elastic_modulus() { return {dimension::kPressure, "Pa", Usual::modulus}; }
Measure force_per_area() { return {dimension::kPressure, "Pa", Usual::force_per_area}; }
Measure energy_per_volume() { return {dimension::kPressure, "Pa", Usual::energy_per_volume}; }
Measure mass() { return {dimension::kMass, "kg", Usual::mass}; }
Measure density() { return {dimension::kDensity, "kg/m^3", Usual::density}; }
Measure inertia() { return {Dimension{2, 1, 0}, "kg m^2"}; }
Measure force() { return {dimension::kForce, "N"}; }
Measure frequency() { return {dimension::kFrequency, "1/s"}; }
Measure integral_gain() { return {Dimension{0, 0, -2}, "1/s^2"}; }
Measure speed() { return {dimension::kVelocity, "m/s"}; }
Measure angular_speed() { return {dimension::kFrequency, "rad/s"}; }
Measure force_rate() { return {Dimension{1, 1, -3}, "N/s"}; }
Measure torque() { return {dimension::kEnergy, "N m"}; }
Measure torque_rate() { return {Dimension{2, 1, -3}, "N m/s"}; }
Measure angular_damper() { return {Dimension{2, 1, -1}, "N m s"}; }
Measure volume() { return {dimension::kVolume, "m^3"}; }
Measure volume_rate() { return {dimension::kVolumeRate, "m^3/s"}; }
Measure pressure_rate() { return {dimension::kPressureRate, "Pa/s"}; }
Measure conductance() { return {dimension::kConductance, "m^3/(s Pa)"}; }
Measure stiffness() { return {dimension::kStiffness, "N/m", Usual::stiffness}; }
Measure force_per_length() { return {dimension::kStiffness, "N/m", Usual::force_per_length}; }
Measure damper() { return {dimension::kDamping, "N s/m"}; }
Measure power() { return {dimension::kPower, "W"}; }
Measure temperature() { return {dimension::kTemperature, "K"}; }
Measure heat_capacity() { return {dimension::kHeatCapacity, "J/K"}; }
Measure heat_loss() { return {dimension::kHeatLoss, "W/K"}; }
Measure curvature() { return {Dimension{-1, 0, 0}, "1/m"}; }
Measure current() { return {dimension::kCurrent, "A"}; }
Measure resistance() { return {dimension::kResistance, "Ohm"}; }
Measure capacitance() { return {dimension::kCapacitance, "F"}; }
Measure torque_constant() { return {Dimension{2, 1, -2, 0, -1}, "N m/A"}; }
Measure force_constant() { return {Dimension{1, 1, -2, 0, -1}, "N/A"}; }

Range any() { return {}; }
Range positive() { return {.min = 0.0, .above_min = true}; }
Range non_negative() { return {.min = 0.0}; }

Form quantity(const Measure& measure, Range range) {
  Form form;
  form.shape = Shape::quantity;
  form.dimension = measure.dimension;
  form.usual = measure.usual;
  form.unit = measure.unit;
  form.range = range;
  return form;
}

Form vector(const Measure& measure, int count) {
  Form form = quantity(measure);
  form.min_count = count;
  form.max_count = count;
  return form;
}

Form numbers(int min_count, int max_count, Range range) {
  Form form = quantity(plain_number(), range);
  form.min_count = min_count;
  form.max_count = max_count;
  return form;
}

Form unit(const Measure& measure) {
  Form form = quantity(measure, positive());
  form.shape = Shape::unit;
  return form;
}

Form integer(int min, int max) {
  Form form;
  form.shape = Shape::integer;
  form.range.min = min;
  form.range.max = max;
  return form;
}

Form boolean() {
  Form form;
  form.shape = Shape::boolean;
  return form;
}

Form text() { return {}; }

Form file() {
  Form form;
  form.shape = Shape::file;
  return form;
}

Form reference(const char* top_level_key, std::vector<Choice> words) {
  Form form;
  form.shape = Shape::reference;
  form.choices = std::move(words);
  form.refers_to = top_level_key;
  return form;
}

Form touching_body() {
  Form form = reference("bodies");
  form.takes_planes = true;
  return form;
}

Form choice(std::vector<Choice> choices, const char* short_for) {
  Form form;
  form.shape = Shape::choice;
  form.choices = std::move(choices);
  form.telltale = short_for;
  return form;
}

Form list(std::vector<Form> items, int min_count, int max_count) {
  Form form;
  form.shape = Shape::list;
  form.items = std::move(items);
  form.min_count = min_count;
  form.max_count = max_count;
  return form;
}

Form samples(const Measure& measure) {
  Form form = quantity(measure);
  form.shape = Shape::samples;
  form.max_count = kAnyNumber;
  return form;
}

Form table(std::shared_ptr<const KeyTable> table, const char* telltale) {
  Form form;
  form.shape = Shape::table;
  form.table = std::move(table);
  form.telltale = telltale;
  return form;
}

Form variants(const char* telltale, std::vector<Choice> choices) {
  Form form;
  form.shape = Shape::variants;
  form.telltale = telltale;
  form.choices = std::move(choices);
  return form;
}

Form names(Form item, int min_count, const char* refers_to) {
  Form form;
  form.shape = Shape::names;
  form.min_count = min_count;
  form.refers_to = refers_to;
  form.items.push_back(std::move(item));
  return form;
}

Form later(Form form) {
  form.later = true;
  return form;
}

Key shape_length(const char* name, const char* example, const char* description) {
  return {.name = name,
          .forms = {quantity(length(), positive())},
          .example = example,
          .description = description,
          .required = true};
}

std::shared_ptr<const KeyTable> make_table(KeyTable table) {
  return std::make_shared<const KeyTable>(std::move(table));
}

Key mesh_file_key(const char* example) {
  return {.name = "file",
          .forms = {file()},
          .example = example,
          .description = "Path of the mesh, relative to the scene file.",
          .required = true};
}

Key file_unit_key(const char* only_with) {
  return {.name = "unit",
          .forms = {unit(length())},
          .example = "mm",
          .default_text = "m",
          .description = "Length unit of the file's coordinates.",
          .only_with = only_with};
}

Key file_scale_key() {
  return {.name = "scale",
          .forms = {numbers(1, 3, any())},
          .example = "1.5",
          .default_text = "1",
          .description =
              "Factor of the file's coordinates, or three factors along its x, y and z; "
              "a negative factor mirrors."};
}

}  // namespace sinew::scene::forms
