// Braces: exact derivatives, the three conditions, and results of the search.
#include "sinew/plan/brace.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/plan/brace_program.hpp"
#include "sinew/plan/brace_response.hpp"
#include "sinew/plan/brace_run.hpp"
#include "sinew/plan/reach.hpp"

#include "tasks.hpp"

namespace sinew::plan {
namespace {

using pcc::testing::make;
using testing::grab;

/// A bar perpendicular to the arm's plane, near its last segment.
BraceTask bar() {
  BraceTask task;
  task.goal = {0.05, 0.0, -0.53};
  task.limits = grab().limits;
  task.fractions = {0.25};
  task.objects = {{constraint::Capsule{{-0.077, -0.1, -0.445}, {-0.077, 0.1, -0.445}, 0.05}}};
  return task;
}

/// Compares the Jacobian with differences of constraints, and the Hessian with those of Jacobian
/// and gradient.
void check_derivatives(BraceProgram& program, std::mt19937& random) {
  const int size = program.variables();
  const Eigen::Index rows = program.constraint_bounds().lower.size();
  const VectorX x = pcc::testing::random_vector(random, size, 0.7);
  const VectorX multipliers = pcc::testing::random_vector(random, rows, 1.0);
  const auto jacobian_at = [&](const VectorX& at) {
    MatrixX result(rows, size);
    std::vector<double> values(program.jacobian_pattern().size());
    program.jacobian(at, values.data());
    for (std::size_t k = 0; k < values.size(); ++k) {
      result(program.jacobian_pattern()[k].row, program.jacobian_pattern()[k].column) = values[k];
    }
    return result;
  };
  const double factor = 0.6, h = 1e-6;
  const auto slope_at = [&](const VectorX& at) {
    VectorX gradient;
    program.gradient(at, gradient);
    return VectorX(factor * gradient + jacobian_at(at).transpose() * multipliers);
  };
  const MatrixX jacobian = jacobian_at(x);
  std::vector<double> values(program.hessian_pattern().size());
  program.hessian(x, factor, multipliers, values.data());
  MatrixX hessian = MatrixX::Zero(size, size);
  for (std::size_t k = 0; k < values.size(); ++k) {
    hessian(program.hessian_pattern()[k].row, program.hessian_pattern()[k].column) = values[k];
    hessian(program.hessian_pattern()[k].column, program.hessian_pattern()[k].row) = values[k];
  }
  VectorX gradient;
  program.gradient(x, gradient);
  for (int i = 0; i < size; ++i) {
    VectorX more = x, less = x, up, down;
    more[i] += h;
    less[i] -= h;
    program.constraints(more, up);
    program.constraints(less, down);
    EXPECT_LT(((up - down) / (2.0 * h) - jacobian.col(i)).cwiseAbs().maxCoeff(), 1e-7) << i;
    EXPECT_NEAR((program.objective(more) - program.objective(less)) / (2.0 * h), gradient[i], 1e-6);
    EXPECT_LT(
        ((slope_at(more) - slope_at(less)) / (2.0 * h) - hessian.col(i)).cwiseAbs().maxCoeff(),
        1e-6)
        << i;
  }
}

BraceProblem problem(const pcc::Arm& arm, const constraint::SmoothSurface& surface,
                     std::size_t patch) {
  BraceTask task;
  task.limits.torque_upper = VectorX::Constant(arm.inputs(), 0.2);
  task.limits.torque_lower = -task.limits.torque_upper;
  BraceProblem result;
  result.limits = completed_limits(arm, task.limits);
  result.turn_lower = -1.0;
  result.turn_upper = 1.0;
  result.goal = {0.1, 0.05, -0.3};
  result.point = {.segment = arm.segments() - 2, .fraction = 0.7, .x = 0.01, .y = -0.015};
  result.patch = patches_of(surface)[patch];
  result.tolerance = 0.3;  // so that all terms have similar size
  result.friction = 0.6;
  result.reserve = 0.4;
  result.force_weight = 0.1;
  result.clear_points = skin_points(arm, task);
  result.surfaces = {surface};
  return result;
}

TEST(Brace, DerivativesAreExact) {
  std::mt19937 random(3);
  const std::vector<constraint::SmoothSurface> surfaces{
      constraint::Plane{{0.3, 0.1, 0.0}, Vector3(1.0, 2.0, -0.5).normalized()},
      constraint::Sphere{{0.9, 0.4, -0.3}, 0.2},
      constraint::Capsule{{0.9, 0.0, -0.3}, {1.1, 0.5, 0.1}, 0.1}};
  for (const bool spatial : {false, true}) {
    const auto arm = make(spatial ? pcc::testing::mixed() : pcc::testing::fluidic());
    for (const constraint::SmoothSurface& surface : surfaces) {
      for (std::size_t patch = 0; patch < patches_of(surface).size(); ++patch) {
        BraceProblem of = problem(*arm, surface, patch);
        BraceProgram program(arm, of);
        check_derivatives(program, random);
        of.held = Matrix3::Identity().leftCols(2);
        of.place = {0.2, 0.1, 0.3};
        BraceProgram held(arm, of);
        check_derivatives(held, random);
      }
    }
  }
}

TEST(Brace, ConditionsHaveNamedRanges) {
  using Verdict = BraceCondition::Verdict;
  EXPECT_EQ(check_friction(1.0, 0.04, friction_range("coated-rigid")).verdict, Verdict::holds);
  EXPECT_EQ(check_friction(1.0, 0.1, kCoatedRigid).verdict, Verdict::uncertain);
  EXPECT_EQ(check_friction(1.0, 0.3, kCoatedRigid).verdict, Verdict::violated);
  EXPECT_EQ(check_friction(1.0, 0.3, friction_range("silicone-on-steel")).verdict, Verdict::holds);
  EXPECT_EQ(check_friction(0.0, 0.0, kSiliconeOnSteel).verdict, Verdict::violated);
  EXPECT_THROW(friction_range("ice"), Error);
  EXPECT_EQ(check_stiffness(kRigid, kSoftArm, 10.0).verdict, Verdict::holds);
  EXPECT_EQ(check_stiffness({1e5, 1.0}, kSoftArm, 10.0).verdict, Verdict::violated);
  EXPECT_DOUBLE_EQ(check_stiffness({1e5, 1.0}, kSoftArm, 10.0).value, 5.0);
  EXPECT_EQ(check_kinematics(1e-8, 0.1, -0.001, 1e-6).verdict, Verdict::holds);
  EXPECT_EQ(check_kinematics(0.0, -0.01, 0.0, 1e-6).verdict, Verdict::violated);
}

TEST(Brace, IsAnEquilibriumWithinItsCone) {
  const auto arm = make(pcc::testing::fluidic());
  const BraceTask task = bar();
  const Brace brace = find_brace(arm, task, 4);
  ASSERT_TRUE(brace.found());
  // Checks the balance with the equations of the arm and the Jacobian of the point.
  pcc::ArmEquations equations(arm);
  const VectorX still = VectorX::Zero(4);
  const MatrixX jacobian = equations.point(brace.point, brace.position, still).jacobian;
  EXPECT_LT((equations.residual(brace.position, still, still) - brace.torque -
             jacobian.transpose() * brace.force)
                .norm(),
            1e-8);
  EXPECT_LT(std::abs(constraint::distance(task.objects[0].surface, brace.place).gap), 1e-8);
  EXPECT_GE(brace.normal_force, task.min_force - 1e-8);
  EXPECT_GE(brace.hold_force, task.hold_force);
  EXPECT_LE(brace.conditions[0].value, 0.9 * 0.6 + 1e-3) << "as much of friction as may be needed";
  EXPECT_LE(brace.tip_error, task.tolerance);
  EXPECT_GE(brace.clearance, task.clearance - 1e-8);
  EXPECT_TRUE((brace.torque.cwiseAbs().array() <= task.limits.torque_upper.array() + 1e-8).all());
  EXPECT_LT(brace.tip_compliance, 0.2 * free_tip_compliance(arm, brace.position));
  EXPECT_LT(brace.peak_compliance,
            0.2 * free_tip_compliance(arm, brace.position, task.hold_frequency));
  // It would not stick with the friction of a coated rigid surface.
  BraceTask coated = task;
  coated.objects[0].friction = kCoatedRigid;
  const Brace none = find_brace(arm, coated, 4);
  EXPECT_EQ(none.status, BraceStatus::infeasible);
  ASSERT_EQ(none.object, 0) << "what came nearest is told";
  EXPECT_EQ(none.conditions[0].verdict, BraceCondition::Verdict::violated);
  EXPECT_LT(none.hold_force, task.hold_force);
}

/// Compares with the saddle-point system [A, -J^T; J, 0], which the null space of J eliminates.
TEST(Brace, AnswersForcesOnTheTip) {
  std::mt19937 random(5);
  const int n = 6;
  HeldEquilibrium of;
  const MatrixX root = MatrixX::NullaryExpr(
      n, n, [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); });
  of.stiffness = root * root.transpose() + 0.5 * MatrixX::Identity(n, n);
  of.mass = 0.01 * MatrixX::Identity(n, n) + 0.002 * root.transpose() * root;
  of.damping = 0.05 * MatrixX::Identity(n, n);
  of.held = root.topRows(3);
  of.tip = root.bottomRows(3);
  const Vector3 normal = Vector3(0.3, -0.2, 0.9).normalized();
  const double friction = 0.6;
  for (const double frequency : {0.0, 3.0}) {
    double gain = 0.0, compliance = 0.0, rest = 0.0;
    for (int k = 0; k <= 512; ++k) {
      const double omega = 2.0 * std::numbers::pi * frequency * k / 512.0;
      // The unknowns are real and imaginary motions, then real and imaginary forces.
      MatrixX saddle = MatrixX::Zero(2 * n + 6, 2 * n + 6);
      const MatrixX in_phase = of.stiffness - omega * omega * of.mass, lag = omega * of.damping;
      saddle.topLeftCorner(2 * n, 2 * n) << in_phase, -lag, lag, in_phase;
      for (const int part : {0, 1}) {
        saddle.block(part * n, 2 * n + 3 * part, n, 3) = -of.held.transpose();
        saddle.block(2 * n + 3 * part, part * n, 3, n) = of.held;
      }
      MatrixX load = MatrixX::Zero(2 * n + 6, 3);
      load.topRows(n) = of.tip.transpose();
      const MatrixX answer = linalg::solve(saddle, load);
      const MatrixX real = of.tip * answer.topRows(n), imaginary = of.tip * answer.middleRows(n, n);
      // The maximum of |(R + i S) a|^2 over complex a is an eigenvalue of the squared real form.
      MatrixX whole(6, 6);
      whole << real, -imaginary, imaginary, real;
      compliance = std::max(compliance,
                            std::sqrt(linalg::symmetric_eigenvalues(whole.transpose() * whole)[5]));
      if (k == 0) rest = compliance;
      const Vector3 first = normal.unitOrthogonal(), second = normal.cross(first);
      for (int d = 0; d < 720; ++d) {
        const double angle = 2.0 * std::numbers::pi * d / 720.0;
        const Vector3 u = std::cos(angle) * first + std::sin(angle) * second - friction * normal;
        gain = std::max(gain, std::hypot((u.transpose() * answer.middleRows(2 * n, 3)).norm(),
                                         (u.transpose() * answer.bottomRows(3)).norm()));
      }
    }
    const TipResponse response = tip_response(of, frequency, normal, friction);
    ASSERT_TRUE(response.stable);
    EXPECT_NEAR(response.compliance, rest, 1e-9 * rest);
    EXPECT_NEAR(response.peak_compliance, compliance, 0.01 * compliance);
    EXPECT_NEAR(response.friction_gain, gain, 0.01 * gain);
    EXPECT_EQ(response.mobility, 3);
  }
  of.stiffness -= 100.0 * MatrixX::Identity(n, n);
  EXPECT_FALSE(tip_response(of, 0.0, normal, friction).stable);
}

TEST(Brace, HoldsInContactAndSteadiesTheTip) {
  const auto arm = make(pcc::testing::fluidic());
  const BraceTask task = bar();
  const Brace brace = find_brace(arm, task, 4);
  ASSERT_TRUE(brace.found());
  BraceRunSettings settings;
  settings.hold = 1.0;
  settings.disturbance.force = 0.0;
  const BraceRun still = run_brace(arm, task, brace, settings);
  EXPECT_EQ(still.status, BraceRunStatus::held) << status_name(still.status);
  EXPECT_GT(still.contact_time, 0.0);
  EXPECT_LT(still.cone_residual, 1e-9);
  EXPECT_LT(still.offset, task.tolerance + 1e-3);
  EXPECT_LT(still.spread, 1e-4);
  ASSERT_TRUE(still.after.found());
  EXPECT_NEAR(still.normal_force[still.normal_force.size() - 1], still.after.normal_force,
              0.1 * still.after.normal_force);

  settings.hold = 3.0;
  settings.disturbance.force = 0.01;
  const BraceRun braced = run_brace(arm, task, brace, settings);
  const BraceRun bare = run_free(arm, task, settings);
  EXPECT_LT(braced.spread, 0.2 * bare.spread);
  EXPECT_LT(braced.mean_error, 0.5 * bare.mean_error);
  EXPECT_GT(braced.spread, 1e-5);
  // In the replanned brace, the braced point is at the same position.
  pcc::ArmEquations equations(arm);
  const VectorX still_arm = VectorX::Zero(4);
  EXPECT_LT((equations.point(brace.point, braced.measured, still_arm).position -
             equations.point(brace.point, braced.after.position, still_arm).position)
                .norm(),
            1e-8);

  // It sticks up to its hold force (a sine along x and one along z), but not far beyond.
  settings.disturbance.sines = 1;
  settings.disturbance.force = 0.45 * still.after.hold_force;
  EXPECT_EQ(run_brace(arm, task, brace, settings).slips, 0);
  settings.disturbance.force = 3.0 * still.after.hold_force;
  EXPECT_GT(run_brace(arm, task, brace, settings).slips, 0);
}

TEST(Brace, WithoutAnObjectThereIsNone) {
  const auto arm = make(pcc::testing::fluidic());
  BraceTask task = bar();
  task.objects.clear();
  EXPECT_EQ(find_brace(arm, task).status, BraceStatus::infeasible);
  EXPECT_EQ(find_brace(arm, task, 2).tried, 0);
  task.objects = {{constraint::Sphere{{2.0, 0.0, 0.0}, 0.1}}};
  const Brace far = find_brace(arm, task);
  EXPECT_EQ(far.status, BraceStatus::no_object_in_reach);
  EXPECT_EQ(run_brace(arm, task, far).status, BraceRunStatus::not_planned);
}

TEST(Brace, RefusesWhatMakesNoSense) {
  const auto arm = make(pcc::testing::fluidic());
  const auto refused = [&](const auto& change) {
    BraceTask task = bar();
    change(task);
    EXPECT_THROW(completed(*arm, task), Error);
  };
  refused([](BraceTask& task) { task.goal = {1.0, 0.0, 0.0}; });
  refused([](BraceTask& task) { task.fractions = {0.0}; });
  refused([](BraceTask& task) { task.min_force = 0.0; });
  refused([](BraceTask& task) { task.hold_force = -0.01; });
  refused([](BraceTask& task) { task.along = 0; });
  refused([](BraceTask& task) { task.max_force = 0.01; });
  refused([](BraceTask& task) { task.turn_lower = 1.0; });
  refused([](BraceTask& task) { task.objects[0].friction = {"given", 0.5, 0.2}; });
  refused([](BraceTask& task) { task.objects[0].surface = constraint::Sphere{}; });
  EXPECT_THROW(find_brace(arm, bar(), 5), Error);
  pcc::ArmSettings tilted = pcc::testing::fluidic();
  tilted.gravity = {3.0, 0.0, -9.0};
  BraceTask task = bar();
  task.turn_upper = 1.0;
  EXPECT_THROW(completed(*make(tilted), task), Error);
}

/// A rotating base moves the arm's plane to the goal and the bar.
TEST(Brace, TurnsTheBase) {
  const auto arm = make(pcc::testing::fluidic());
  const Matrix3 turn = Eigen::AngleAxisd(0.5, Vector3::UnitZ()).toRotationMatrix();
  BraceTask task = bar();
  task.goal = turn * task.goal;
  task.objects = {{constraint::Capsule{turn * Vector3(-0.077, -0.1, -0.445),
                                       turn * Vector3(-0.077, 0.1, -0.445), 0.05}}};
  task.turn_lower = -1.0;
  task.turn_upper = 1.0;
  const Brace brace = find_brace(arm, task, 4);
  ASSERT_TRUE(brace.found());
  EXPECT_NEAR(brace.turn, -0.5, 0.1);  // the base's axis points down
}

}  // namespace
}  // namespace sinew::plan
