#include "sinew/plan/brace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/plan/brace_program.hpp"
#include "sinew/plan/reach.hpp"
#include "sinew/plan/uniform.hpp"

namespace sinew::plan {

namespace {

// What the solver leaves of its constraints, and what is asked of an equilibrium.
constexpr double kGapTolerance = 1e-6;  // m
constexpr double kPlanShare = 0.4;      // of the tip's tolerance
constexpr double kReplanShare = 0.95, kReplanForce = 0.5;
constexpr SolverSettings kSolver{.tolerance = 1e-9, .max_iterations = 80, .max_time = 5.0};

[[noreturn]] void refuse(const char* item, const std::string& what, const char* remedy) {
  throw Error(ErrorKind::out_of_range, {.item = item}, what, remedy);
}

/// How an equilibrium answers a force on the tip.
struct Answer {
  bool stable = false;
  double compliance = 0.0;  // m/N
  int mobility = 0;
};

/// @param stiffness second derivative of the potential, the brace's force held.
/// @param held (3, n) Jacobian of a point that does not move; empty: none. @param tip (3, n).
Answer answer_of(const MatrixX& stiffness, const MatrixX& held, const MatrixX& tip) {
  const Eigen::Index n = stiffness.rows();
  MatrixX free = MatrixX::Identity(n, n);
  if (held.rows() > 0) {
    const Eigen::JacobiSVD<MatrixX> svd(held, Eigen::ComputeFullV);
    const Eigen::Index rank =
        (svd.singularValues().array() > 1e-9 * std::max(svd.singularValues()[0], 1e-3)).count();
    free = svd.matrixV().rightCols(n - rank);
  }
  if (free.cols() == 0) return {true, 0.0, 0};
  MatrixX reduced = free.transpose() * stiffness * free;
  reduced = 0.5 * (reduced + reduced.transpose().eval());
  const Eigen::SelfAdjointEigenSolver<MatrixX> spectrum(reduced);
  const MatrixX moved = tip * free;
  const Eigen::JacobiSVD<MatrixX> reach(moved);
  Answer result;
  result.mobility = static_cast<int>((reach.singularValues().array() > 1e-6).count());
  result.stable = spectrum.eigenvalues()[0] > 0.0;
  if (!result.stable) return result;
  const Matrix3 compliance = moved * reduced.inverse() * moved.transpose();
  result.compliance =
      Eigen::SelfAdjointEigenSolver<Matrix3>(compliance, Eigen::EigenvaluesOnly).eigenvalues()[2];
  return result;
}

/// Tries candidates and keeps the best.
class Search {
 public:
  Search(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task)
      : arm_(arm), task_(task), equations_(arm), points_(arm), draw_(task.seed) {}

  /// @param problem of a candidate. @param object which. @param start of x without the force.
  void attempt(const BraceProblem& problem, int object, const VectorX& start) {
    BraceProgram program(arm_, problem);
    VectorX x(program.variables());
    x.head(start.size()) = start;
    // The force's guess: the least, straight out of the object.
    const Points ends = equations_.endpoints(start.head(arm_->coordinates()));
    const Vector3 near = ends.row(problem.point.segment);
    const Vector3 normal =
        constraint::distance(task_.objects[static_cast<std::size_t>(object)].surface, near).normal;
    x.tail<3>() = 2.0 * problem.least_force * normal;
    ++best_.tried;
    const ProgramResult found = solve(program, {x, {}, {}, {}}, kSolver);
    if (found.status != Status::solved && found.status != Status::acceptable) return;
    ++best_.solved;
    keep(program, object, found);
  }

  VectorX random_start(const BraceProblem& problem) {
    const Limits& limits = problem.limits;
    VectorX start(arm_->coordinates() + 1 + arm_->inputs());
    Eigen::Index at = 0;
    for (Eigen::Index i = 0; i < arm_->coordinates(); ++i) {
      start[at++] = draw_(std::max(limits.angle_lower[i], -std::numbers::pi / 2.0),
                          std::min(limits.angle_upper[i], std::numbers::pi / 2.0));
    }
    start[at++] = draw_(problem.turn_lower, problem.turn_upper);
    for (Eigen::Index u = 0; u < arm_->inputs(); ++u) {
      start[at++] = draw_(limits.torque_lower[u], limits.torque_upper[u]);
    }
    return start;
  }

  Brace finish(BraceStatus without) {
    if (!best_.found()) best_.status = without;
    return best_;
  }

