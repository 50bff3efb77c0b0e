#include "sinew/scene/grammar.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/linalg/factorisation.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace {

using namespace forms;

Key later_key(const char* name, const char* description) {
  return {.name = name, .forms = {text()}, .description = description, .later = true};
}

Form method_choice(const char* short_for = "") {
  return choice(
      {{"newton", "Iterates until the step's equation holds to `tolerance`."},
       {"one-linearisation",
        "One linear solve per step, in predictable time. The report bounds the error, and "
        "the status flags unbalanced forces and energy gain, but the step is not "
        "repeated."}},
      short_for);
}

Form integrator_choice(const char* short_for = "") {
  return choice({{"quasi-static", "Equilibrium in every step; no inertia."},
                 {"backward-euler", "Dynamics; first order, damps motion."},
                 {"bdf2", "Dynamics; second order, damps fast modes."},
                 {"generalized-alpha", "Dynamics; second order, adjustable damping."},
                 {"event-driven",
                  "Dynamics; second order, undamped. Finds the instants of impacts between rigid "
                  "bodies and applies restitution."}},
                short_for);
}

std::shared_ptr<const KeyTable> integrator_table() {
  return make_table(
      {.name = "integrator",
       .description = "The integrator with its settings.",
       .keys = {
           {.name = "type",
            .forms = {integrator_choice()},
            .example = "backward-euler",
            .description = "The integrator.",
            .required = true},
           {.name = "spectral_radius",
            .forms = {quantity(plain_number(), {.min = 0.0, .max = 1.0})},
            .example = "0.8",
            .default_text = "0.8",
            .description =
                "Generalized-alpha: spectral radius at infinite frequency, by which a step "
                "multiplies the fastest motions: 0 damps most, 1 does not damp. Robots with a "
                "held motion (a joint, a motor, a cable of commanded length, a weld) need "
                "0.95 or less."},
           {.name = "restitution",
            .forms = {quantity(plain_number(), {.min = 0.0, .max = 1.0})},
            .example = "0.6",
            .default_text = "0",
            .description = "Event-driven: coefficient of restitution of impacts between rigid "
                           "bodies. 0: no rebound, 1: elastic. Contacts may have their own."}}});
}

std::shared_ptr<const KeyTable> adaptive_table() {
  return make_table(
      {.name = "adaptive",
       .description = "Substeps within each time step: smaller where the integration error "
                      "requires it or a step fails.",
       .keys = {
           {.name = "tolerance",
            .forms = {quantity(plain_number(), positive())},
            .example = "1e-4",
            .default_text = "1e-4",
            .description =
                "Largest error of a substep in any coordinate, relative to the robot's size."},
           {.name = "smallest",
            .forms = {quantity(time(), positive())},
            .example = "0.1 ms",
            .description = "Smallest substep. The run stops if a step would need a smaller one.",
            .required = true}}});
}

std::vector<Choice> factorisations() {
  std::vector<Choice> choices;
  for (const linalg::BackendName& one : linalg::backends()) {
    choices.push_back({.word = one.name, .description = one.description});
  }
  return choices;
}

std::shared_ptr<const KeyTable> solver_table() {
  return make_table(
      {.name = "solver",
       .description = "How each step is solved.",
       .keys = {
           {.name = "method",
            .forms = {method_choice()},
            .example = "newton",
            .default_text = "newton",
            .description = "Solution method of a step."},
           {.name = "adaptive",
            .forms = {table(adaptive_table())},
            .example = "{tolerance: 1e-4, smallest: 0.1 ms}",
            .description =
                "Substeps with error control. Default: each step is one step of `time_step`."},
           {.name = "tangent",
            .forms = {choice(
                {{"exact",
                  "The derivative of the forces; projected where it is "
                  "indefinite for the constrained robot."},
                 {"projected",
                  "The derivative with each element's part made positive semidefinite: slower to "
                  "converge."},
                 {"corotated",
                  "Corotational elements: R K0 R^T with the rotations R held fixed, without stress "
                  "stiffening. A robot with a hyperelastic body uses `exact` instead."}})},
            .example = "exact",
            .default_text = "exact",
            .description = "The matrix of a step's linear equations. It affects how fast a "
                           "step converges, not the solution."},
           {.name = "equilibrium",
            .forms = {choice({{"converged",
                               "Every quasi-static step iterates to equilibrium: to a residual of "
                               "`tolerance`, or "
                               "to rounding."},
                              {"following",
                               "A quasi-static step may end once its error is of second order in "
                               "its motion; the "
                               "next step removes it. The report bounds the distance to "
                               "equilibrium. For control "
                               "in real time."}})},
            .example = "following",
            .description = "When the iterations of a quasi-static step end. Default: `converged`; "
                           "`following` under a controller, in the view and in sinew.gym. Dynamic "
                           "steps and materials with viscosity or softening always converge."},
           {.name = "tolerance",
            .forms = {quantity(plain_number(), Range{0.0, 1.0, true, true})},
            .example = "1e-8",
            .description =
                "Newton: largest residual force, relative to the sum of internal and "
                "external forces. Default: 1e-6 in quasi-static steps (1e-4 for "
                "`equilibrium: following`, which may also end earlier); 1e-8 in dynamics "
                "and for materials with viscosity or softening, or 1e-6 where iterations "
                "no longer reduce the residual. A tolerance that you set holds in every "
                "step."},
           {.name = "max_iterations",
            .forms = {integer(1, 100000)},
            .example = "50",
            .default_text = "50",
            .description = "Newton: maximum number of iterations per step."},
           {.name = "contact_tolerance",
            .forms = {quantity(plain_number(), Range{0.0, 1.0, true, true})},
            .example = "1e-8",
            .default_text = "1e-10",
            .description = "Contacts: largest residual of the contact laws at any point, "
                           "relative to the largest force."},
           {.name = "threads",
            .forms = {integer(1, 256)},
            .example = "4",
            .default_text = "1",
            .description = "Threads per step; results do not depend on it."},
           {.name = "factorisation",
            .forms = {choice(factorisations())},
            .example = "block",
            .default_text = "block",
            .description = "Factorisation of the matrix."},
           {.name = "ordering",
            .forms = {choice(
                {{"fastest",
                  "The faster of `amd` and `metis`, by an estimate that reads no clock."},
                 {"amd", "Approximate minimum degree."},
                 {"metis", "Nested dissection."}})},
            .example = "metis",
            .default_text = "fastest",
            .description = "Elimination order of the unknowns."}}});
}

