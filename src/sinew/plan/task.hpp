/// @file
/// The task of a plan: initial state, goal of the tip, limits, obstacles, cost and grid.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sinew/pcc/arm.hpp"
#include "sinew/plan/drive_channel.hpp"
#include "sinew/plan/transcription.hpp"

namespace sinew::plan {

/// State and torque at time 0. The torque continues from there without a jump (with Radau; with
/// limits on its rate, both methods).
struct Start {
  VectorX position;  ///< (coordinates,) rad; empty: straight
  VectorX rate;      ///< (coordinates,) rad/s; empty: at rest
  VectorX torque;    ///< (inputs,) N m; empty: none
};

/// Goal of the tip, which is the end of the last segment, at the end of the plan.
struct Goal {
  Vector3 position = Vector3::Zero();  ///< m
  double tolerance = 2e-3;             ///< m, > 0, on the tip's distance
  double speed_tolerance = 5e-3;       ///< m/s, > 0, on the tip's speed; kNoBound: any speed
};

/// Limits of an arm. Empty vectors mean no limit.
struct ArmLimits {
  VectorX torque_lower, torque_upper;  ///< (inputs,) N m
  VectorX angle_lower, angle_upper;    ///< (coordinates,) rad; extension: m
  VectorX rate;                        ///< (coordinates,) rad/s, >= 0, absolute
  VectorX torque_rate;                 ///< (inputs,) N m/s, > 0, absolute
  VectorX command_rate;                ///< (inputs,) of a drive's commands, 1/s, > 0, absolute
};

/// An obstacle that points along the arm's axis avoid at the knots.
struct Obstacle {
  enum class Kind { sphere, plane };
  Kind kind = Kind::sphere;
  Vector3 point = Vector3::Zero();    ///< m, the sphere's centre, or on the plane
  double radius = 0.0;                ///< m, > 0, of a sphere
  Vector3 normal = Vector3::UnitZ();  ///< of a plane, towards the free side; any length
  double clearance = 0.0;             ///< m, >= 0, required between axis and surface

  /// Distance (m) of a point from the surface, negative inside, and its gradient and Hessian.
  double distance(const Vector3& at) const;
  Vector3 gradient(const Vector3& at) const;
  Matrix3 hessian(const Vector3& at) const;
};

/// Weights of the cost effort * integral of tau . tau dt + tip_speed * |v|^2 + time * t_f, where v
/// is the final velocity of the tip. With a drive, the term command * integral of |k du/dt|^2 dt is
/// added, where k is the static torque per command at the largest volume within the limits.
struct Objective {
  double effort = 0.1;     ///< R, 1/((N m)^2 s), >= 0
  double tip_speed = 0.0;  ///< (s/m)^2, >= 0
  double time = 0.0;       ///< 1/s, >= 0, if the duration is free
  double command = 3e-5;   ///< s/(N m)^2, > 0, with a drive
};

/// Method, duration and intervals of the transcription.
struct Grid {
  CollocationMethod method = CollocationMethod::radau;
  double duration = 1.6;  ///< s, > 0; if free, the initial guess
  int intervals = 50;     ///< >= 2
  VectorX fractions;      ///< (intervals,) of the duration, > 0, with sum 1; empty: equal
  double min_duration = 0.0, max_duration = 0.0;  ///< s; both 0: the duration is fixed
  bool free() const { return max_duration > 0.0; }
};

/// Drives of the inputs. With these, a plan has commands instead of prescribed torques.
struct DriveTrain {
  std::vector<DriveChannel> channels;  ///< of the inputs
  /// Time by which commands precede the motion, s, at least the longest delay. Negative: the
  /// longest delay, rounded up to whole samples.
  double lead = -1.0;
};

/// The task of a plan.
struct PlanTask {
  Start start;
  Goal goal;
  ArmLimits limits;
  Objective objective;
  std::vector<Obstacle> obstacles;
  int backbone_points = 4;  ///< per segment, >= 1, that avoid obstacles
  Grid grid;
  std::optional<DriveTrain> drive;  ///< requires a fixed duration
};

/// Checks a task and fills in empty vectors. Throws Error(wrong-length | not-finite | out-of-range
/// | contradictory-limits) for vectors of wrong length, limits that cross or that the initial state
/// violates, invalid tolerances and grids, a goal farther from the base than the length of the arm,
/// and drives that do not match the arm or each other or cannot hold the initial torque.
PlanTask completed(const pcc::Arm& arm, PlanTask task);

}  // namespace sinew::plan
