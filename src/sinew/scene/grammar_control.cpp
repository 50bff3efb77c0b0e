// The tables of signals and targets, and the keys that all controllers have.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

// Name of a table: "ramp in m", or "ramp" for dimensionless numbers.
std::string with_unit(const char* name, const Measure& measure) {
  return std::string(name) + (*measure.unit == '\0' ? "" : " in ") + measure.unit;
}

std::shared_ptr<const KeyTable> ramp_table(const Measure& measure, const char* example) {
  return make_table(
      {.name = with_unit("ramp", measure),
       .description = "Linear change from one value to another, then constant.",
       .keys = {{.name = "from",
                 .forms = {quantity(measure)},
                 .example = *measure.unit == '\0' ? "0" : std::string("0 ") + measure.unit,
                 .default_text = "0",
                 .description = "Initial value."},
                {.name = "to",
                 .forms = {quantity(measure)},
                 .example = example,
                 .description = "Final value.",
                 .required = true},
                {.name = "start",
                 .forms = {quantity(time(), non_negative())},
                 .example = "0.5 s",
                 .default_text = "0 s",
                 .description = "Start time."},
                {.name = "duration",
                 .forms = {quantity(time(), positive())},
                 .example = "1 s",
                 .description = "Duration.",
                 .required = true}}});
}

std::shared_ptr<const KeyTable> sine_table(const Measure& measure, const char* example) {
  return make_table({.name = with_unit("sine", measure),
                     .description = "mean + amplitude sin(2 pi t / period + phase).",
                     .keys = {{.name = "mean",
                               .forms = {quantity(measure)},
                               .example = example,
                               .default_text = "0",
                               .description = "Mean value."},
                              {.name = "amplitude",
                               .forms = {quantity(measure)},
                               .example = example,
                               .description = "Amplitude, half the range.",
                               .required = true},
                              {.name = "period",
                               .forms = {quantity(time(), positive())},
                               .example = "2 s",
                               .description = "Period."},
                              {.name = "frequency",
                               .forms = {quantity(frequency(), positive())},
                               .example = "0.5 Hz",
                               .description = "Frequency."},
                              {.name = "phase",
                               .forms = {quantity(angle())},
                               .example = "90 deg",
                               .default_text = "0",
                               .description = "Phase at time 0."}},
                     .alternatives = {{{"period", "frequency"}, true}}});
}

Key path_file_key(const char* description) {
  return {.name = "file", .forms = {file()}, .example = "path.csv", .description = description};
}

Key path_unit_key(const Measure& measure, const char* example) {
  return {.name = "unit",
          .forms = {unit(measure)},
          .example = example,
          .default_text = measure.unit,
          .description = "Unit of the file's values. Times are in s.",
          .only_with = "file"};
}

std::shared_ptr<const KeyTable> circle_table() {
  return make_table(
      {.name = "circle",
       .description = "A circle at constant speed, counter-clockwise about its normal. It starts "
                      "in the direction of the x axis (of the y axis if the normal is close to x).",
       .keys = {{.name = "centre",
                 .forms = {vector(length())},
                 .example = "0 0 190 mm",
                 .description = "Its centre.",
                 .required = true},
                {.name = "radius",
                 .forms = {quantity(length(), positive())},
                 .example = "30 mm",
                 .description = "Its radius.",
                 .required = true},
                {.name = "normal",
                 .forms = {vector(plain_number())},
                 .example = "0 0 1",
                 .default_text = "0 0 1",
                 .description = "Normal of the circle; any non-zero length."},
                {.name = "period",
                 .forms = {quantity(time(), positive())},
                 .example = "10 s",
                 .description = "Time of one turn.",
                 .required = true},
                {.name = "start_angle",
                 .forms = {quantity(angle())},
                 .example = "90 deg",
                 .default_text = "0",
                 .description = "Angle on the circle at which it starts."}}});
}

std::shared_ptr<const KeyTable> polyline_table() {
  return make_table({.name = "polyline",
                     .description = "Straight lines at constant speed; the end is held.",
                     .keys = {{.name = "points",
                               .forms = {table(point_file_table()), list({vector(length())}, 2)},
                               .example = "[0 0 190 mm, 20 0 185 mm]",
                               .description = "Corners of the path.",
                               .required = true},
                              {.name = "speed",
                               .forms = {quantity(speed(), positive())},
                               .example = "10 mm/s",
                               .description = "Speed along the path."},
                              {.name = "period",
                               .forms = {quantity(time(), positive())},
                               .example = "5 s",
                               .description = "Time for the whole path once."},
                              {.name = "closed",
                               .forms = {boolean()},
                               .example = "true",
                               .default_text = "false",
                               .description = "Returns to the first corner and repeats."}},
                     .alternatives = {{{"speed", "period"}, true}}});
}

