/// @file
/// What can be observed of a controller: where effectors are asked to be, and how far off
/// they are.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace sinew::sim {
class Observables;
}

namespace sinew::inverse {

class TargetController;

/// The controller that is attached now; null while none is.
using AttachedController = std::function<const TargetController*()>;

/// The task of an effector, as a position in settings().tasks; -1: it has none.
/// @param controller may be null. @param effector of Model::effectors().
int task_of(const TargetController* controller, int effector);

/// Effectors that a controller steers, in the order of its tasks.
/// @param controller may be null.
std::vector<int> steered_effectors(const TargetController* controller);

/// Adds to the list, of every effector `NAME.target` (3,) and `NAME.error` in m or rad, NaN while
/// nothing steers it; `error`, the largest of all tasks in m, in rad where all of them turn; and
/// the status `controller` in words, "none" without a controller, "start" before the first step.
/// @param list of the controller's simulation. @param controller is asked at every reading.
/// @param effectors that it may steer.
void add_controller(sim::Observables& list, AttachedController controller,
                    std::span<const int> effectors);
/// The same of a controller that stays as it is, and of the effectors that it steers.
/// @param list of its simulation. @param controller outlives the list; null: the status alone is
/// added.
void add_controller(sim::Observables& list, const TargetController* controller);

}  // namespace sinew::inverse
