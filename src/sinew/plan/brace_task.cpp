#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/plan/brace.hpp"
#include "sinew/plan/reach.hpp"
#include "sinew/plan/refuse.hpp"

namespace sinew::plan {

BraceTask completed(const pcc::Arm& arm, BraceTask task) {
  PlanTask common;
  common.goal = {task.goal, task.tolerance, kNoBound};
  static_cast<void>(completed(arm, common));  // checks the goal
  task.limits = completed_limits(arm, task.limits);
  for (BraceObject& object : task.objects) {
    object.surface = collision::checked(object.surface);
    if (!(object.friction.min >= 0.0) || !(object.friction.max >= object.friction.min)) {
      refuse("object.friction",
             fmt::format("{:g} to {:g}", object.friction.min, object.friction.max),
             "give coefficients of zero or more, the least first");
    }
    if (!(object.stiffness.radial > 0.0) || !(object.stiffness.torsional > 0.0)) {
      refuse("object.stiffness", "it is not positive", "give N/m and N m/rad");
    }
  }
  if (task.fractions.empty()) refuse("fractions", "none is given", "give some above 0, up to 1");
  for (const double fraction : task.fractions) {
    if (!(fraction > 0.0) || fraction > 1.0) {
      refuse("fractions", fmt::format("{:g}", fraction), "give parts above 0, up to 1");
    }
  }
  if (task.along < 1) refuse("along", fmt::format("{}", task.along), "give 1 or more");
  if (task.sides == 0) {
    const auto& segments = arm.settings().segments;
    task.sides = std::any_of(segments.begin(), segments.end(),
                             [](const pcc::Segment& segment) {
                               return segment.bending == pcc::Bending::spatial;
                             })
                     ? 4
                     : 2;
  }
  if (task.sides < 2) refuse("sides", fmt::format("{}", task.sides), "give 2 or more, or 0");
  if (!(task.friction_fraction > 0.0) || task.friction_fraction > 1.0) {
    refuse("friction_fraction", fmt::format("{:g}", task.friction_fraction),
           "give above 0, up to 1");
  }
  if (!(task.clearance >= 0.0)) {
    refuse("clearance", fmt::format("{:g} m", task.clearance), "give zero or more");
  }
  if (!(task.min_force > 0.0)) {
    refuse("min_force", fmt::format("{:g} N", task.min_force), "give a positive force");
  }
  if (!(task.max_force >= task.min_force)) {
    throw Error(ErrorKind::contradictory_limits, {.item = "max_force"},
                fmt::format("{:g} N is below the least, {:g} N", task.max_force, task.min_force),
                "swap them");
  }
  if (!(task.hold_force >= 0.0) || !(task.hold_frequency >= 0.0)) {
    refuse("hold", fmt::format("{:g} N up to {:g} Hz", task.hold_force, task.hold_frequency),
           "give zero or more");
  }
  if (!(task.force_weight > 0.0)) refuse("force_weight", "it is not positive", "give 1/N^2");
  if (!(task.stiffness_ratio > 0.0)) refuse("stiffness_ratio", "it is not positive", "give 10");
  if (task.starts < 1) refuse("starts", fmt::format("{}", task.starts), "give 1 or more");
  if (!(task.turn_lower <= task.turn_upper)) {
    throw Error(ErrorKind::contradictory_limits, {.item = "turn"},
                fmt::format("{:g} rad is above {:g} rad", task.turn_lower, task.turn_upper),
                "swap them");
  }
  if (task.turn_lower != 0.0 || task.turn_upper != 0.0) {
    const pcc::ArmSettings& settings = arm.settings();
    if (settings.gravity.cross(settings.frame.col(2)).norm() > 1e-9 * settings.gravity.norm() ||
        !settings.loads.empty()) {
      refuse("turn", "gravity is not along the base's axis, or the arm has loads",
             "turn only bases about which the arm's weight is the same on all sides");
    }
  }
  return task;
}

namespace {

std::vector<pcc::ArmPoint> points_at(const pcc::Arm& arm, const std::vector<double>& fractions,
                                     int sides) {
  std::vector<pcc::ArmPoint> points;
  const double radius = arm.settings().radius;
  for (int segment = 0; segment < arm.segments(); ++segment) {
    for (const double fraction : fractions) {
      for (int side = 0; side < sides; ++side) {
        const double angle = 2.0 * std::numbers::pi * side / sides;
        points.push_back({.segment = segment,
                          .fraction = fraction,
                          .x = radius * std::cos(angle),
                          .y = radius * std::sin(angle)});
      }
    }
  }
  return points;
}

}  // namespace

std::vector<pcc::ArmPoint> brace_points(const pcc::Arm& arm, const BraceTask& task) {
  return points_at(arm, task.fractions, task.sides);
}

std::vector<pcc::ArmPoint> skin_points(const pcc::Arm& arm, const BraceTask& task) {
  std::vector<double> fractions = task.fractions;
  for (int step = 1; step <= task.along; ++step) {
    const double fraction = static_cast<double>(step) / task.along;
    if (std::ranges::none_of(task.fractions,
                             [&](double other) { return std::abs(other - fraction) < 1e-9; })) {
      fractions.push_back(fraction);
    }
  }
  std::ranges::sort(fractions);
  return points_at(arm, fractions, task.sides);
}

std::string_view status_name(BraceStatus status) {
  switch (status) {
    case BraceStatus::braced:
      return "braced";
    case BraceStatus::no_object_in_reach:
      return "no-object-in-reach";
    case BraceStatus::infeasible:
      break;
  }
  return "infeasible";
}

}  // namespace sinew::plan
