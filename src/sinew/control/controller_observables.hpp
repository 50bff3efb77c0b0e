/// @file
/// Observables of a controller: the targets of effectors and their errors.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace sinew::sim {
class Observables;
}

namespace sinew::control {

class TargetController;

/// Returns the controller that is attached at present; null if there is none.
using AttachedController = std::function<const TargetController*()>;

/// Index of an effector's task in settings().tasks; -1 if it has none.
/// @param controller may be null. @param effector index in Model::effectors().
int task_of(const TargetController* controller, int effector);

/// Effectors with a target, in the order of the controller's tasks.
/// @param controller may be null.
std::vector<int> steered_effectors(const TargetController* controller);

/// Adds to the list: for every effector, `NAME.target` (3,) and `NAME.error` in m or rad, NaN while
/// it has no target; `error`, the largest error of all tasks in m, or in rad if all of them are
/// orientations; the observables of the controller's own, NaN while it is not attached; and the
/// status `controller` in words, "none" without a controller, "start" before the first step.
/// @param list of the controller's simulation.
/// @param controller called now and at every reading. @param effectors that may have a target.
void add_controller(sim::Observables& list, AttachedController controller,
                    std::span<const int> effectors);
/// The same for a fixed controller and the effectors of its tasks.
/// @param list of its simulation. @param controller must outlive the list; null: adds the status
///   only.
void add_controller(sim::Observables& list, const TargetController* controller);

}  // namespace sinew::control
