/// @file
/// A fluidic actuator's coefficients and delay from records of volume and torque.
#pragma once

#include <span>
#include <string>

#include "sinew/identify/parameter_fit.hpp"
#include "sinew/pcc/fluidic_actuator.hpp"

namespace sinew::identify {

/// tau and V of an actuator in time.
struct ActuatorRecord {
  std::string name;
  VectorX time;            ///< (samples,) s, growing
  VectorX volume, torque;  ///< (samples,) m^3, N m; nan where the torque was not measured
};

struct ActuatorFit {
  pcc::FluidicActuator actuator;
  ParameterFit fit;  ///< "cubic", "delay", and "linear" unless it is fixed at zero
};

/// c and t_d (and a, where `linear` is asked for) of tau = a V(t - t_d) + c V(t - t_d)^3.
/// @param records at least one. @param linear fit a as well. @param longest_delay s, bound of t_d.
/// @param settings of the search.
/// Throws Error: empty-list, wrong-length, non-monotonic-time, too-few-points, and what
/// fit_parameters() does.
ActuatorFit fit_actuator(std::span<const ActuatorRecord> records, bool linear = false,
                         double longest_delay = 0.5, const ParameterFitSettings& settings = {});

}  // namespace sinew::identify
