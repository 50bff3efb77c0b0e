#include "sinew/control/inverse_controller.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/sim/simulation.hpp"

#include "../sim/robots.hpp"
#include "support/error_kind.hpp"

namespace sinew::control {
namespace {

using sim::Simulation;
using sinew::testing::beam;
using sinew::testing::BeamOptions;

TargetSettings to(const Vector3& place) {
  return {.tasks = {{0, Target::fixed(place), {1.0}}}, .actuators = {}};
}

// A reachable tip position, from two given tensions.
Vector3 reachable(std::shared_ptr<const model::Model> model) {
  Simulation simulation(std::move(model));
  simulation.command(0, sinew::testing::tension(1.5));
  simulation.command(1, sinew::testing::tension(0.8));
  simulation.solve_static();
  return simulation.effector_value(0);
}

TEST(InverseController, BringsTheTipToAPlaceThatItCanReach) {
  const auto model = beam();
  const Vector3 goal = reachable(model);
  Simulation simulation(model);
  InverseController controller(simulation, to(goal));
  for (int i = 0; i < 300; ++i) controller.step();
  EXPECT_EQ(controller.status(), ControllerStatus::on_target);
  EXPECT_LT(controller.error(), 5e-5);
  EXPECT_NEAR(controller.error(), (simulation.effector_value(0) - goal).norm(), 1e-15);
  EXPECT_LT(simulation.report().relative_residual, 1e-6);
  for (int k = 0; k < 4; ++k) EXPECT_GE(simulation.actuator(k).effort, 0.0);
}

TEST(InverseController, PublishedRegularisationBiasesAndASmallerOneLess) {
  const auto model = beam();
  const Vector3 goal = reachable(model);
  const auto bias = [&](Regularisation regularisation, double epsilon) {
    Simulation simulation(model);
    InverseController controller(simulation, to(goal),
                                 {.regularisation = regularisation, .epsilon = epsilon});
    for (int i = 0; i < 400; ++i) controller.step();
    return controller.error();
  };
  const double published = bias(Regularisation::effort, 1e-3);
  const double smaller = bias(Regularisation::effort, 1e-5);
  EXPECT_GT(published, 5.0 * smaller);
  EXPECT_LT(bias(Regularisation::change, 1e-3), 0.1 * published);
}

TEST(InverseController, MeetsAJumpWithinTheRateLimits) {
  BeamOptions options;
  options.displacement = {.rate = 0.02};
  const auto model = beam(options);
  const Vector3 goal = reachable(model);
  Simulation simulation(model);
  InverseController controller(simulation, to(goal));
  std::vector<double> before(4, 0.0);
  bool limited = false;
  for (int i = 0; i < 400; ++i) {
    controller.step();
    limited = limited || controller.status() == ControllerStatus::rate_limited;
    for (int k = 0; k < 4; ++k) {
      const double moved =
          std::abs(simulation.actuator(k).motion - before[static_cast<std::size_t>(k)]);
      EXPECT_LE(moved, 0.0002 * 1.05) << "step " << i;  // error of the linearisation
      before[static_cast<std::size_t>(k)] = simulation.actuator(k).motion;
    }
  }
  EXPECT_TRUE(limited);
  EXPECT_EQ(controller.status(), ControllerStatus::on_target);
  EXPECT_LT(controller.error(), 1e-4);
}

TEST(InverseController, HoldsStillWhereTheTargetIsOutOfReach) {
  BeamOptions options;
  options.tension = {.min = 0.0, .max = 2.0};
  Simulation simulation(beam(options));
  InverseController controller(simulation, to({0.05, 0.08, 0.06}));
  for (int i = 0; i < 500; ++i) controller.step();
  EXPECT_EQ(controller.status(), ControllerStatus::out_of_reach);
  const double distance = controller.error();
  double largest = 0.0, smallest = 1.0;
  for (int i = 0; i < 100; ++i) {
    controller.step();
    EXPECT_EQ(controller.status(), ControllerStatus::out_of_reach);
    largest = std::max(largest, controller.error());
    smallest = std::min(smallest, controller.error());
  }
  EXPECT_LT(largest - smallest, 1e-7) << "no chatter";
  EXPECT_NEAR(largest, distance, 1e-4);
  EXPECT_LE(simulation.actuator(0).effort, 2.0);
}

TEST(StepDamping, GrowsWhereTheLinearisationMisleadsAndShrinksWhereItHolds) {
  StepDamping damping;
  EXPECT_EQ(damping.value(), 1.0);
  damping.review(1.0, 0.5, 0.5, 1e-12);  // as predicted: nothing to reduce
  EXPECT_EQ(damping.value(), 1.0);
  damping.review(1.0, 0.5, 1.2, 1e-12);  // worse than before
  EXPECT_EQ(damping.value(), 4.0);
  damping.review(1.0, 0.5, 0.9, 1e-12);  // a fifth of the predicted decrease
  EXPECT_EQ(damping.value(), 16.0);
  damping.review(1.0, 0.5, 0.7, 1e-12);  // in between
  EXPECT_EQ(damping.value(), 16.0);
  damping.review(1.0, 0.5, 0.55, 1e-12);
  EXPECT_EQ(damping.value(), 8.0);
  damping.review(1.0, 1.0, 1.0, 1e-12);  // at rest: no information
  EXPECT_EQ(damping.value(), 8.0);
  damping.reject();
  EXPECT_EQ(damping.value(), 128.0);
  for (int k = 0; k < 10; ++k) damping.reject();
  EXPECT_EQ(damping.value(), 1e6);
  damping.set(1.0);
  EXPECT_EQ(damping.value(), 1.0);
}

TEST(InverseController, KeepsLimitsOfTensionAndStroke) {
  BeamOptions options;
  options.tension = {.min = 0.05, .max = 1.0};
  options.displacement = {.min = -0.0015, .max = 0.0015};
  Simulation simulation(beam(options));
  InverseController controller(simulation, to({0.09, 0.03, 0.0}));
  for (int i = 0; i < 200; ++i) {
    controller.step();
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(simulation.actuator(k).effort, 0.05 - 1e-12);
      EXPECT_LE(simulation.actuator(k).effort, 1.0 + 1e-12);
    }
  }
  for (int k = 0; k < 4; ++k) EXPECT_LE(std::abs(simulation.actuator(k).motion), 0.0015 + 1e-7);
}

TEST(InverseController, SaysWhenLimitsContradictEachOther) {
  BeamOptions options;
  options.tension = {.min = 3.0, .max = 4.0};          // requires several millimetres,
  options.displacement = {.min = -1e-5, .max = 1e-5};  // which the stroke forbids
  Simulation simulation(beam(options));
  InverseController controller(simulation, to({0.099, 0.0, 0.0}));
  controller.step();
  EXPECT_EQ(controller.status(), ControllerStatus::limits_conflict);
  EXPECT_NE(controller.conflict().find("displacement of 'cable_0'"), std::string::npos)
      << controller.conflict();
  EXPECT_GE(simulation.actuator(0).effort, 3.0);
}

TEST(InverseController, LeavesOtherActuatorsToTheirCommands) {
  Simulation simulation(beam());
  TargetSettings settings = to({0.098, 0.004, 0.002});
  settings.actuators = {1, 3};
  simulation.command(0, sinew::testing::pull(0.001));
  simulation.command(2, sinew::testing::tension(0.4));
  InverseController controller(simulation, settings);
  for (int i = 0; i < 100; ++i) controller.step();
  EXPECT_NEAR(simulation.actuator(0).motion, 0.001, 1e-9);
  EXPECT_DOUBLE_EQ(simulation.actuator(2).effort, 0.4);
}

TEST(InverseController, APassiveCableMayGoSlack) {
  Simulation simulation(beam());
  TargetSettings settings = to({0.098, 0.0, 0.012});
  settings.actuators = {0};
  for (int k : {1, 2, 3}) simulation.command(k, sinew::testing::pull(-0.01));
  InverseController controller(simulation, settings);
  for (int i = 0; i < 100; ++i) controller.step();
  for (int k : {1, 2, 3}) EXPECT_EQ(simulation.actuator(k).effort, 0.0) << k;
}

TEST(InverseController, WeightsChooseWhatMatters) {
  BeamOptions options;
  options.tension = {.min = 0.0, .max = 1.0};
  const auto miss = [&](const std::vector<double>& weights) {
    Simulation simulation(beam(options));
    TargetSettings settings = to({0.1, 0.03, 0.03});
    settings.tasks[0].weights = weights;
    InverseController controller(simulation, settings);
    for (int i = 0; i < 300; ++i) controller.step();
    const Vector3 gap = simulation.effector_value(0) - Vector3(0.1, 0.03, 0.03);
    return Vector3(gap.cwiseAbs());
  };
  const Vector3 even = miss({1.0});
  const Vector3 first = miss({100.0, 1.0, 1.0});
  EXPECT_LT(first.x(), 0.9 * even.x());
}

using sinew::testing::kind_of;

TEST(InverseController, OwnsItsActuatorsUntilDetached) {
  Simulation simulation(beam());
  InverseController controller(simulation, to({0.1, 0.0, 0.0}));
  EXPECT_EQ(kind_of([&] { simulation.command(0, sinew::testing::pull(0.001)); }),
            ErrorKind::actuator_owned);
  EXPECT_EQ(kind_of([&] {
              InverseController second(simulation, to({0.1, 0, 0}));
            }),
            ErrorKind::actuator_owned);
  controller.detach();
  simulation.command(0, sinew::testing::pull(0.001));
  for (int i = 0; i < 20; ++i) simulation.step();
  EXPECT_NEAR(simulation.actuator(0).motion, 0.001, 1e-10);
}

TEST(InverseController, BadSettingsAreErrors) {
  Simulation simulation(beam());
  EXPECT_EQ(kind_of([&] { InverseController c(simulation, {}); }), ErrorKind::no_effectors);
  TargetSettings weights = to({0.1, 0, 0});
  weights.tasks[0].weights = {1.0, 2.0};
  EXPECT_EQ(kind_of([&] { InverseController c(simulation, weights); }), ErrorKind::wrong_length);
  weights.tasks[0].weights = {-1.0};
  EXPECT_EQ(kind_of([&] { InverseController c(simulation, weights); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] {
              InverseController c(simulation, to({0.1, 0, 0}), {.epsilon = 0.0});
            }),
            ErrorKind::out_of_range);
  BeamOptions bare;
  bare.cables = 0;
  Simulation still(beam(bare));
  EXPECT_EQ(kind_of([&] { InverseController c(still, to({0.1, 0, 0})); }), ErrorKind::no_actuators);
}

// Along each cable the tensions obey Coulomb's law while the controller chooses the first one.
TEST(InverseController, ReachesItsTargetThroughFriction) {
  constexpr double kFriction = 0.3;
  const auto model = beam({.friction = kFriction});
  sim::Simulation simulation(model);
  InverseController controller(simulation, to(reachable(beam())));
  for (int k = 0; k < 300; ++k) controller.step();
  EXPECT_LT(controller.error(), 5e-5);
  double largest_drop = 0.0;
  for (int cable = 0; cable < 4; ++cable) {
    const auto tensions = model->cable(cable)->tensions(simulation.efforts());
    for (int via = 0; via < model->cable(cable)->via_count(); ++via) {
      const auto k = static_cast<std::size_t>(via);
      const double turn = model->cable(cable)->turn(simulation.configuration(), via);
      // The friction limits are those of the configuration at which the step was linearised.
      const double slope = std::exp(kFriction * turn) * (1.0 + 1e-4);
      EXPECT_LE(tensions[k], tensions[k + 1] * slope + 1e-9) << cable << ' ' << via;
      EXPECT_LE(tensions[k + 1], tensions[k] * slope + 1e-9) << cable << ' ' << via;
      largest_drop = std::max(largest_drop, std::abs(tensions[k] - tensions[k + 1]));
    }
  }
  EXPECT_GT(largest_drop, 1e-3);
}

// Tip position of a beam that one cable presses on a wall and another one bends along it.
Vector3 reachable_on_the_wall(std::shared_ptr<const model::Model> model) {
  Simulation simulation(std::move(model));
  const auto pull = [&](int cable, double most) {
    simulation.command(
        cable, {model::CommandKind::effort, model::Signal::sampled({0.0, 0.5}, {0.0, most})});
  };
  pull(1, 1.0);
  pull(2, 2.5);
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_GT(simulation.contacts().resultant(0).normal_force, 0.05);
  return simulation.effector_value(0);
}

class OnAWall : public ::testing::TestWithParam<std::tuple<model::Method, double>> {
 protected:
  std::shared_ptr<const model::Model> model() const {
    BeamOptions options;
    options.wall = -0.0101;
    options.wall_friction = std::get<1>(GetParam());
    options.step.method = std::get<0>(GetParam());
    return beam(options);
  }
};

// The target is a tip position in contact: a controller that ignored the wall would push into it
// without end.
TEST_P(OnAWall, ReachesWhatIsReachedByTouching) {
  const auto model = this->model();
  const Vector3 goal = reachable_on_the_wall(model);
  Simulation simulation(model);
  InverseController controller(simulation, to(goal));
  for (int i = 0; i < 300; ++i) controller.step();
  EXPECT_EQ(controller.status(), ControllerStatus::on_target);
  EXPECT_LT(controller.error(), 5e-5);
  EXPECT_GT(simulation.contacts().resultant(0).normal_force, 0.01);
  EXPECT_LT(simulation.report().violation, 1e-7);
}

TEST_P(OnAWall, RestsWhereTheWallHoldsItBack) {
  const auto model = this->model();
  Vector3 goal = reachable_on_the_wall(model);
  goal.z() -= 0.004;
  Simulation simulation(model);
  InverseController controller(simulation, to(goal));
  for (int i = 0; i < 400; ++i) controller.step();
  const double error = controller.error();
  EXPECT_GT(error, 0.002);
  for (int i = 0; i < 50; ++i) controller.step();
  EXPECT_NEAR(controller.error(), error, 2e-5);
  EXPECT_TRUE(controller.status() == ControllerStatus::out_of_reach ||
              controller.status() == ControllerStatus::local_optimum)
      << controller_status_name(controller.status());
  for (const contact::ContactPoint& point : simulation.contacts().points(0)) {
    EXPECT_GT(point.gap, -1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(MethodsAndFriction, OnAWall,
                         ::testing::Combine(::testing::Values(model::Method::one_linearisation,
                                                              model::Method::newton),
                                            ::testing::Values(0.0, 0.3)));

}  // namespace
}  // namespace sinew::control
