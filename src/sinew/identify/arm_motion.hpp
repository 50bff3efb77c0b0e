/// @file
/// Prediction of a record by an arm model, with exact derivatives with respect to its parameters.
#pragma once

#include <memory>
#include <vector>

#include "sinew/identify/motion_record.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/pcc/fluidic_actuator.hpp"

namespace sinew::identify {

/// An arm and its actuators.
struct ArmModel {
  std::shared_ptr<const pcc::Arm> arm;
  /// One for each input if records contain volumes; empty if they contain torques, or no inputs.
  std::vector<pcc::FluidicActuator> actuators;
};

/// Derivatives of the quantities on which a motion depends, with respect to P parameters. They are
/// constant, since masses, stiffnesses, dampings and coefficients are linear in the parameters.
struct ArmParameterMap {
  MatrixX mass;       ///< (segments, P)
  MatrixX stiffness;  ///< (coordinates, P)
  MatrixX damping;    ///< (coordinates, P)
  MatrixX cubic;      ///< (inputs, P), c of the actuators
  VectorX delay;      ///< (P,), t_d of all actuators
  MatrixX position;   ///< (coordinates, P), at the start
  MatrixX rate;       ///< (coordinates, P)

  /// A map of zeros. @param arm its sizes. @param parameters P.
  ArmParameterMap(const pcc::Arm& arm, Eigen::Index parameters);
};

/// The start of a motion.
struct ArmStart {
  VectorX position, rate;  ///< (coordinates,) rad and rad/s
};

/// Predicts the ends of all segments at the record's times, (samples, 3 segments) m, by equal
/// implicit steps from its first time on. Angles and their derivatives are interpolated by cubic
/// Hermite polynomials.
/// @param model that moves. @param record times and inputs. @param start at the first time.
/// @param settings of the steps; the time step is shortened to divide the record evenly.
/// @param map derivatives with respect to the parameters, or null.
/// @param jacobian (samples * 3 segments, P) of the result row by row, filled if `map` is given.
/// Throws Error: wrong-length for inputs that do not fit the model, and what ArmSimulation throws.
MatrixX predict_motion(const ArmModel& model, const MotionRecord& record, const ArmStart& start,
                       const pcc::ArmStepSettings& settings, const ArmParameterMap* map = nullptr,
                       MatrixX* jacobian = nullptr);

/// The pose whose ends are nearest to those first seen, by least squares; rates are zero.
/// @param arm to be posed. @param record of which the first value of each coordinate is used.
ArmStart first_pose(const pcc::Arm& arm, const MotionRecord& record);

}  // namespace sinew::identify
