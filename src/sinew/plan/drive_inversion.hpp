/// @file
/// Inverts the drive of an arm: computes volumes from planned torques by the inverse of the
/// actuators, and then the commands of the cylinders that approximate these volumes best within
/// their dynamics and limits.
#pragma once

#include <vector>

#include "sinew/plan/drive_channel.hpp"
#include "sinew/plan/planner.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::plan {

/// Initial state and weight of invert_cylinder().
struct CylinderInversionSettings {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< initial state x_0 of the cylinder
  /// Weight of changes of the command relative to errors of volume, > 0. A sampled second-order
  /// system has a zero near -1, so the exact inverse of a jump would oscillate from sample to
  /// sample.
  double smoothing = 1e-6;
};

/// The commands of one cylinder.
struct CylinderInversion {
  qp::QpStatus status = qp::QpStatus::optimal;
  VectorX command;  ///< (samples,) u
  VectorX volume;   ///< (samples,) y, the resulting volume
};

/// Computes the commands of a cylinder for given volumes. It minimises
///   sum_k (V_k - C x_k - D u_k)^2 + smoothing g^2 sum_k (u_k - u_{k-1})^2
/// over the commands u, subject to x_{k+1} = A x_k + B u_k and the limits of command and volume
/// (Marchese, Tedrake & Rus, Int. J. Robotics Research 35, 2016, use the first term); g is the gain
/// at rest. Eliminating the states by y = y_free + T u, where T is the Toeplitz matrix of the
/// impulse response, gives a dense quadratic program in u. If no command keeps the volume within
/// its limits, the status is infeasible.
/// @param cylinder that is driven. @param volume (samples,) V at its sample times, >= 2.
/// @param settings initial state and smoothing. Throws Error(out-of-range | not-finite |
/// contradictory-limits | too-few-points).
CylinderInversion invert_cylinder(const pcc::DriveCylinder& cylinder, const VectorX& volume,
                                  const CylinderInversionSettings& settings = {});

/// Commands for all inputs of an arm; columns are inputs.
struct DriveInversion {
  bool found = false;                ///< whether all of `status` are optimal
  std::vector<qp::QpStatus> status;  ///< (inputs,)
  VectorX times;                     ///< (samples,) s
  MatrixX command;                   ///< (samples, inputs)
  MatrixX wanted;                    ///< (samples, inputs) m^3, volumes required by the plan
  MatrixX volume;                    ///< (samples, inputs) m^3, resulting volumes
};

/// Computes the commands for a plan. The torque of the plan acts from `lead` on, so the volume is
/// needed earlier by the delay of the line: V(t) = actuator.volume(tau(t - lead + delay)). Before
/// the plan, tau is its first torque. Samples extend from 0 to lead + duration in the common sample
/// time of the cylinders; at the end the tip is at the goal.
/// @param plan with one input per channel. @param channels of the inputs.
/// @param lead s, at least the longest delay. @param settings of each cylinder.
/// Throws Error(out-of-range | wrong-length) and what invert_cylinder() throws.
DriveInversion invert_drive(const Plan& plan, const std::vector<DriveChannel>& channels,
                            double lead, const CylinderInversionSettings& settings = {});

}  // namespace sinew::plan