std::shared_ptr<const KeyTable> record_table() {
  return make_table({.name = "record",
                     .description = "Output of a run.",
                     .keys = {{.name = "every",
                               .forms = {integer(1, 1'000'000'000)},
                               .example = "10",
                               .default_text = "1",
                               .description = "Number of steps between records."},
                              {.name = "states",
                               .forms = {boolean()},
                               .example = "false",
                               .default_text = "true",
                               .description = "Also records the positions of all nodes."}}});
}

std::vector<Key> world_keys() {
  return {
      {.name = "sinew",
       .forms = {integer(1, 1)},
       .example = "1",
       .description = "Version of the scene format: 1.",
       .required = true},
      {.name = "gravity",
       .forms = {vector(acceleration())},
       .example = "0 0 -9.81 m/s^2",
       .default_text = "0 0 0 m/s^2",
       .description = "Gravitational acceleration."},
      {.name = "time_step",
       .forms = {quantity(time(), positive())},
       .example = "10 ms",
       .default_text = "10 ms",
       .description = "Time step."},
      {.name = "duration",
       .forms = {quantity(time(), positive())},
       .example = "5 s",
       .description = "Duration of a run. Default: the duration of the longest signal or target."},
      {.name = "integrator",
       .forms = {integrator_choice("type"), table(integrator_table())},
       .example = "quasi-static",
       .default_text = "quasi-static",
       .description = "Time integration."},
      {.name = "solver",
       .forms = {table(solver_table()), method_choice("method")},
       .example = "{method: newton}",
       .default_text = "{}",
       .description = "How each step is solved; a single word is its `method`."}};
}

KeyTable scene_table() {
  KeyTable scene{.name = "scene", .description = "A scene file is one YAML map with these keys."};
  scene.keys = world_keys();
  scene.keys.push_back({.name = "bodies",
                        .forms = {names(body_form(), 1)},
                        .example = "{trunk: {type: fem, ...}}",
                        .description = "The bodies; you choose the names.",
                        .required = true});
  scene.keys.push_back({.name = "actuators",
                        .forms = {names(actuator_form())},
                        .example = "{long_0: {type: cable, ...}}",
                        .description = "Actuators."});
  scene.keys.push_back({.name = "loads",
                        .forms = {names(load_form())},
                        .example = "{sea: {type: water, body: arm}}",
                        .description = "External loads."});
  scene.keys.push_back({.name = "masses",
                        .forms = {names(mass_form())},
                        .example = "{camera: {body: trunk, point: 0 0 195 mm, mass: 52 g}}",
                        .description = "Point masses on finite-element bodies."});
  scene.keys.push_back({.name = "membranes",
                        .forms = {names(membrane_form())},
                        .example =
                            "{paper: {body: finger, surface: {set: bottom}, thickness: 0.1 mm, "
                            "young_modulus: 2 GPa}}",
                        .description = "Thin layers on faces of finite-element bodies."});
  scene.keys.push_back({.name = "effectors",
                        .forms = {names(effector_form())},
                        .example = "{tip: {body: trunk, point: 0 0 195 mm}}",
                        .description = "Points whose motion is observed and controlled."});
  scene.keys.push_back(
      {.name = "probes",
       .forms = {names(probe_form())},
       .example = "{bend: {body: finger, bend: [{set: bottom}, {set: top}]}}",
       .description = "Measurements that are recorded; they do not affect the robot."});
  scene.keys.push_back(
      {.name = "sensors",
       .forms = {names(sensor_form())},
       .example = "{tip: {type: marker, body: trunk, point: 0 0 195 mm, noise: 0.1 mm}}",
       .description =
           "Simulated sensors with the errors of real ones. They do not affect the robot."});
  scene.keys.push_back(
      {.name = "estimators",
       .forms = {names(estimator_form())},
       .example = "{push: {type: filter, sensors: [tip, length], unknowns: {hand: ...}}}",
       .description = "Estimators of unknown forces, pressures, tensions and stiffnesses from "
                      "sensors. They do "
                      "not affect the robot."});
  scene.keys.push_back(
      {.name = "contacts",
       .forms = {names(contact_form())},
       .example = "{floor: {body: block, surface: {plane: {}}, friction: 0.5}}",
       .description = "Contacts between bodies, and with surfaces of the world, with friction."});
  scene.keys.push_back({.name = "joints",
                        .forms = {names(joint_form())},
                        .example = "{seam: {type: weld, bodies: [upper, lower]}}",
                        .description = "Joints between bodies."});
  scene.keys.push_back(
      {.name = "controllers",
       .forms = {names(controller_form())},
       .example = "{follow: {type: inverse, effectors: {tip: ...}}}",
       .description = "Controllers of effectors. A controller owns the actuators it drives."});
  scene.keys.push_back({.name = "record",
                        .forms = {table(record_table())},
                        .example = "{every: 1, states: true}",
                        .default_text = "{}",
                        .description = "Output of a run."});
  scene.keys.push_back(later_key("materials", "Materials by name."));
  scene.keys.push_back(later_key("obstacles", "Obstacles around the robot."));
  return scene;
}

std::string describe_numbers(const Form& form) {
  if (form.max_count == 1) {
    if (form.unit.empty()) return "a number";
    if (form.unit == "rad") return "an angle (rad)";
    return fmt::format("{} ({})", dimension_name(form.dimension), form.unit);
  }
  if (form.min_count != form.max_count) {
    return fmt::format("{} to {} numbers", form.min_count, form.max_count);
  }
  return fmt::format("{} numbers{}{}", form.max_count, form.unit.empty() ? "" : ", in ", form.unit);
}

std::string describe_words(const Form& form) {
  std::string words;
  for (const Choice& word : form.choices) {
    if (word.later) continue;
    if (!words.empty()) words += " | ";
    words += word.word;
  }
  return words;
}

}  // namespace

const Key* KeyTable::find(std::string_view key) const {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == key; });
  return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> KeyTable::key_names() const {
  std::vector<std::string> result;
  for (const Key& key : keys) {
    if (!key.later) result.push_back(key.name);
  }
  return result;
}

