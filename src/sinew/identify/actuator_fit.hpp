/// @file
/// Fits the coefficients and delay of a fluidic actuator to records of volume and torque.
#pragma once

#include <span>
#include <string>

#include "sinew/identify/parameter_fit.hpp"
#include "sinew/pcc/fluidic_actuator.hpp"

namespace sinew::identify {

/// Volume and torque of an actuator over time.
struct ActuatorRecord {
  std::string name;
  VectorX time;            ///< (samples,) s, increasing
  VectorX volume, torque;  ///< (samples,) m^3, N m; nan where the torque was not measured
};

/// A fitted actuator.
struct ActuatorFit {
  pcc::FluidicActuator actuator;
  ParameterFit fit;  ///< "cubic", "delay", and "linear" unless it is fixed at zero
};

/// Fits c and t_d (and a, if `linear`) of tau = a V(t - t_d) + c V(t - t_d)^3.
/// @param records at least one. @param linear fit a as well.
/// @param longest_delay s, upper bound of t_d. @param settings of the search.
/// Throws Error: empty-list, wrong-length, non-monotonic-time, too-few-points, out-of-range (the
/// torque does not grow with the cube of the volume), and what fit_parameters() throws.
ActuatorFit fit_actuator(std::span<const ActuatorRecord> records, bool linear = false,
                         double longest_delay = 0.5, const ParameterFitSettings& settings = {});

}  // namespace sinew::identify
