#include "sinew/plan/brace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/plan/brace_program.hpp"
#include "sinew/plan/brace_response.hpp"
#include "sinew/plan/brace_search.hpp"
#include "sinew/plan/reach.hpp"
#include "sinew/plan/refuse.hpp"

namespace sinew::plan {

namespace {

constexpr double kPlanFraction = 0.4;  // of the tip's tolerance
constexpr int kMaxRounds = 4;          // of starts
constexpr double kReplanFraction = 0.95, kReplanForce = 0.5;

// Relative singular value below which a point is not held in a direction.
constexpr double kMinMotion = 1e-6;

bool same_point(const pcc::ArmPoint& a, const pcc::ArmPoint& b) {
  return a.segment == b.segment && a.fraction == b.fraction && a.x == b.x && a.y == b.y;
}

/// Whether the first segments are long enough to touch a surface.
bool in_reach(const pcc::Arm& arm, const constraint::SmoothSurface& surface, int segments) {
  double length = arm.settings().radius;
  for (int n = 0; n < segments; ++n) {
    const pcc::Segment& segment = arm.settings().segments[static_cast<std::size_t>(n)];
    if (segment.extensible) return true;
    length += segment.length + segment.dead_length;
  }
  return constraint::distance(surface, arm.settings().base).gap <= length;
}

/// The program of a candidate.
BraceProblem problem_of(const pcc::Arm& arm, const BraceTask& task, int object,
                        const pcc::ArmPoint& point, const SurfacePatch& patch) {
  const BraceObject& on = task.objects[static_cast<std::size_t>(object)];
  BraceProblem problem;
  problem.limits = task.limits;
  problem.turn_lower = task.turn_lower;
  problem.turn_upper = task.turn_upper;
  problem.goal = task.goal;
  problem.tolerance = kPlanFraction * task.tolerance;
  problem.point = point;
  problem.patch = patch;
  problem.friction = task.friction_fraction * on.friction.min;
  problem.min_force = task.min_force;
  problem.max_force = task.max_force;
  problem.force_weight = task.force_weight;
  for (const pcc::ArmPoint& other : skin_points(arm, task)) {
    if (!same_point(other, point)) problem.clear_points.push_back(other);
  }
  problem.clearance = task.clearance;
  for (const BraceObject& other : task.objects) problem.surfaces.push_back(other.surface);
  return problem;
}

struct Candidate {
  int object = 0;
  BraceProblem problem;
};

/// Angles, turn (0) and torques of the free arm's equilibrium nearest to the goal; zeros if there
/// is none.
VectorX nearest_to_goal(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task) {
  VectorX result = VectorX::Zero(arm->coordinates() + 1 + arm->inputs());
  const NearestReach reach = nearest_reach(arm, task.limits, task.goal, 5, task.seed);
  if (!reach.found) return result;
  result.head(arm->coordinates()) = reach.position;
  result.tail(arm->inputs()) = reach.torque;
  return result;
}

/// Holds the braced point at its position for the measured angles, along every direction in which
/// angles can move it. Of the other points, those that were clear must stay clear.
void hold_as_measured(BraceProblem& problem, const pcc::Arm& arm, double turn,
                      const VectorX& measured) {
  PointDerivatives points(std::make_shared<const pcc::Arm>(arm));
  const Vector3 base = arm.settings().base;
  const Matrix3 rotation = Eigen::AngleAxisd(turn, arm.settings().frame.col(2)).toRotationMatrix();
  std::vector<pcc::ArmPoint> looked_at{problem.point};
  looked_at.insert(looked_at.end(), problem.clear_points.begin(), problem.clear_points.end());
  const auto& at = points.positions(measured, looked_at);
  const auto in_world = [&](const Vector3& p) -> Vector3 { return base + rotation * (p - base); };
  problem.place = in_world(at[0].value);
  const linalg::Svd svd = linalg::svd(rotation * at[0].jacobian, linalg::SingularVectors::full_u);
  const Eigen::Index rank = (svd.values.array() > kMinMotion * svd.values[0]).count();
  problem.held = svd.u.leftCols(rank);
  std::vector<pcc::ArmPoint> clear;
  for (std::size_t p = 1; p < looked_at.size(); ++p) {
    const Vector3 place = in_world(at[p].value);
    if (std::ranges::all_of(problem.surfaces, [&](const constraint::SmoothSurface& surface) {
          return constraint::distance(surface, place).gap >= problem.clearance;
        })) {
      clear.push_back(looked_at[p]);
    }
  }
  problem.clear_points = std::move(clear);
}

/// Repeats rounds of starts until one finds a brace: which starts converge depends on rounding, and
/// so on the processor.
Brace find_brace_in(int rounds, const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& given,
                    int segments) {
  const BraceTask task = completed(*arm, given);
  if (segments < 1 || segments > arm->segments()) {
    refuse("segments", fmt::format("{}", segments), "give one of the arm's, counted from 1");
  }
  BraceSearch search(arm, task, Reserve::demanded);
  bool any_in_reach = task.objects.empty();
  std::vector<Candidate> candidates;
  for (int object = 0; object < static_cast<int>(task.objects.size()); ++object) {
    const auto& surface = task.objects[static_cast<std::size_t>(object)].surface;
    any_in_reach = any_in_reach || in_reach(*arm, surface, arm->segments());
    if (!in_reach(*arm, surface, segments)) continue;
    for (const pcc::ArmPoint& point : brace_points(*arm, task)) {
      if (point.segment != segments - 1) continue;
      for (const SurfacePatch& patch : patches_of(surface)) {
        candidates.push_back({object, problem_of(*arm, task, object, point, patch)});
      }
    }
  }
  std::optional<VectorX> nearest;
  for (int round = 0; round < rounds && !search.found(); ++round) {
    for (const Candidate& candidate : candidates) {
      for (int start = 0; start < task.starts; ++start) {
        VectorX guess = search.random_start(candidate.problem);
        if (round == 0 && start == 0) {
          // Starts at the equilibrium of the free arm nearest to the goal.
          if (!nearest) nearest = nearest_to_goal(arm, task);
          const double turn = guess[arm->coordinates()];
          guess = *nearest;
          guess[arm->coordinates()] = turn;
        }
        search.attempt(candidate.problem, candidate.object, guess);
      }
    }
  }
  Brace result =
      search.finish(any_in_reach ? BraceStatus::infeasible : BraceStatus::no_object_in_reach);
  result.segments = segments;
  return result;
}

}  // namespace

Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task, int segments) {
  return find_brace_in(kMaxRounds, arm, task, segments);
}

Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task) {
  Brace result;
  // Every segment gets one round before any gets more.
  for (const int rounds : {1, kMaxRounds}) {
    for (int segments = 1; segments <= arm->segments() && !result.found(); ++segments) {
      result = find_brace_in(rounds, arm, task, segments);
    }
  }
  return result;
}

