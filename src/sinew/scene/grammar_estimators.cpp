// The tables of estimators.
#include <string>
#include <utility>

#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

std::shared_ptr<const KeyTable> force_place_table() {
  return make_table({.name = "point of an unknown force",
                     .description = "A force of unknown size and direction on a point.",
                     .keys = {body_key(),
                              {.name = "point",
                               .forms = {vector(length())},
                               .example = "0 10 150 mm",
                               .description = "Where it acts, in the mesh at rest.",
                               .required = true},
                              outside_key()}});
}

std::shared_ptr<const KeyTable> effort_place_table() {
  static const auto table = make_table(
      {.name = "actuator of an unknown effort",
       .description = "The pressure of a chamber or the tension of a cable.",
       .keys = {
           {.name = "actuator",
            .forms = {reference("actuators")},
            .example = "chamber_0",
            .description = "Of type chamber for a pressure, cable for a tension.",
            .required = true},
           {.name = "command",
            .forms = {choice(
                {{"known",
                  "The estimator knows the command. Where a pressure or tension is commanded, the "
                  "unknown is the difference between the actual and the commanded value. Where "
                  "something else is commanded (a volume, a length, an amount of gas) or the "
                  "pressure passes a valve, the estimator ignores the command, and the unknown is "
                  "the whole pressure or tension."},
                 {"unknown",
                  "The estimator does not know the command. The unknown is the whole pressure or "
                  "tension."}})},
            .example = "unknown",
            .default_text = "known",
            .description = "Whether the estimator knows the command of the actuator."}}});
  return table;
}

Form stiffness_form() {
  Key of = body_key();
  of.description = "The body, of type fem.";
  const auto body = make_table({.name = "body of an unknown stiffness",
                                .description = "A body of type fem whose stiffness is unknown.",
                                .keys = {std::move(of)}});
  return table(
      make_table(
          {.name = "unknown: stiffness",
           .description =
               "A factor of all moduli of a body of type fem: of its material and its parts, and "
               "with them of its stiffness damping, but not of membranes. The estimator starts "
               "from the moduli in the scene; the logarithm of the factor has a normal "
               "distribution about 0. Only known forces tell a stiffness: weight, loads, commanded "
               "or measured pressures and tensions, or inertia.",
           .keys = {{.name = "stiffness",
                     .forms = {table(body)},
                     .example = "{body: trunk}",
                     .description = "The body.",
                     .required = true},
                    {.name = "prior",
                     .forms = {quantity(plain_number(),
                                        {.min = 0.0, .max = 2.0, .above_min = true})},
                     .example = "30 %",
                     .description = "Standard deviation of the logarithm of the factor before "
                                    "anything is measured, about the relative standard deviation "
                                    "of the factor.",
                     .required = true},
                    {.name = "walk",
                     .forms = {quantity(plain_number(), non_negative())},
                     .example = "1 %",
                     .default_text = "0",
                     .description = "Random walk of the logarithm: the standard deviation of its "
                                    "change in 1 s, which grows with the square root of time."}}}),
      "stiffness");
}

// What an unknown of one kind is called and measured in.
struct UnknownWords {
  const char* key = "";
  const char* name = "";
  const char* description = "";
  const char* place_example = "";
  std::shared_ptr<const KeyTable> place;
  const char* place_description = "";
  Measure measure;
  const char* prior_example = "";
  const char* walk_example = "";
  const char* of_each = "";
};

Form unknown_form(const UnknownWords& words) {
  const std::string each = words.of_each;
  return table(
      make_table({.name = words.name,
                  .description = words.description,
                  .keys = {{.name = words.key,
                            .forms = {table(words.place)},
                            .example = words.place_example,
                            .description = words.place_description,
                            .required = true},
                           {.name = "prior",
                            .forms = {quantity(words.measure, positive())},
                            .example = words.prior_example,
                            .description = "Standard deviation" + each +
                                           " before anything is measured; the mean is zero.",
                            .required = true},
                           {.name = "walk",
                            .forms = {quantity(words.measure, positive())},
                            .example = words.walk_example,
                            .description = "Random walk" + each +
                                           ": the standard deviation of its change in 1 s, which "
                                           "grows with the square root of time. Default: "
                                           "`prior`."}}}),
      words.key);
}

Form unknowns_form() {
  Form form = names(unknown_form({"force", "unknown: force",
                                  "An external force, estimated along x, y and z of the world.",
                                  "{body: trunk, point: 0 10 150 mm}", force_place_table(),
                                  "Where it acts.", force(), "1 N", "0.5 N", " of each component"}),
                    1);
  form.items.push_back(
      unknown_form({"pressure", "unknown: pressure",
                    "A pressure in a chamber, or its deviation from the commanded pressure.",
                    "{actuator: chamber_0}", effort_place_table(), "The chamber.", stress(),
                    "5 kPa", "2 kPa", ""}));
  form.items.push_back(unknown_form(
      {"tension", "unknown: tension",
       "The tension of a cable, or its deviation from the commanded tension.", "{actuator: long_0}",
       effort_place_table(), "The cable.", force(), "1 N", "0.5 N", ""}));
  form.items.push_back(stiffness_form());
  return form;
}

}  // namespace

Form estimator_form() {
  const auto filter = make_table(
      {.name = "estimator: type filter",
       .description =
           "Kalman filter of external forces, pressures, tensions and stiffnesses. It knows the "
           "robot, the commands, the loads and the samples of its sensors. Its own robot has the "
           "integrator of the scene.",
       .keys = {
           {.name = "sensors",
            .forms = {list({reference("sensors")})},
            .example = "[tip, length]",
            .description = "Sensors. If the estimator's robot has inertia, of any type but touch; "
                           "else of type marker, orientation, cable-length, cable-tension, "
                           "pressure, volume or motor-current. Each needs `noise` or a "
                           "`quantum`, by which it is weighted.",
            .required = true},
           {.name = "unknowns",
            .forms = {unknowns_form()},
            .example = "{hand: {force: {body: trunk, point: 0 10 150 mm}, prior: 1 N}}",
            .description = "Unknown forces, pressures, tensions and stiffnesses by name. A load of "
                           "the same name is unknown to the estimator.",
            .required = true},
           {.name = "unknown_loads",
            .forms = {list({reference("loads")})},
            .example = "[push]",
            .description = "More loads of the scene that the estimator does not know. Default: "
                           "it knows all loads except those named in `unknowns`."},
           {.name = "inertia",
            .forms = {boolean()},
            .example = "false",
            .default_text = "true",
            .description = "In a dynamic scene: whether the estimator's own robot has inertia. If "
                           "false, it is quasi-static, and inertia counts as a force. A step of "
                           "the estimator then makes one step of the robot instead of about 16; if "
                           "stiffnesses are unknown, one more for each of them, repeated up to ten "
                           "times. No effect in a quasi-static scene."},
           {.name = "rank",
            .forms = {integer(1, 1000)},
            .example = "20",
            .default_text = "12",
            .description = "Columns of the covariance of unknowns and state of a robot with "
                           "inertia, at least as many as there are unknown components. Each step "
                           "of the estimator makes this many steps of the robot, one more, and "
                           "one for each component whose `walk` is not 0."}}});
  return variants("type", {{.word = "filter", .description = "A Kalman filter.", .table = filter}});
}

}  // namespace sinew::scene::forms
