#include "sinew/control/controller_observables.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/control/target_controller.hpp"
#include "sinew/core/axis_names.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::control {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kNone = -2, kStart = -1;  // the status without a controller, and before any step

bool is_orientation(const model::Model& model, int effector) {
  return model.effector(effector).kind() == constraint::EffectorKind::orientation;
}

run::Observable of_effector(const std::string& name, const char* quantity, const char* unit) {
  return {fmt::format("{}.{}", name, quantity),
          unit,
          {},
          run::ObservableKind::controller,
          name,
          quantity,
          {},
          {}};
}

void add_effector(sim::Observables& list, const AttachedController& controller, int effector) {
  const sim::Simulation& simulation = list.simulation();
  const model::Model& model = simulation.model();
  const std::string& name = model.effectors()[static_cast<std::size_t>(effector)].name;
  const char* unit = model.effector(effector).unit();
  const char* turn = is_orientation(model, effector) ? "r" : "";
  run::Observable target = of_effector(name, "target", unit),
                  error = of_effector(name, "error", unit);
  target.shape = {3};
  for (const char* axis : kAxisNames) {
    target.components.push_back(fmt::format("{}.target_{}{}", name, turn, axis));
  }
  error.components = {error.name};
  list.add({std::move(target), std::move(error)},
           [&simulation, controller, effector](std::span<double> to) {
             const TargetController* present = controller();
             const int task = task_of(present, effector);
             std::ranges::fill(to, kNothing);
             if (task < 0) return;
             const Target& asked = present->settings().tasks[static_cast<std::size_t>(task)].target;
             const Vector3 place = asked.at(simulation.time());
             std::copy_n(place.data(), 3, to.begin());
             to[3] = present->error(task);
           });
}

void add_largest_error(sim::Observables& list, const AttachedController& controller,
                       std::span<const int> effectors) {
  const model::Model& model = list.simulation().model();
  const bool turns =
      std::ranges::all_of(effectors, [&](int effector) { return is_orientation(model, effector); });
  list.add({{"error",
             turns ? "rad" : "m",
             {},
             run::ObservableKind::controller,
             {},
             "error",
             {"error"},
             {}}},
           [controller](std::span<double> to) {
             const TargetController* present = controller();
             to[0] = present == nullptr ? kNothing : present->error();
           });
}

// Another controller of this name, such as one made after a reset, has the same observables.
bool observes(const TargetController& controller, const std::vector<run::Observable>& own) {
  return std::ranges::equal(controller.observables(), own, {}, &run::Observable::name,
                            &run::Observable::name);
}

void add_own(sim::Observables& list, const AttachedController& controller) {
  const TargetController* now = controller();
  if (now == nullptr || now->observables().empty()) return;
  const std::vector<run::Observable> own = now->observables();
  list.add(own, [controller, own](std::span<double> to) {
    const TargetController* present = controller();
    if (present != nullptr && observes(*present, own)) return present->read(to);
    std::ranges::fill(to, kNothing);
  });
}

void add_status(sim::Observables& list, AttachedController controller) {
  run::Observable status{"controller",
                         "",
                         {},
                         run::ObservableKind::status,
                         {},
                         "controller",
                         {"controller"},
                         {{kNone, "none"}, {kStart, "start"}}};
  for (int code = 0; code < kControllerStatuses; ++code) {
    status.words.push_back({code, controller_status_name(static_cast<ControllerStatus>(code))});
  }
  const sim::Simulation& simulation = list.simulation();
  list.add({std::move(status)},
           [&simulation, controller = std::move(controller)](std::span<double> to) {
             const TargetController* present = controller();
             to[0] = present == nullptr       ? kNone
                     : simulation.steps() > 0 ? static_cast<int>(present->status())
                                              : kStart;
           });
}

}  // namespace

int task_of(const TargetController* controller, int effector) {
  if (controller == nullptr) return -1;
  const auto& tasks = controller->settings().tasks;
  const auto found = std::ranges::find(tasks, effector, &EffectorTask::effector);
  return found == tasks.end() ? -1 : static_cast<int>(found - tasks.begin());
}

std::vector<int> steered_effectors(const TargetController* controller) {
  std::vector<int> effectors;
  if (controller == nullptr) return effectors;
  for (const EffectorTask& task : controller->settings().tasks) {
    if (std::ranges::find(effectors, task.effector) == effectors.end()) {
      effectors.push_back(task.effector);
    }
  }
  return effectors;
}

void add_controller(sim::Observables& list, AttachedController controller,
                    std::span<const int> effectors) {
  for (const int effector : effectors) add_effector(list, controller, effector);
  if (!effectors.empty()) add_largest_error(list, controller, effectors);
  add_own(list, controller);
  add_status(list, std::move(controller));
}

void add_controller(sim::Observables& list, const TargetController* controller) {
  add_controller(
      list, [controller] { return controller; }, steered_effectors(controller));
}

}  // namespace sinew::control
