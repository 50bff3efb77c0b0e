/// @file
/// A brace carried out: the arm moves to contact, presses, plans the rest anew with the braced
/// angles as measured, moves to its goal and is disturbed there. Contact is real: unilateral, with
/// Coulomb's exact cone (sim::Simulation).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "sinew/plan/brace.hpp"

namespace sinew::plan {

/// Forces on the tip while it is to hold still: along x, y and z a sum of sines of random
/// frequencies and phases, of equal amplitudes.
struct Disturbance {
  double force = 0.01;  ///< N, root mean square along each axis over long times, >= 0
  double min_frequency = 0.2, max_frequency = 2.0;  ///< Hz, > 0
  int sines = 4;                                    ///< >= 1
  std::uint64_t seed = 1;
};

struct BraceRunSettings {
  double time_step = 1e-3;  ///< s, > 0, of backward Euler
  double approach = 1.5;    ///< s, > 0, of moving to contact
  double press = 1.0;       ///< s, > 0, of holding the brace's torque
  double move = 1.0;        ///< s, > 0, from there to the goal
  double settle = 1.0;      ///< s, > 0, at the goal
  double hold = 4.0;        ///< s, > 0, disturbed
  /// Per-segment PD about the plan's angles: torque = plan + proportional error - derivative rate,
  /// within the limits. Steps are explicit in it: the derivative stays below the arm's own damping.
  double proportional = 0.1;       ///< N m/rad, >= 0
  double derivative = 1e-3;        ///< N m s, >= 0
  std::optional<double> friction;  ///< Coulomb's; none: the least of each object's range
  Disturbance disturbance;
};

enum class BraceRunStatus {
  held,         ///< it came to its goal and the braced point stuck all the while it was disturbed
  slipped,      ///< the braced point slipped or left the object while disturbed
  no_contact,   ///< after pressing the braced point touched nothing
  not_planned,  ///< no brace was given, or with the measured angles there is no plan
};
/// "held", "slipped", "no-contact", "not-planned".
std::string_view status_name(BraceRunStatus status);

/// What an arm did over equal steps.
struct BraceRun {
  BraceRunStatus status = BraceRunStatus::not_planned;
  VectorX times;                         ///< (steps + 1,) s
  MatrixX position, torque;              ///< (steps + 1, coordinates or inputs)
  Points tip;                            ///< (steps + 1, 3) m
  VectorX normal_force, friction_force;  ///< (steps + 1,) N, of the braced point
  double contact_time = 0.0, replan_time = 0.0, disturbed_from = 0.0;  ///< s; contact: 0 is never
  Brace before, after;            ///< as planned, and anew with the measured angles
  VectorX measured;               ///< (coordinates,) when it was planned anew
  int slips = 0;                  ///< steps, disturbed, in which the braced point did not stick
  double cone_residual = 0.0;     ///< N, largest of |f_t| - mu F_n in any step
  double contact_residual = 0.0;  ///< largest relative residual of the contacts' laws in any step
  /// Of the tip while disturbed: mean distance from the goal, distance of its mean from the goal,
  /// and its spread, root mean square about its mean; m.
  double mean_error = 0.0, offset = 0.0, spread = 0.0;
};

/// The arm with its objects as a simulation sees them: contact points on the whole skin, a torque
/// on each coordinate.
/// @param arm,task,brace as of find_brace(). @param settings see there.
BraceRun run_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task,
                   const Brace& brace, const BraceRunSettings& settings = {});
/// The same without objects: the torque of the equilibrium nearest to the goal, and the same
/// disturbance. status: held.
BraceRun run_free(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task,
                  const BraceRunSettings& settings = {});

}  // namespace sinew::plan
