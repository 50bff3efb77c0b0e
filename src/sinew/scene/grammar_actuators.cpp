// Limits and commands of actuators, keys that several kinds share, and effectors.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

KeyTable limit_keys(const Measure& measure, const Measure& rate, Range range,
                    const char* min_default, const char* example, const char* rate_example) {
  return {.name = "limits of one quantity",
          .description =
              "A key that is left out means no limit. Cables cannot push: their smallest tension "
              "is 0 N.",
          .keys = {{.name = "min",
                    .forms = {quantity(measure, range)},
                    .example = *measure.unit == '\0' ? "0" : std::string("0 ") + measure.unit,
                    .default_text = min_default,
                    .description = "Smallest value."},
                   {.name = "max",
                    .forms = {quantity(measure, range)},
                    .example = example,
                    .description = "Largest value."},
                   {.name = "rate",
                    .forms = {quantity(rate, positive())},
                    .example = rate_example,
                    .description = "Largest rate of change."}}};
}

std::shared_ptr<const KeyTable> limit_table(const Measure& measure, const Measure& rate,
                                            const char* name, Range range, const char* min_default,
                                            const char* example, const char* rate_example) {
  static const auto any_quantity =
      make_table(limit_keys(plain_number(), plain_number(), any(), "", "20", "100"));
  KeyTable limits = limit_keys(measure, rate, range, min_default, example, rate_example);
  limits.name = std::string("limits of ") + name;
  limits.stand_in = any_quantity;
  return make_table(std::move(limits));
}

}  // namespace

std::vector<Key> drive_keys(const DriveWords& w) {
  const model::ActuatorKind& words = *w.kind;
  const std::string effort = words.effort.name, motion = words.motion.name, kind = words.word;
  const auto effort_limits =
      limit_table(w.effort_measure, w.effort_rate, words.effort.name, w.effort_range, w.min_default,
                  w.effort_example, w.effort_rate_example);
  const auto motion_limits = limit_table(w.motion_measure, w.motion_rate, words.motion.name, any(),
                                         "", w.motion_example, w.motion_rate_example);
  const auto limits =
      make_table({.name = "limits of a " + kind,
                  .description = "Limits of the actuator; commands and controllers respect them.",
                  .keys = {{.name = effort,
                            .forms = {table(effort_limits)},
                            .example = std::string("{max: ") + w.effort_example + "}",
                            .default_text = "{}",
                            .description = "Limits of the " + effort + "."},
                           {.name = motion,
                            .forms = {table(motion_limits)},
                            .example = std::string("{max: ") + w.motion_example + "}",
                            .default_text = "{}",
                            .description = "Limits of the " + motion + "."}}});
  KeyTable command{.name = "command of a " + kind,
                   .description = "Command of the actuator: a constant, or a signal over time.",
                   .keys = {{.name = motion,
                             .forms = {quantity(w.motion_measure),
                                       table(signal_table(w.motion_measure, w.motion_value))},
                             .example = w.motion_value,
                             .description = w.motion_text},
                            {.name = effort,
                             .forms = {quantity(w.effort_measure, w.effort_range),
                                       table(signal_table(w.effort_measure, w.effort_value))},
                             .example = w.effort_value,
                             .description = "The " + effort + "."}},
                   .alternatives = {{{motion, effort}, true}}};
  for (const Key& key : w.inputs) {
    command.keys.push_back(key);
    command.alternatives.front().keys.push_back(key.name);
  }
  return {{.name = "limits",
           .forms = {table(limits)},
           .example = "{" + motion + ": {max: " + w.motion_example + "}}",
           .default_text = "{}",
           .description = "Limits of the actuator."},
          {.name = "command",
           .forms = {table(make_table(std::move(command)))},
           .example = "{" + motion + ": " + w.motion_value + "}",
           .description = w.undriven}};
}

DriveWords line_words(const model::ActuatorKind& kind, Range range, const char* min_default,
                      const char* motion_text, const char* undriven) {
  DriveWords words{.kind = &kind};
  words.effort_measure = force();
  words.effort_rate = force_rate();
  words.effort_range = range;
  words.min_default = min_default;
  words.effort_example = "20 N";
  words.effort_rate_example = "100 N/s";
  words.effort_value = "2 N";
  words.motion_measure = length();
  words.motion_rate = speed();
  words.motion_example = "70 mm";
  words.motion_rate_example = "100 mm/s";
  words.motion_value = "10 mm";
  words.motion_text = motion_text;
  words.undriven = undriven;
  return words;
}

Key input_key(const char* name, const Measure& measure, const char* example,
              const char* description, Range range) {
  return {.name = name,
          .forms = {quantity(measure, range), table(signal_table(measure, example))},
          .example = example,
          .description = description};
}

Key body_key() {
  return {.name = "body",
          .forms = {reference("bodies")},
          .example = "trunk",
          .description = "The body it belongs to.",
          .required = true};
}

Key outside_key() {
  return {.name = "outside",
          .forms = {choice({{"error",
                             "A point outside the mesh is an error. A point counts as on the "
                             "surface if its distance from it is below 1e-5 of the mesh's size."},
                            {"nearest", "The point is attached to the nearest element."}})},
          .example = "nearest",
          .default_text = "error",
          .description = "Treatment of points outside the mesh."};
}

std::shared_ptr<const KeyTable> point_file_table() {
  return make_table({.name = "points: file",
                     .description = "A CSV table with three columns, x y z, one point per line.",
                     .keys = {{.name = "file",
                               .forms = {file()},
                               .example = "long_0.csv",
                               .description = "Path of the table, relative to the scene file.",
                               .required = true},
                              {.name = "unit",
                               .forms = {unit(length())},
                               .example = "mm",
                               .default_text = "m",
                               .description = "Unit of the numbers."}}});
}

std::vector<Form> axis_forms() {
  return {choice({{"x", "The world's x axis."},
                  {"y", "The world's y axis."},
                  {"z", "The world's z axis."}}),
          vector(plain_number())};
}

Form effector_form() {
  const Form axis = axis_forms().front();
  KeyTable effector{
      .name = "effector",
      .description =
          "A point or frame on a body whose motion is observed and controlled: exactly "
          "one of point, points, set and orientation.",
      .keys = spot_keys(),
      .alternatives = {{{"point", "points", "set", "orientation"}, true}}};
  effector.keys.insert(effector.keys.begin(), body_key());
  effector.keys.push_back(
      {.name = "orientation",
       .forms = {list({vector(length())}, 3, 3), vector(length())},
       .example = "[0 0 190 mm, 10 0 190 mm, 0 10 190 mm]",
       .description = "Rotation vector from rest, of the frame through three points of a "
                      "deformable body, or of a rigid body or an arm's section at one point."});
  effector.keys.push_back(
      {.name = "directions",
       .forms = {axis, list(axis_forms(), 1, 3)},
       .example = "[x, y]",
       .default_text = "[x, y, z]",
       .description = "Controlled directions: axes or linearly independent vectors."});
  effector.keys.push_back(outside_key());
  return table(make_table(std::move(effector)));
}

}  // namespace sinew::scene::forms