 private:
  void keep(BraceProgram& program, int object, const ProgramResult& result) {
    const BraceProblem& problem = program.problem();
    const VectorX& x = result.point.x;
    const int n = arm_->coordinates();
    VectorX values;
    program.constraints(x, values);
    Brace brace;
    brace.status = BraceStatus::braced;
    brace.segments = problem.point.segment + 1;
    brace.object = object;
    brace.point = problem.point;
    brace.position = x.head(n);
    brace.turn = x[program.turn_index()];
    brace.torque = x.segment(program.torque_index(), arm_->inputs());
    brace.balance = values.head(n).cwiseAbs().maxCoeff();
    const Vector3 base = arm_->settings().base;
    const Matrix3 turn =
        Eigen::AngleAxisd(brace.turn, arm_->settings().frame.col(2)).toRotationMatrix();
    const VectorX still = VectorX::Zero(n);
    const auto at =
        points_.positions(brace.position, {{.segment = arm_->segments() - 1}, problem.point});
    brace.tip = base + turn * (at[0].value - base);
    brace.place = base + turn * (at[1].value - base);
    brace.tip_error = (brace.tip - task_.goal).norm();
    const Vector3 force = x.tail<3>();
    brace.force = turn * force;
    const BraceObject& on = task_.objects[static_cast<std::size_t>(object)];
    const constraint::SurfaceDistance touch = constraint::distance(on.surface, brace.place);
    brace.normal = touch.normal;
    brace.gap = touch.gap;
    brace.normal_force = touch.normal.dot(brace.force);
    brace.friction_force = (brace.force - brace.normal_force * touch.normal).norm();
    const Eigen::Index clear =
        static_cast<Eigen::Index>(problem.clear_points.size() * problem.surfaces.size());
    brace.clearance = clear > 0 ? values.tail(clear).minCoeff() : kNoBound;

    MatrixX stiffness = equations_.linearise(brace.position, still, still).by_position;
    for (std::size_t k = 0; k < 3; ++k) {
      stiffness -= force[static_cast<Eigen::Index>(k)] * at[1].hessian[k];
    }
    const Answer answer = answer_of(stiffness, at[1].jacobian, at[0].jacobian);
    if (!answer.stable) {
      ++best_.unstable;
      return;
    }
    brace.tip_compliance = answer.compliance;
    brace.mobility = answer.mobility;
    // With measured angles the point is where it was measured to be.
    brace.conditions = {check_friction(brace.normal_force, brace.friction_force, on.friction),
                        check_stiffness(on.stiffness, task_.arm, task_.stiffness_ratio),
                        check_kinematics(problem.touches ? brace.gap : 0.0, brace.clearance,
                                         brace.tip_error - task_.tolerance, kGapTolerance)};
    for (const BraceCondition& condition : brace.conditions) {
      if (condition.verdict != BraceCondition::Verdict::holds) return;
    }
    if (best_.found() && brace.tip_compliance >= best_.tip_compliance) return;
    brace.solved = best_.solved;
    brace.unstable = best_.unstable;
    brace.tried = best_.tried;
    best_ = brace;
  }

