#include "sinew/plan/task.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/plan/nonlinear_program.hpp"

namespace sinew::plan {

namespace {

void fill(VectorX& values, Eigen::Index size, double with, const char* item) {
  if (values.size() == 0) values = VectorX::Constant(size, with);
  if (values.size() != size) {
    throw Error(ErrorKind::wrong_length, {.item = item},
                fmt::format("{} values are given", values.size()),
                fmt::format("give {} or none", size));
  }
  for (const double value : values) {
    if (std::isnan(value)) {
      throw Error(ErrorKind::not_finite, {.item = item}, "one is not a number", "give numbers");
    }
  }
  // Limits beyond the solver's infinity are inactive.
  values = values.cwiseMax(-kNoBound).cwiseMin(kNoBound);
}

void check_order(const VectorX& lower, const VectorX& upper, const char* item) {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (lower[i] > upper[i]) {
      throw Error(
          ErrorKind::contradictory_limits, {.item = fmt::format("{}[{}]", item, i)},
          fmt::format("the lower limit {:g} is above the upper one {:g}", lower[i], upper[i]),
          "swap them");
    }
  }
}

void check_within(const VectorX& value, const VectorX& lower, const VectorX& upper,
                  const char* item, const char* unit) {
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if (value[i] < lower[i] || value[i] > upper[i]) {
      throw Error(ErrorKind::contradictory_limits, {.item = fmt::format("{}[{}]", item, i)},
                  fmt::format("{:g} {} is outside its limits {:g} and {:g}", value[i], unit,
                              lower[i], upper[i]),
                  "start within the limits, or widen them");
    }
  }
}

void check_positive(double value, const char* item, const char* unit) {
  if (!(value > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = item}, fmt::format("{:g} {}", value, unit),
                "give more than zero");
  }
}

void check_not_negative(double value, const char* item) {
  if (!(value >= 0.0) || !std::isfinite(value)) {
    throw Error(ErrorKind::out_of_range, {.item = item}, fmt::format("{:g}", value),
                "give zero or more");
  }
}

void check_goal(const pcc::Arm& arm, const Goal& goal) {
  if (!goal.position.allFinite()) {
    throw Error(ErrorKind::not_finite, {.item = "goal.position"}, "a coordinate is not a number",
                "give three numbers in m");
  }
  check_positive(goal.tolerance, "goal.tolerance", "m");
  check_positive(goal.speed_tolerance, "goal.speed_tolerance", "m/s");
  for (const pcc::Segment& segment : arm.settings().segments) {
    if (segment.extensible) return;  // its length is not limited
  }
  const double distance = (goal.position - arm.settings().base).norm();
  if (distance > arm.length() + goal.tolerance) {
    throw Error(ErrorKind::out_of_range, {.item = "goal.position"},
                fmt::format("it is {:.4g} m from the base, and the arm is {:.4g} m long", distance,
                            arm.length()),
                "give a goal within the arm's length");
  }
}

void check_grid(Grid& grid) {
  check_positive(grid.duration, "grid.duration", "s");
  if (grid.intervals < 2) {
    throw Error(ErrorKind::out_of_range, {.item = "grid.intervals"},
                fmt::format("{}", grid.intervals), "give 2 or more");
  }
  fill(grid.fractions, grid.intervals, 1.0 / grid.intervals, "grid.fractions");
  if (!(grid.fractions.minCoeff() > 0.0) || std::abs(grid.fractions.sum() - 1.0) > 1e-9) {
    throw Error(ErrorKind::out_of_range, {.item = "grid.fractions"},
                fmt::format("the least is {:g} and they add up to {:.12g}",
                            grid.fractions.minCoeff(), grid.fractions.sum()),
                "give positive ones that add up to 1");
  }
  if (!grid.free()) return;
  check_positive(grid.min_duration, "grid.min_duration", "s");
  if (grid.min_duration > grid.max_duration) {
    throw Error(
        ErrorKind::contradictory_limits, {.item = "grid.min_duration"},
        fmt::format("{:g} s is above the most, {:g} s", grid.min_duration, grid.max_duration),
        "swap them");
  }
}

void check_obstacles(std::vector<Obstacle>& obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    Obstacle& obstacle = obstacles[i];
    const std::string item = fmt::format("obstacles[{}]", i);
    check_not_negative(obstacle.clearance, item.c_str());
    if (obstacle.kind == Obstacle::Kind::sphere) {
      check_positive(obstacle.radius, item.c_str(), "m of radius");
    } else {
      check_positive(obstacle.normal.norm(), item.c_str(), "as the normal's length");
      obstacle.normal.normalize();
    }
  }
}

