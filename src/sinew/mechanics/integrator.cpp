#include "sinew/mechanics/integrator.hpp"

namespace sinew::mechanics {

std::string_view integrator_name(Integrator integrator) {
  return integrator == Integrator::quasi_static ? "quasi-static" : "backward-euler";
}

StepWeights step_weights(Integrator integrator, double time_step) {
  if (integrator == Integrator::quasi_static) return {};
  const double rate = 1.0 / time_step;
  return {.rate = rate, .mass = rate * rate, .momentum = rate, .damping = rate};
}

}  // namespace sinew::mechanics
