/// @file
/// What a plan is asked for: where the arm starts, where its tip is to be and how slow, within what
/// limits, at what cost.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sinew/pcc/arm.hpp"
#include "sinew/plan/drive_channel.hpp"
#include "sinew/plan/transcription.hpp"

namespace sinew::plan {

/// Where the arm is and what drives it at the time 0. The torque goes on from there without a jump
/// (Radau; with limits on its rate, both methods).
struct Start {
  VectorX position;  ///< (coordinates,) rad; empty: straight
  VectorX rate;      ///< (coordinates,) rad/s; empty: at rest
  VectorX torque;    ///< (inputs,) N m; empty: none
};

/// Of the last segment's end, at the end of the plan.
struct Goal {
  Vector3 position = Vector3::Zero();  ///< m
  double tolerance = 2e-3;             ///< m, > 0, of the tip's distance
  double speed_tolerance = 5e-3;       ///< m/s, > 0, of the tip's speed; kNoBound: any speed
};

/// Empty: none.
struct ArmLimits {
  VectorX torque_lower, torque_upper;  ///< (inputs,) N m
  VectorX angle_lower, angle_upper;    ///< (coordinates,) rad; extension: m
  VectorX rate;                        ///< (coordinates,) rad/s, >= 0, either way
  VectorX torque_rate;                 ///< (inputs,) N m/s, > 0, either way
  VectorX command_rate;                ///< (inputs,) of a drive's commands, 1/s, > 0, either way
};

/// What the arm's axis keeps clear of, at the knots, at points along it.
struct Obstacle {
  enum class Kind { sphere, plane };
  Kind kind = Kind::sphere;
  Vector3 point = Vector3::Zero();    ///< m, the sphere's centre, or on the plane
  double radius = 0.0;                ///< m, > 0, of a sphere
  Vector3 normal = Vector3::UnitZ();  ///< of a plane, towards where the arm may be; any length
  double clearance = 0.0;             ///< m, >= 0, left between the axis and the surface

  /// Distance (m) from the surface, negative inside; its gradient and Hessian by the point.
  double distance(const Vector3& at) const;
  Vector3 gradient(const Vector3& at) const;
  Matrix3 hessian(const Vector3& at) const;
};

/// Cost = effort * integral of tau . tau dt + tip_speed * |v|^2 + time * t_f, v the tip's at the
/// end; with a drive + command * integral of |k du/dt|^2 dt, k the torque per command, at rest, at
/// the largest volume within the limits.
struct Objective {
  double effort = 0.1;     ///< R, 1/((N m)^2 s), >= 0
  double tip_speed = 0.0;  ///< (s/m)^2, >= 0
  double time = 0.0;       ///< 1/s, >= 0, where the duration is free
  double command = 3e-5;   ///< s/(N m)^2, > 0, with a drive
};

struct Grid {
  CollocationMethod method = CollocationMethod::radau;
  double duration = 1.6;  ///< s, > 0; where it is free, the first guess
  int intervals = 50;     ///< >= 2
  VectorX fractions;      ///< (intervals,) of the duration, > 0, that add up to 1; empty: equal
  double min_duration = 0.0, max_duration = 0.0;  ///< s; both 0: the duration is fixed
  bool free() const { return max_duration > 0.0; }
};

/// What the plan is made for, instead of torques that come as told: a plan of commands.
struct DriveTrain {
  std::vector<DriveChannel> channels;  ///< of the inputs
  /// s, by which commands begin before the motion, at least the longest delay; negative: that, in
  /// whole samples.
  double lead = -1.0;
};

struct PlanTask {
  Start start;
  Goal goal;
  ArmLimits limits;
  Objective objective;
  std::vector<Obstacle> obstacles;
  int backbone_points = 4;  ///< a segment, >= 1, that keep clear of obstacles
  Grid grid;
  std::optional<DriveTrain> drive;  ///< its duration is fixed
};

/// Fills in what is empty, so that every vector has its size. Throws Error(wrong-length |
/// not-finite | out-of-range | contradictory-limits): vectors of the wrong length, limits that
/// cross or that the start breaks, tolerances and grids that make no sense, a goal that is further
/// from the base than the arm is long, drives that do not fit the arm or each other or that cannot
/// hold the start.
PlanTask completed(const pcc::Arm& arm, PlanTask task);

}  // namespace sinew::plan