void complete_drive(PlanTask& task) {
  DriveTrain& drive = *task.drive;
  double delay = 0.0;
  for (const DriveChannel& channel : drive.channels) {
    delay = std::max(delay, channel.actuator.delay);
  }
  if (drive.lead < 0.0 && !drive.channels.empty()) {
    const double step = drive.channels.front().cylinder.sample_time;
    drive.lead = std::max(delay, std::ceil(delay / step - 1e-9) * step);
  }
  check_channels(drive.channels, task.start.torque.size(), drive.lead, "drive");
  check_positive(task.objective.command, "objective.command", "s/(N m)^2");
  if (task.grid.free()) {
    throw Error(ErrorKind::contradictory_limits, {.item = "grid.max_duration"},
                "with a drive the duration is not free, as its cylinders are sampled",
                "give the duration alone");
  }
  for (std::size_t i = 0; i < drive.channels.size(); ++i) {
    const auto& [actuator, cylinder] = drive.channels[i];
    const std::string item = fmt::format("drive[{}]", i);
    if (cylinder.gain() == 0.0) {
      throw Error(ErrorKind::out_of_range, {.item = item}, "the cylinder's gain at rest is zero",
                  "give one whose command moves the volume");
    }
    const double volume = actuator.volume(task.start.torque[static_cast<Eigen::Index>(i)]);
    const double command = volume / cylinder.gain();
    if (volume < cylinder.lowest_volume || volume > cylinder.highest_volume ||
        command < cylinder.lowest_input || command > cylinder.highest_input) {
      throw Error(ErrorKind::contradictory_limits, {.item = item},
                  fmt::format("the start's torque needs a volume of {:g} m^3 and the command {:g}, "
                              "outside the cylinder's limits",
                              volume, command),
                  "start within the limits, or widen them");
    }
  }
}

}  // namespace

double Obstacle::distance(const Vector3& at) const {
  return kind == Kind::sphere ? (at - point).norm() - radius : normal.dot(at - point);
}

Vector3 Obstacle::gradient(const Vector3& at) const {
  return kind == Kind::sphere ? (at - point).normalized() : normal;
}

Matrix3 Obstacle::hessian(const Vector3& at) const {
  if (kind == Kind::plane) return Matrix3::Zero();
  const Vector3 away = at - point;
  const double length = away.norm();
  if (length == 0.0) return Matrix3::Zero();
  return (Matrix3::Identity() - away * away.transpose() / (length * length)) / length;
}

PlanTask completed(const pcc::Arm& arm, PlanTask task) {
  const Eigen::Index n = arm.coordinates(), inputs = arm.inputs();
  fill(task.start.position, n, 0.0, "start.position");
  fill(task.start.rate, n, 0.0, "start.rate");
  fill(task.start.torque, inputs, 0.0, "start.torque");
  ArmLimits& limits = task.limits;
  fill(limits.torque_lower, inputs, -kNoBound, "limits.torque_lower");
  fill(limits.torque_upper, inputs, kNoBound, "limits.torque_upper");
  fill(limits.angle_lower, n, -kNoBound, "limits.angle_lower");
  fill(limits.angle_upper, n, kNoBound, "limits.angle_upper");
  fill(limits.rate, n, kNoBound, "limits.rate");
  fill(limits.torque_rate, inputs, kNoBound, "limits.torque_rate");
  fill(limits.command_rate, inputs, kNoBound, "limits.command_rate");
  check_order(limits.torque_lower, limits.torque_upper, "limits.torque");
  check_order(limits.angle_lower, limits.angle_upper, "limits.angle");
  for (const double rate : limits.rate) check_not_negative(rate, "limits.rate");
  for (const double rate : limits.torque_rate) check_positive(rate, "limits.torque_rate", "N m/s");
  for (const double rate : limits.command_rate) check_positive(rate, "limits.command_rate", "1/s");
  check_within(task.start.position, limits.angle_lower, limits.angle_upper, "start.position",
               "rad");
  check_within(task.start.rate, -limits.rate, limits.rate, "start.rate", "rad/s");
  check_within(task.start.torque, limits.torque_lower, limits.torque_upper, "start.torque", "N m");
  check_not_negative(task.objective.effort, "objective.effort");
  check_not_negative(task.objective.tip_speed, "objective.tip_speed");
  check_not_negative(task.objective.time, "objective.time");
  if (task.backbone_points < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "backbone_points"},
                fmt::format("{}", task.backbone_points), "give 1 or more");
  }
  check_goal(arm, task.goal);
  check_grid(task.grid);
  check_obstacles(task.obstacles);
  if (task.drive) complete_drive(task);
  return task;
}

}  // namespace sinew::plan
