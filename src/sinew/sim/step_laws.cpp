#include "sinew/sim/step_laws.hpp"

#include <algorithm>

#include "sinew/sim/model.hpp"

namespace sinew::sim {

StepLaws::StepLaws(const Model& model)
    : model_(model),
      direct_(static_cast<int>(model.range_count())),
      contact_(model),
      driven_(model.rows().rows(), static_cast<int>(model.range_count())),
      friction_(model) {}

Law& StepLaws::complete(Law* controller, std::span<const ActuatorRange> ranges) {
  const bool driven = std::ranges::any_of(ranges, DrivenLaw::takes);
  Law& direct = model_.contacts().empty() ? static_cast<Law&>(direct_) : contact_;
  Law& chooser = controller != nullptr ? *controller : direct;
  Law& inner = driven ? driven_.around(chooser) : chooser;
  if (model_.guides().empty()) return inner;
  return controller == nullptr ? friction_.around(inner, nullptr)
                               : friction_.around(direct, &inner);
}

void StepLaws::begin_step() {
  direct_.begin_step();
  contact_.begin_step();
}

}  // namespace sinew::sim