const Alternatives* KeyTable::alternatives_of(std::string_view key) const {
  for (const Alternatives& group : alternatives) {
    if (std::find(group.keys.begin(), group.keys.end(), key) != group.keys.end()) return &group;
  }
  return nullptr;
}

const KeyTable& grammar() {
  static const KeyTable table = scene_table();
  return table;
}

const Form& form_of(const KeyTable& table, std::string_view key, Shape shape) {
  if (const Key* found = table.find(key)) {
    for (const Form& form : found->forms) {
      if (form.shape == shape) return form;
    }
  }
  throw Error(ErrorKind::internal, {},
              fmt::format("the grammar's {} has no such {}", table.name, key), "report this");
}

std::string describe(const Form& form) {
  switch (form.shape) {
    case Shape::quantity:
      return describe_numbers(form);
    case Shape::unit:
      return fmt::format("a unit such as {}", form.unit);
    case Shape::integer:
      return "a whole number";
    case Shape::boolean:
      return "true | false";
    case Shape::text:
      return "text";
    case Shape::choice:
      return describe_words(form);
    case Shape::file:
      return "a path";
    case Shape::reference:
      return fmt::format("a name from `{}`{}", form.refers_to,
                         form.choices.empty() ? "" : " | " + describe_words(form));
    case Shape::list:
      return fmt::format("a list of ({})", describe(form.items));
    case Shape::samples:
      return fmt::format("a list of [time in s, value{}{}]", form.unit.empty() ? "" : " in ",
                         form.unit);
    case Shape::table:
      return fmt::format("a map ({})", form.table->name);
    case Shape::variants:
      return fmt::format("a map with {}: {}", form.telltale, describe_words(form));
    case Shape::names:
      return fmt::format("a map of names to ({})", describe(form.items));
  }
  return {};
}

std::string describe(const std::vector<Form>& forms) {
  std::string result;
  for (const Form& form : forms) {
    if (form.later) continue;
    if (!result.empty()) result += ", or ";
    result += describe(form);
  }
  return result;
}

}  // namespace sinew::scene
