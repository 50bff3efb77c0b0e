/// @file
/// Simulates a brace: the arm moves to contact, presses, replans with the measured angles, moves to
/// its goal and is disturbed there. Contact is unilateral, with the exact Coulomb cone
/// (sim::Simulation).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "sinew/plan/brace.hpp"

namespace sinew::plan {

/// Disturbing forces on the tip: along each of x, y and z a sum of sines of equal amplitudes and
/// random frequencies and phases.
struct Disturbance {
  double force = 0.01;  ///< N, long-term root mean square along each axis, >= 0
  double min_frequency = 0.2, max_frequency = 2.0;  ///< Hz, > 0
  int sines = 4;                                    ///< >= 1
  std::uint64_t seed = 1;
};

/// Phases, feedback gains and disturbance of a run.
struct BraceRunSettings {
  double time_step = 1e-3;  ///< s, > 0, of backward Euler
  double approach = 1.5;    ///< s, > 0, duration of the motion to contact
  double press = 1.0;       ///< s, > 0, for which the torque of the brace is held
  double move = 1.0;        ///< s, > 0, duration of the motion to the goal
  double settle = 1.0;      ///< s, > 0, of rest at the goal
  double hold = 4.0;        ///< s, > 0, duration of the disturbance
  /// PD feedback on the planned angles of each segment, within the limits of torque:
  /// torque = plan + proportional error - derivative rate. It is explicit in time, so the
  /// derivative gain must stay below the damping of the arm.
  double proportional = 0.1;       ///< N m/rad, >= 0
  double derivative = 1e-3;        ///< N m s, >= 0
  std::optional<double> friction;  ///< coefficient; none: minimum of each object's range
  Disturbance disturbance;
};

enum class BraceRunStatus {
  held,         ///< the braced point stuck during the whole disturbance
  slipped,      ///< the braced point slipped or left the object during the disturbance
  no_contact,   ///< the braced point did not touch after pressing
  not_planned,  ///< no brace was given, or replanning with the measured angles failed
};
/// "held", "slipped", "no-contact", "not-planned".
std::string_view status_name(BraceRunStatus status);

/// The recorded motion of an arm, at equal steps.
struct BraceRun {
  BraceRunStatus status = BraceRunStatus::not_planned;
  VectorX times;                         ///< (steps + 1,) s
  MatrixX position, torque;              ///< (steps + 1, coordinates or inputs)
  Points tip;                            ///< (steps + 1, 3) m
  VectorX normal_force, friction_force;  ///< (steps + 1,) N, of the braced point
  double contact_time = 0.0, replan_time = 0.0, disturbed_from = 0.0;  ///< s; contact_time 0: never
  Brace before, after;            ///< as planned first, and as replanned
  VectorX measured;               ///< (coordinates,) at replanning
  int slips = 0;                  ///< disturbed steps in which the braced point did not stick
  double cone_residual = 0.0;     ///< N, maximum of |f_t| - mu F_n over all steps
  double contact_residual = 0.0;  ///< maximum relative residual of the contact laws
  /// Statistics of the tip during the disturbance, m: mean distance from the goal, distance of the
  /// mean position from the goal, and root mean square about the mean position.
  double mean_error = 0.0, offset = 0.0, spread = 0.0;
};

/// Simulates a brace. The simulation has contact points on the whole skin and a torque on each
/// coordinate. @param arm,task,brace as for find_brace(). @param settings of the run.
BraceRun run_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task,
                   const Brace& brace, const BraceRunSettings& settings = {});
/// Simulates the arm without objects for comparison, with the torque of the equilibrium nearest to
/// the goal and the same disturbance. The status is `held`.
BraceRun run_free(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task,
                  const BraceRunSettings& settings = {});

}  // namespace sinew::plan