std::shared_ptr<const KeyTable> target_table() {
  return make_table(
      {.name = "target",
       .description =
           "Desired path of the effector over time: exactly one of circle, polyline and file.",
       .keys = {{.name = "circle",
                 .forms = {table(circle_table())},
                 .example = "{centre: 0 0 190 mm, radius: 30 mm, period: 10 s}",
                 .description = "A circle."},
                {.name = "polyline",
                 .forms = {table(polyline_table())},
                 .example = "{points: [0 0 190 mm, 20 0 185 mm], speed: 10 mm/s}",
                 .description = "Straight lines."},
                path_file_key("A CSV table with four columns, time x y z."),
                path_unit_key(length(), "mm")},
       .alternatives = {{{"circle", "polyline", "file"}, true}}});
}

std::shared_ptr<const KeyTable> rotation_table() {
  return make_table({.name = "rotation",
                     .description = "Rotation vectors over time.",
                     .keys = {{.name = "file",
                               .forms = {file()},
                               .example = "turn.csv",
                               .description = "A CSV table with four columns, time and the "
                                              "components of the rotation vector.",
                               .required = true},
                              path_unit_key(angle(), "deg")}});
}

Form task_form() {
  return table(make_table(
      {.name = "task",
       .description =
           "Target of one effector: `target` for a position, or `rotation` for an orientation.",
       .keys = {{.name = "target",
                 .forms = {vector(length()), table(target_table())},
                 .example = "0 0 190 mm",
                 .description = "Desired position: a point or a path."},
                {.name = "rotation",
                 .forms = {vector(angle()), table(rotation_table())},
                 .example = "0 0 10 deg",
                 .description =
                     "Desired orientation, as a rotation vector from rest (axis times angle)."},
                {.name = "weight",
                 .forms = {numbers(1, 3, non_negative())},
                 .example = "1 1 0.1",
                 .default_text = "1",
                 .description =
                     "Weight of the effector's error: one number, or one per direction."},
                {.name = "priority",
                 .forms = {integer(1, 3)},
                 .example = "2",
                 .default_text = "1",
                 .description = "1 is the highest priority. An effector's error moves an effector "
                                "of the next higher priority by about 1e-4 of that error."}},
       .alternatives = {{{"target", "rotation"}, true}}}));
}

}  // namespace

std::shared_ptr<const KeyTable> signal_table(const Measure& measure, const char* value_example) {
  const std::string value = value_example;
  const bool plain = *measure.unit == '\0';
  KeyTable signal{
      .name = with_unit("signal", measure),
      .description =
          "A value over time: exactly one of ramp, sine, steps and file. Values have the dimension "
          "of the key to which the signal belongs.",
      .keys = {{.name = "ramp",
                .forms = {table(ramp_table(measure, value_example))},
                .example = "{to: " + value + ", duration: 1 s}",
                .description = "A ramp."},
               {.name = "sine",
                .forms = {table(sine_table(measure, value_example))},
                .example = "{amplitude: " + value + ", period: 2 s}",
                .description = "A sine."},
               {.name = "steps",
                .forms = {samples(measure)},
                .example = "[[0 s, 0" + (plain ? "" : " " + std::string(measure.unit)) +
                           "], [1 s, " + value + "]]",
                .description = "Steps: pairs of time and value, the first at 0 s."},
               path_file_key("A CSV table with two columns, time and value, or with headings and "
                             "`column`. Values between the times are interpolated linearly."),
               {.name = "column",
                .forms = {text()},
                .example = "second",
                .description = "Heading of the column with the values, with or without its \" "
                               "[unit]\". Values have the unit in the heading, or `unit` if it is "
                               "given. Times are in the first column.",
                .only_with = "file"}},
      .alternatives = {{{"ramp", "sine", "steps", "file"}, true}}};
  if (!plain) {
    signal.keys.push_back(path_unit_key(measure, measure.unit));
    signal.stand_in = signal_table(plain_number(), "1");
  }
  return make_table(std::move(signal));
}

Key tasks_key(bool required) {
  return {.name = "effectors",
          .forms = {names(task_form(), 1, "effectors")},
          .example = "{tip: {target: 0 0 190 mm}}",
          .description = "Target of each effector, by name.",
          .required = required};
}

Key driven_key() {
  return {.name = "actuators",
          .forms = {list({reference("actuators")})},
          .example = "[long_0, long_1]",
          .description = "The actuators it drives. Default: all."};
}

}  // namespace sinew::scene::forms
