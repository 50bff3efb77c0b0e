/// @file
/// From planned torques back to what drives an arm: volumes by the actuators' inverse, then the
/// commands of the cylinders that deliver them as nearly as their dynamics and limits allow.
#pragma once

#include <vector>

#include "sinew/plan/drive_channel.hpp"
#include "sinew/plan/planner.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::plan {

struct CylinderInversionSettings {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< the cylinder's state x_0
  /// What changes of the command cost, relative to errors of volume, > 0. A sampled second-order
  /// system has a zero near -1, so that the exact inverse of a jump rings from sample to sample.
  double smoothing = 1e-6;
};

/// What a cylinder is to be told.
struct CylinderInversion {
  qp::QpStatus status = qp::QpStatus::optimal;
  VectorX command;  ///< (samples,) u
  VectorX volume;   ///< (samples,) y that they give
};

/// Minimises
///   sum_k (V_k - C x_k - D u_k)^2 + smoothing g^2 sum_k (u_k - u_{k-1})^2
/// over the commands u subject to x_{k+1} = A x_k + B u_k and the cylinder's limits of command and
/// volume (Marchese, Tedrake & Rus, Int. J. Robotics Research 35, 2016, have the first term); g is
/// the gain at rest. States are eliminated, y = y_free + T u with T Toeplitz of the impulse
/// response, which leaves a dense quadratic program in u. Where no command keeps the volume within
/// its limits the status is infeasible.
/// @param cylinder that is driven. @param volume (samples,) V at its sample times, >= 2.
/// @param settings start and smoothing. Throws Error(out-of-range | not-finite |
/// contradictory-limits | too-few-points).
CylinderInversion invert_cylinder(const pcc::DriveCylinder& cylinder, const VectorX& volume,
                                  const CylinderInversionSettings& settings = {});

/// Commands for all inputs of an arm; columns are inputs.
struct DriveInversion {
  bool found = false;                ///< all of `status` are optimal
  std::vector<qp::QpStatus> status;  ///< (inputs,)
  VectorX times;                     ///< (samples,) s
  MatrixX command;                   ///< (samples, inputs)
  MatrixX wanted;                    ///< (samples, inputs) m^3, the actuators' inverse of the plan
  MatrixX volume;                    ///< (samples, inputs) m^3, that the commands give
};

/// The plan's torque is to act from `lead` on, the volume therefore the line's delay earlier:
/// V(t) = actuator.volume(tau(t - lead + delay)), the torque before the plan its first one if that
/// is not zero. Samples go from 0 to lead + duration in the cylinders' sample time, which is one
/// for all; at the end the tip is at the goal.
/// @param plan of as many inputs as there are channels. @param channels of the inputs.
/// @param lead s, at least the longest delay. @param settings of each cylinder.
/// Throws Error(out-of-range | wrong-length) and what invert_cylinder() throws.
DriveInversion invert_drive(const Plan& plan, const std::vector<DriveChannel>& channels,
                            double lead, const CylinderInversionSettings& settings = {});

}  // namespace sinew::plan
