/// @file
/// What an arm model predicts of a record, with exact derivatives by its parameters.
#pragma once

#include <memory>
#include <vector>

#include "sinew/identify/motion_record.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/pcc/fluidic_actuator.hpp"

namespace sinew::identify {

/// An arm with what drives it.
struct ArmModel {
  std::shared_ptr<const pcc::Arm> arm;
  /// One for each input, whose volume records hold; none: records hold torques, or nothing.
  std::vector<pcc::FluidicActuator> actuators;
};

/// Derivatives by P parameters of what a motion depends on; they are constants, as masses,
/// stiffnesses, dampings and coefficients are linear in the parameters.
struct ArmParameterMap {
  MatrixX mass;       ///< (segments, P)
  MatrixX stiffness;  ///< (coordinates, P)
  MatrixX damping;    ///< (coordinates, P)
  MatrixX cubic;      ///< (inputs, P), of the actuators' c
  VectorX delay;      ///< (P,), of all actuators' t_d
  MatrixX position;   ///< (coordinates, P), of the start
  MatrixX rate;       ///< (coordinates, P)

  /// Of zeros. @param arm whose. @param parameters P.
  ArmParameterMap(const pcc::Arm& arm, Eigen::Index parameters);
};

/// A start of a motion.
struct ArmStart {
  VectorX position, rate;  ///< (coordinates,) rad and rad/s
};

/// Ends of all segments at the record's times, (samples, 3 segments) m: even implicit steps from
/// its first time on, cubic Hermite interpolation of angles and their derivatives in between.
/// @param model what moves. @param record times and inputs. @param start at the first time.
/// @param settings of the steps; the time step is shortened to divide the record evenly.
/// @param map what to differentiate by, or null.
/// @param jacobian (samples * 3 segments, P) of the result row by row, filled with `map`.
/// Throws Error(wrong-length) for inputs that do not fit the model, and what ArmSimulation does.
MatrixX predict_motion(const ArmModel& model, const MotionRecord& record, const ArmStart& start,
                       const pcc::ArmStepSettings& settings, const ArmParameterMap* map = nullptr,
                       MatrixX* jacobian = nullptr);

/// Angles in which the ends come nearest to those first seen, by least squares; rates are zero.
/// @param arm whose. @param record of which each coordinate's first value counts.
ArmStart first_pose(const pcc::Arm& arm, const MotionRecord& record);

}  // namespace sinew::identify
