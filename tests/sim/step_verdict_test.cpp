// The verdict on a step: what a solver says of its residual is checked against the forces.
#include "sinew/step/step_verdict.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/run/run.hpp"
#include "sinew/step/stepper.hpp"

#include "robots.hpp"

namespace sinew::testing {
namespace {

// Evaluates the forces of the present state, and lets the report say that no residual is left, as
// that of a search would whose matrix is singular or whose equations are held wrongly.
void claim_solved(run::Run& run) {
  const double time_step = run.model->step().time_step;
  run.begin_world(time_step);
  run.world.linearise(run.request(time_step));
  run.world.form_rows(run.effort, {});
  run.report = {};
  ASSERT_TRUE(step::is_balanced(run));
}

// Two opposite forces at the tip, in N, at a distance of 20 mm.
void add_couple(run::Run& run, double force) {
  mechanics::Body& beam = *run.world.bodies().all().front();
  const Points& at = beam.positions();
  Points& forces = mechanics::as<mechanics::TakesForces>(beam)->external_forces();
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    if (at(i, 0) < 0.0999 || std::abs(at(i, 1)) < 0.0099) continue;
    forces(i, 0) += at(i, 1) > 0.0 ? force : -force;
  }
}

std::shared_ptr<const model::Model> hanging_beam() {
  return beam({.gravity = Vector3(0.0, 0.0, -9.81)});
}

TEST(StepVerdict, AWeightThatNothingBalancesIsNoEquilibrium) {
  run::Run run(hanging_beam(), 1);
  claim_solved(run);
  EXPECT_FALSE(step::reactions_balance(run));
}

// The forces alone sum to zero here, their moments do not.
TEST(StepVerdict, ACoupleThatNothingBalancesIsNoEquilibrium) {
  run::Run run(beam(), 1);
  claim_solved(run);
  ASSERT_TRUE(step::reactions_balance(run));
  add_couple(run, 0.05);
  claim_solved(run);
  EXPECT_FALSE(step::reactions_balance(run));
}

// An effort that acts on the robot after its equilibrium was found.
TEST(StepVerdict, ATensionThatNothingBalancesIsNoEquilibrium) {
  run::Run run(hanging_beam(), 1);
  step::Stepper(run).step();
  run.effort[static_cast<std::size_t>(run.model->actuators().front().row)] = 2.0;
  claim_solved(run);
  EXPECT_FALSE(step::reactions_balance(run));
}

TEST(StepVerdict, TheReactionsOfAnEquilibriumBalanceItsLoads) {
  run::Run run(hanging_beam(), 1);
  add_couple(run, 0.05);
  run.actuation.command(0, tension(1.0));
  for (int k = 0; k < 3; ++k) step::Stepper(run).step();
  ASSERT_EQ(run.report.status, run::StepStatus::solved);
  claim_solved(run);
  EXPECT_TRUE(step::reactions_balance(run));
}

// A residual that a step reports is not hidden, so it excuses the sum of the forces.
TEST(StepVerdict, AReportedResidualExplainsForcesThatDoNotBalance) {
  run::Run run(hanging_beam(), 1);
  claim_solved(run);
  run.report.residual = run.world.bodies().residual(run.effort);
  EXPECT_TRUE(step::reactions_balance(run));
}

}  // namespace
}  // namespace sinew::testing
