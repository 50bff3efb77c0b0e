// Estimators of scenes in states of a run. Their results are tested in Python.
#include "sinew/estimate/estimator.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/estimate/equilibrium_filter.hpp"
#include "sinew/estimate/estimator_filter.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/estimate/estimators.hpp"
#include "sinew/estimate/motion_filter.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/run.hpp"
#include "sinew/run/state.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene {
namespace {

std::shared_ptr<const model::Model> estimated(const std::string& integrator,
                                              const std::string& more = "") {
  const std::string scene = fmt::format(R"(sinew: 1
time_step: 10 ms
integrator: {}
bodies:
  beam: {{type: fem, mesh: {{shape: block, length: 60 mm, width: 10 mm, height: 10 mm, element_size: 10 mm}},
         material: {{young_modulus: 200 kPa, poisson_ratio: 0.3}}, mass: 10 g, fixed: {{set: x_min}}}}
sensors:
  tip: {{type: marker, body: beam, point: 60 0 0 mm, noise: 0.1 mm, delay: 10 ms}}
estimators:
  push: {{type: filter, sensors: [tip], rank: 4, unknowns: {{
    hand: {{force: {{body: beam, point: 40 0 0 mm}}, prior: 0.01 N}}{}}}}}
)",
                                        integrator, more);
  return build(parse_scene_text(scene, "beam.yaml", ".")).model;
}

std::unique_ptr<sim::Simulation> estimating(const std::string& integrator) {
  return std::make_unique<sim::Simulation>(estimated(integrator));
}

TEST(Estimators, RefuseDamagedMemoryAndBeginAnewOtherwise) {
  for (const char* integrator : {"quasi-static", "backward-euler"}) {
    const auto whole = estimating(integrator), other = estimating(integrator);
    for (int k = 0; k < 3; ++k) whole->step();
    const run::State state = whole->state();
    other->restore(state);
    EXPECT_EQ(estimate::estimator_of(*other, 0).mean(), estimate::estimator_of(*whole, 0).mean());
    EXPECT_EQ(other->state(), state);
    for (const std::size_t left :
         {state.instruments.back().size() - 1, state.instruments.back().size() / 2}) {
      run::State damaged = state;
      damaged.instruments.back().resize(left);
      try {
        other->restore(damaged);
        ADD_FAILURE() << integrator << ": taken with " << left << " numbers";
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::wrong_length);
        EXPECT_THAT(error.what(), testing::HasSubstr("damaged"));
      }
      EXPECT_EQ(estimate::estimator_of(*other, 0).status(), estimate::EstimatorStatus::not_started);
    }
    run::State without = state;
    without.instruments.pop_back();
    other->restore(without);
    EXPECT_EQ(estimate::estimator_of(*other, 0).status(), estimate::EstimatorStatus::not_started);
    EXPECT_EQ(other->steps(), state.steps);
  }
}

// Estimates from the same samples, by linearisation and by finite differences. Both stop when an
// iteration changes the estimate by less than a thousandth of its deviation.
TEST(Estimators, OfBothKindsAgreeAtRest) {
  const auto still = estimating("quasi-static"), moving = estimating("backward-euler");
  still->solve_static();
  moving->solve_static();
  EXPECT_LT(
      (estimate::estimator_of(*still, 0).mean() - estimate::estimator_of(*moving, 0).mean()).norm(),
      5e-3 * estimate::estimator_of(*still, 0).deviation().norm());
  EXPECT_LT((estimate::estimator_of(*still, 0).deviation() -
             estimate::estimator_of(*moving, 0).deviation())
                .norm(),
            1e-2 * estimate::estimator_of(*still, 0).deviation().norm());
}

// A column of the blow pushes with 100 kN, for which the robot's step fails. The columns of the
// hand succeed before it, but are discarded too, and the robot stays where it was.
TEST(Estimators, AStepOfWhichAColumnFailsIsNotMade) {
  const auto model = estimated("backward-euler",
                               ", blow: {force: {body: beam, point: 60 0 0 mm}, prior: 1000 kN}");
  const run::Run run(model, 1);
  estimate::MotionFilter filter(estimate::estimators_of(*model).front(), 1);
  filter.restart(run);
  const run::State start = filter.robot().state();
  filter.advance(run, 0.01);
  EXPECT_TRUE(filter.failed());
  EXPECT_FALSE(filter.knows(0));
  EXPECT_EQ(filter.robot().state().bodies, start.bodies);
  filter.correct(0, 0, VectorX::Ones(3), VectorX::Constant(3, 1e-6));
  EXPECT_EQ(filter.mean(), VectorX::Zero(6));
  sim::Simulation whole(model);
  whole.step();
  EXPECT_EQ(estimate::estimator_of(whole, 0).status(), estimate::EstimatorStatus::no_equilibrium);
  EXPECT_FALSE(estimate::estimator_of(whole, 0).message().empty());
}

// A marker a thousand kilometres away asks for a force that no equilibrium of the beam bears. The
// equilibrium before and the correction stand, and the filter has not failed.
TEST(Estimators, AFailedRoundAtRestKeepsTheLastOne) {
  for (const char* integrator : {"quasi-static", "backward-euler"}) {
    const auto model = estimated(integrator);
    const estimate::EstimatorModel& own = estimate::estimators_of(*model).front();
    const run::Run run(model, 1);
    std::unique_ptr<estimate::EstimatorFilter> filter;
    if (integrator == std::string("quasi-static")) {
      filter = std::make_unique<estimate::EquilibriumFilter>(own, 1);
    } else {
      filter = std::make_unique<estimate::MotionFilter>(own, 1);
    }
    filter->restart(run);
    filter->begin_settling();
    ASSERT_TRUE(filter->settle(run)) << integrator;
    const VectorX path = filter->path(0);
    const run::State state = filter->robot().state();
    filter->correct(0, 0, VectorX::Constant(3, 1e6), VectorX::Constant(3, 1e-6));
    const VectorX mean = filter->mean();
    EXPECT_GT(mean.norm(), 1e3) << integrator;
    EXPECT_FALSE(filter->settle(run)) << integrator;
    EXPECT_FALSE(filter->failed()) << integrator;
    EXPECT_TRUE(filter->reason().empty()) << integrator;
    EXPECT_TRUE(filter->knows(0)) << integrator;
    EXPECT_EQ(filter->path(0), path) << integrator;
    EXPECT_EQ(filter->mean(), mean) << integrator;
    EXPECT_EQ(filter->robot().state().bodies, state.bodies) << integrator;
  }
}

// The robots of the scene and of its estimator share the mesh and its embedder.
TEST(Estimators, ShareTheMeshOfTheScene) {
  const auto model = estimated("quasi-static");
  const auto settings = [](const model::Model& of) -> const fem::FemBodySettings& {
    return mechanics::as<const fem::HasElements>(of.body(0))->settings();
  };
  const model::Model& known = *estimate::estimators_of(*model).front().robot;
  EXPECT_EQ(settings(known).mesh, settings(*model).mesh);
  EXPECT_EQ(settings(known).embedder, settings(*model).embedder);
}

}  // namespace
}  // namespace sinew::scene
