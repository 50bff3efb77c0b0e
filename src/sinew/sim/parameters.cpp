#include "sinew/sim/parameters.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

namespace {

// Calls visit(parameter, set(simulation, value)) for every input that is one number at present.
template <class Visit>
void each_input(const Simulation& simulation, Visit visit) {
  const model::Model& model = simulation.model();
  const double time = simulation.time();
  for (int a = 0; std::cmp_less(a, model.actuators().size()); ++a) {
    const model::ActuatorModel& actuator = model.actuators()[static_cast<std::size_t>(a)];
    const model::Command& told = simulation.actuator(a).command;
    const law::QuantityName quantity = actuator.quantity(told.kind);
    const bool takes = actuator.kind_of(quantity.name) == told.kind;  // a spring takes none
    if (!told.signal.is_constant() || !takes) continue;
    visit(Parameter{fmt::format("actuators.{}.command.{}", actuator.name, quantity.name),
                    quantity.unit, told.signal.value(time)},
          [a, kind = told.kind](Simulation& of, double value) {
            of.command(a, {kind, model::Signal::constant(value)});
          });
  }
  for (int l = 0; std::cmp_less(l, model.loads().size()); ++l) {
    const model::Signal& factor = simulation.load_factor(l);
    if (!factor.is_constant()) continue;
    const model::LoadModel& load = model.loads()[static_cast<std::size_t>(l)];
    visit(Parameter{fmt::format("loads.{}.{}", load.name, load.factor_name.name),
                    load.factor_name.unit, factor.value(time)},
          [l](Simulation& of, double value) { of.set_load(l, model::Signal::constant(value)); });
  }
  for (int b = 0; b < simulation.bodies(); ++b) {
    const auto* body = mechanics::as<const mechanics::ScalesStiffness>(simulation.body(b));
    if (body == nullptr) continue;
    visit(Parameter{fmt::format("bodies.{}.stiffness_factor", model.body(b).name()), "",
                    body->stiffness_factor()},
          [b](Simulation& of, double value) { of.set_stiffness_factor(b, value); });
  }
}

}  // namespace

std::vector<Parameter> parameters(const Simulation& simulation) {
  std::vector<Parameter> all = simulation.model().parameters();
  each_input(simulation, [&](Parameter input, const auto&) { all.push_back(std::move(input)); });
  return all;
}

void set_parameter(Simulation& simulation, std::string_view path, double value) {
  std::function<void(Simulation&, double)> set;
  std::vector<std::string> paths;
  each_input(simulation, [&](const Parameter& input, const auto& own) {
    if (input.path == path) set = own;
    paths.push_back(input.path);
  });
  if (set) return set(simulation, value);
  const std::string item(path);
  const std::vector<Parameter> fixed = simulation.model().parameters();
  if (std::ranges::find(fixed, path, &Parameter::path) != fixed.end()) {
    throw Error(ErrorKind::bad_argument, {.item = item},
                "this parameter belongs to the model, which does not change during a run",
                "change what the scene states, and load it again");
  }
  for (const Parameter& parameter : fixed) paths.push_back(parameter.path);
  const std::string near = nearest_word(item, paths);
  throw Error(ErrorKind::unknown_name, {.item = item}, "there is no such parameter",
              near.empty() ? "see the list of parameters" : "did you mean '" + near + "'?");
}

}  // namespace sinew::sim