Brace replan_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& given,
                   const Brace& before, const VectorX& measured) {
  BraceTask task = completed(*arm, given);
  if (!before.found()) refuse("before", "nothing was found before", "replan what find_brace found");
  if (measured.size() != arm->coordinates()) {
    throw Error(ErrorKind::wrong_length, {.item = "measured"},
                fmt::format("{} angles are given", measured.size()),
                fmt::format("give {}", arm->coordinates()));
  }
  task.turn_lower = task.turn_upper = before.turn;
  // The reserves for the way to the brace may be used now.
  task.friction_fraction = std::max(task.friction_fraction, kReplanFraction);
  task.min_force *= kReplanForce;
  // The smooth piece of the surface that is nearest to the braced point.
  const auto& surface = task.objects[static_cast<std::size_t>(before.object)].surface;
  const auto patches = patches_of(surface);
  const auto patch = std::min_element(
      patches.begin(), patches.end(), [&](const SurfacePatch& a, const SurfacePatch& b) {
        const auto miss = [&](const SurfacePatch& of) {
          const double along = of.axis.dot(before.place);
          return std::max({of.lower - along, along - of.upper, 0.0});
        };
        return miss(a) < miss(b);
      });
  BraceProblem problem = problem_of(*arm, task, before.object, before.point, *patch);
  problem.tolerance = task.tolerance;
  hold_as_measured(problem, *arm, before.turn, measured);
  BraceSearch search(arm, task, Reserve::wished);
  VectorX start(arm->coordinates() + 1 + arm->inputs());
  start << measured, before.turn, before.torque;
  search.attempt(problem, before.object, start);
  start.head(arm->coordinates()) = before.position;
  search.attempt(problem, before.object, start);
  Brace result = search.finish(BraceStatus::infeasible);
  result.segments = before.segments;
  return result;
}

double free_tip_compliance(const std::shared_ptr<const pcc::Arm>& arm, const VectorX& position,
                           double frequency) {
  pcc::ArmEquations equations(arm);
  const VectorX still = VectorX::Zero(arm->coordinates());
  const auto tip = equations.point({.segment = arm->segments() - 1}, position, still);
  const auto& moved = equations.linearise(position, still, still);
  const HeldEquilibrium about{
      moved.by_position, moved.by_rate, moved.by_acceleration, {}, tip.jacobian};
  const TipResponse response = tip_response(about, frequency, Vector3::UnitZ(), 0.0);
  return response.stable ? response.peak_compliance : std::numeric_limits<double>::infinity();
}

}  // namespace sinew::plan
