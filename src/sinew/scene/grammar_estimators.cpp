// The tables of estimators: from which sensors, and what is unknown.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

std::shared_ptr<const KeyTable> unknown_force_table() {
  return make_table({.name = "unknown force",
                     .description = "A force of unknown size and direction on a point.",
                     .keys = {body_key(),
                              {.name = "point",
                               .forms = {vector(length())},
                               .example = "0 10 150 mm",
                               .description = "Where it acts, in the mesh at rest.",
                               .required = true},
                              outside_key()}});
}

Form unknown_form() {
  return table(make_table(
      {.name = "unknown",
       .description = "An external force, estimated along x, y and z of the world.",
       .keys = {{.name = "force",
                 .forms = {table(unknown_force_table())},
                 .example = "{body: trunk, point: 0 10 150 mm}",
                 .description = "Where it acts.",
                 .required = true},
                {.name = "prior",
                 .forms = {quantity(force(), positive())},
                 .example = "1 N",
                 .description = "Standard deviation of each component before anything is measured; "
                                "the mean is zero.",
                 .required = true},
                {.name = "walk",
                 .forms = {quantity(force(), positive())},
                 .example = "0.5 N",
                 .description =
                     "Random walk of each component: the standard deviation of its change "
                     "in 1 s, which grows with the square root of time. Default: `prior`."}}}));
}

}  // namespace

Form estimator_form() {
  const auto filter = make_table(
      {.name = "estimator: type filter",
       .description =
           "Kalman filter of external forces. It knows the robot, the commands, the loads and the "
           "samples of its sensors. Its own robot is quasi-static.",
       .keys = {
           {.name = "sensors",
            .forms = {list({reference("sensors")})},
            .example = "[tip, length]",
            .description = "Sensors of type marker, orientation, cable-length, cable-tension, "
                           "pressure, volume or motor-current. Each needs `noise` or a "
                           "`quantum`, by which it is weighted.",
            .required = true},
           {.name = "unknowns",
            .forms = {names(unknown_form(), 1)},
            .example = "{hand: {force: {body: trunk, point: 0 10 150 mm}, prior: 1 N}}",
            .description = "Unknown forces by name. A load of the same name is unknown to the "
                           "estimator.",
            .required = true},
           {.name = "unknown_loads",
            .forms = {list({reference("loads")})},
            .example = "[push]",
            .description = "More loads of the scene that the estimator does not know. Default: "
                           "it knows all loads except those named in `unknowns`."}}});
  return variants("type", {{.word = "filter", .description = "A Kalman filter.", .table = filter}});
}

}  // namespace sinew::scene::forms
