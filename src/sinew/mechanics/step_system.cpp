#include "sinew/mechanics/step_system.hpp"

#include "sinew/core/error.hpp"

namespace sinew::mechanics {

Vector3 StepSystem::proposed_motion(int) const {
  throw Error(ErrorKind::internal, {},
              "this body takes all its rows, and was asked of one left out", "report this");
}

void StepSystem::add_proposed_motion(Points&) const {
  throw Error(ErrorKind::internal, {}, "this body has no surface, and was asked to move it",
              "report this");
}

}  // namespace sinew::mechanics
