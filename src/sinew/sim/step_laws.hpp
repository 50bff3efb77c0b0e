/// @file
/// The laws of a simulation's steps, and which of them act in one.
#pragma once

#include <span>

#include "sinew/sim/contact_law.hpp"
#include "sinew/sim/direct_law.hpp"
#include "sinew/sim/driven_law.hpp"
#include "sinew/sim/friction_law.hpp"

namespace sinew::sim {

class StepLaws {
 public:
  explicit StepLaws(const Model& model);

  /// The direct law, or a controller's in its place, with what stands between it and the step's
  /// equation: drives, friction of cables.
  /// @param controller null where there is none. @param ranges of the actuators in this step.
  Law& complete(Law* controller, std::span<const ActuatorRange> ranges);

  /// See Law::begin_step().
  void begin_step();

  const qp::ConeResult& contact_result() const { return contact_.result(); }

 private:
  const Model& model_;
  DirectLaw direct_;
  ContactLaw contact_;
  DrivenLaw driven_;
  FrictionLaw friction_;
};

}  // namespace sinew::sim