  std::shared_ptr<const pcc::Arm> arm_;
  const BraceTask& task_;
  pcc::ArmEquations equations_;
  PointDerivatives points_;
  Uniform draw_;
  Brace best_;
};

bool same_point(const pcc::ArmPoint& a, const pcc::ArmPoint& b) {
  return a.segment == b.segment && a.fraction == b.fraction && a.x == b.x && a.y == b.y;
}

/// Whether the first n segments could be long enough to touch.
bool in_reach(const pcc::Arm& arm, const constraint::Surface& surface, int segments) {
  double length = arm.settings().radius;
  for (int n = 0; n < segments; ++n) {
    const pcc::Segment& segment = arm.settings().segments[static_cast<std::size_t>(n)];
    if (segment.extensible) return true;
    length += segment.length + segment.dead_length;
  }
  return constraint::distance(surface, arm.settings().base).gap <= length;
}

/// The candidate's program. @param held segments before this keep their angles and their distance.
BraceProblem problem_of(const pcc::Arm& arm, const BraceTask& task, int object,
                        const pcc::ArmPoint& point, const SurfacePatch& patch, int held) {
  const BraceObject& on = task.objects[static_cast<std::size_t>(object)];
  BraceProblem problem;
  problem.limits = task.limits;
  problem.turn_lower = task.turn_lower;
  problem.turn_upper = task.turn_upper;
  problem.goal = task.goal;
  problem.tolerance = held == 0 ? kPlanShare * task.tolerance : task.tolerance;
  problem.point = point;
  problem.patch = patch;
  problem.touches = held == 0;
  problem.friction = task.friction_share * on.friction.least;
  problem.least_force = task.least_force;
  problem.most_force = task.most_force;
  problem.force_weight = task.force_weight;
  for (const pcc::ArmPoint& other : skin_points(arm, task)) {
    if (other.segment >= held && !same_point(other, point)) problem.clear_points.push_back(other);
  }
  problem.clearance = held == 0 ? task.clearance : 0.0;
  for (const BraceObject& other : task.objects) problem.surfaces.push_back(other.surface);
  return problem;
}

}  // namespace

BraceTask completed(const pcc::Arm& arm, BraceTask task) {
  Task common;
  common.goal = {task.goal, task.tolerance, kNoBound};
  static_cast<void>(completed(arm, common));  // the goal's checks
  task.limits = completed_limits(arm, task.limits);
  for (BraceObject& object : task.objects) {
    object.surface = constraint::checked(object.surface);
    if (!(object.friction.least >= 0.0) || !(object.friction.most >= object.friction.least)) {
      refuse("object.friction",
             fmt::format("{:g} to {:g}", object.friction.least, object.friction.most),
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
  if (!(task.friction_share > 0.0) || task.friction_share > 1.0) {
    refuse("friction_share", fmt::format("{:g}", task.friction_share), "give above 0, up to 1");
  }
  if (!(task.clearance >= 0.0)) {
    refuse("clearance", fmt::format("{:g} m", task.clearance), "give zero or more");
  }
  if (!(task.least_force > 0.0)) {
    refuse("least_force", fmt::format("{:g} N", task.least_force), "give a positive force");
  }
  if (!(task.most_force >= task.least_force)) {
    throw Error(ErrorKind::contradictory_limits, {.item = "most_force"},
                fmt::format("{:g} N is below the least, {:g} N", task.most_force, task.least_force),
                "swap them");
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

std::vector<pcc::ArmPoint> skin_points(const pcc::Arm& arm, const BraceTask& task) {
  std::vector<pcc::ArmPoint> points;
  const double radius = arm.settings().radius;
  for (int segment = 0; segment < arm.segments(); ++segment) {
    for (const double fraction : task.fractions) {
      for (int side = 0; side < task.sides; ++side) {
        const double angle = 2.0 * std::numbers::pi * side / task.sides;
        points.push_back({.segment = segment,
                          .fraction = fraction,
                          .x = radius * std::cos(angle),
                          .y = radius * std::sin(angle)});
      }
    }
  }
  return points;
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

Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& given, int segments) {
  const BraceTask task = completed(*arm, given);
  if (segments < 1 || segments > arm->segments()) {
    refuse("segments", fmt::format("{}", segments), "give one of the arm's, counted from 1");
  }
  Search search(arm, task);
  const auto objects = static_cast<int>(task.objects.size());
  const auto surface = [&](int object) -> const constraint::Surface& {
    return task.objects[static_cast<std::size_t>(object)].surface;
  };
  bool any_in_reach = objects == 0;
  std::optional<VectorX> nearest;
  for (int object = 0; object < objects; ++object) {
    any_in_reach = any_in_reach || in_reach(*arm, surface(object), arm->segments());
    if (!in_reach(*arm, surface(object), segments)) continue;
    for (const pcc::ArmPoint& point : skin_points(*arm, task)) {
      if (point.segment != segments - 1) continue;
      for (const SurfacePatch& patch : patches_of(surface(object))) {
        const BraceProblem problem = problem_of(*arm, task, object, point, patch, 0);
        for (int start = 0; start < task.starts; ++start) {
          VectorX guess = search.random_start(problem);
          if (start == 0) {
            // From where the arm gets nearest to the goal by itself.
            if (!nearest) {
              const NearestReach reach = nearest_reach(arm, task.limits, task.goal, 5, task.seed);
              nearest = VectorX::Zero(guess.size());
              if (reach.found) nearest->head(arm->coordinates()) = reach.position;
              if (reach.found) nearest->tail(arm->inputs()) = reach.torque;
            }
            const double turn = guess[arm->coordinates()];
            guess = *nearest;
            guess[arm->coordinates()] = turn;
          }
          search.attempt(problem, object, guess);
        }
      }
    }
  }
  Brace result =
      search.finish(any_in_reach ? BraceStatus::infeasible : BraceStatus::no_object_in_reach);
  result.segments = segments;
  return result;
}

Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task) {
  Brace result;
  for (int segments = 1; segments <= arm->segments() && !result.found(); ++segments) {
    result = find_brace(arm, task, segments);
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
  const int end =
      before.segments < arm->segments() ? arm->first(before.segments) : arm->coordinates();
  task.limits.angle_lower.head(end) = measured.head(end);
  task.limits.angle_upper.head(end) = measured.head(end);
  task.turn_lower = task.turn_upper = before.turn;
  // What lay in reserve for the way there may be used now.
  task.friction_share = std::max(task.friction_share, kReplanShare);
  task.least_force *= kReplanForce;
  Search search(arm, task);
  // The normal at the braced point: of the piece that it is nearest to being on.
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
  const BraceProblem problem =
      problem_of(*arm, task, before.object, before.point, *patch, before.segments);
  VectorX start(arm->coordinates() + 1 + arm->inputs());
  start << measured, before.turn, before.torque;
  start.segment(end, arm->coordinates() - end) = before.position.tail(arm->coordinates() - end);
  search.attempt(problem, before.object, start);
  start.segment(end, arm->coordinates() - end) = measured.tail(arm->coordinates() - end);
  search.attempt(problem, before.object, start);
  Brace result = search.finish(BraceStatus::infeasible);
  result.segments = before.segments;
  return result;
}

double free_tip_compliance(const std::shared_ptr<const pcc::Arm>& arm, const VectorX& position) {
  pcc::ArmEquations equations(arm);
  const VectorX still = VectorX::Zero(arm->coordinates());
  const auto tip = equations.point({.segment = arm->segments() - 1}, position, still);
  const Answer answer = answer_of(equations.linearise(position, still, still).by_position,
                                  MatrixX(0, arm->coordinates()), tip.jacobian);
  return answer.stable ? answer.compliance : std::numeric_limits<double>::infinity();
}

}  // namespace sinew::plan
