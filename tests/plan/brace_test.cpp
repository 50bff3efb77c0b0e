// Braces: exact derivatives, the three conditions, what is found and what is not.
#include "sinew/plan/brace.hpp"

#include <chrono>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/plan/brace_program.hpp"
#include "sinew/plan/brace_run.hpp"
#include "sinew/plan/reach.hpp"

#include "tasks.hpp"

namespace sinew::plan {
namespace {

using pcc::testing::make;
using testing::grab;

BraceTask wall() {
  BraceTask task;
  task.goal = {0.10, 0.0, -0.50};
  task.limits = grab().limits;
  task.objects = {{constraint::Plane{{-0.05, 0.0, 0.0}, Vector3::UnitX()}}};
  return task;
}

TEST(Brace, Try) {
  const auto arm = make(pcc::testing::fluidic());
  const auto now = [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
  const auto show = [&](const char* name, const BraceTask& task) {
    double t0 = now();
    const Brace b = find_brace(arm, task);
    double t1 = now();
    std::cout << name << " n " << b.segments << " " << status_name(b.status) << " solved " << b.solved << "/" << b.tried << " unstable "
              << b.unstable << " time " << t1 - t0;
    if (b.found()) { std::cout << " q " << b.position.transpose() << " turn " << b.turn << " tau "
              << b.torque.transpose() << " f " << b.force.transpose() << " place " << b.place.transpose()
              << " C " << b.tip_compliance;
    t0 = now();
    const BraceRun r = run_brace(arm, task, b);
    const BraceRun f = run_free(arm, task);
    std::cout << "\n   run " << status_name(r.status) << " time " << now() - t0 << " contact " << r.contact_time << " slips " << r.slips << " cone " << r.cone_residual << " res " << r.contact_residual << " err " << r.mean_error << " off " << r.offset << " spread " << r.spread << " measured " << r.measured.transpose() << " after " << status_name(r.after.status) << " " << r.after.position.transpose() << " tau " << r.after.torque.transpose() << " fn " << (r.times.size() > 4000 ? r.normal_force.tail(4000).minCoeff() : -1.0) << "\n";
    std::cout << "  free " << status_name(f.status) << " err " << f.mean_error << " off " << f.offset << " spread " << f.spread << "\n";
    }
    std::cout << std::endl;
  };
  BraceTask task = wall();
  task.least_force = 0.15;
  task.objects = {{constraint::Plane{{-0.022, 0.0, 0.0}, Vector3::UnitX()}}};
  show("wall 22", task);
  task.least_force = 0.2;
  task.objects = {{constraint::Plane{{-0.025, 0.0, 0.0}, Vector3::UnitX()}}};
  show("wall", task);
  task.least_force = 0.3;
  show("wall .3", task);
  task.least_force = 0.1;
  for (const double z : {-0.2, -0.28, -0.35}) {
  task.objects = {{constraint::Sphere{{-0.08, 0.0, z}, 0.05}}};
  show("sphere", task);
  task.objects = {{constraint::Capsule{{-0.08, -0.1, z}, {-0.08, 0.1, z}, 0.05}}};
  show("capsule", task);
  }
  task.goal = Vector3(0.1 * std::cos(0.5), 0.1 * std::sin(0.5), -0.5);
  task.objects = {{constraint::Plane{{-0.025 * std::cos(0.5), -0.025 * std::sin(0.5), 0.0}, Vector3(std::cos(0.5), std::sin(0.5), 0.0)}}};
  task.turn_lower = -1; task.turn_upper = 1;
  show("turned", task);
}

/// Jacobian against constraints, Hessian against Jacobian and gradient, everywhere.
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
    EXPECT_LT(((slope_at(more) - slope_at(less)) / (2.0 * h) - hessian.col(i))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-6)
        << i;
  }
}

BraceProblem problem(const pcc::Arm& arm, const constraint::Surface& surface, std::size_t patch) {
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
  result.friction = 0.6;
  result.force_weight = 0.1;
  result.clear_points = skin_points(arm, task);
  result.surfaces = {surface};
  return result;
}

TEST(Brace, DerivativesAreExact) {
  std::mt19937 random(3);
  const std::vector<constraint::Surface> surfaces{
      constraint::Plane{{0.3, 0.1, 0.0}, Vector3(1.0, 2.0, -0.5).normalized()},
      constraint::Sphere{{0.9, 0.4, -0.3}, 0.2},
      constraint::Capsule{{0.9, 0.0, -0.3}, {1.1, 0.5, 0.1}, 0.1}};
  for (const bool spatial : {false, true}) {
    const auto arm = make(spatial ? pcc::testing::mixed() : pcc::testing::fluidic());
    for (const constraint::Surface& surface : surfaces) {
      for (std::size_t patch = 0; patch < patches_of(surface).size(); ++patch) {
        BraceProgram program(arm, problem(*arm, surface, patch));
        check_derivatives(program, random);
      }
    }
  }
}

}  // namespace
}  // namespace sinew::plan
