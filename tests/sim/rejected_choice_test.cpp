// A step that fails with the choice of a controller is rejected, and the controller chooses again.
#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/law/controller.hpp"
#include "sinew/law/response.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"
#include "support/error_kind.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;

constexpr double kPull = 0.02;  // N, which one linearisation can follow

// Its choices fail until the step has failed often enough; then it pulls the first cable with 20
// mN.
class Reckless : public law::Controller {
 public:
  Reckless(Simulation& simulation, int patience) : simulation_(simulation), patience_(patience) {
    const int first = 0;
    simulation_.attach(*this, std::span(&first, 1));
  }
  ~Reckless() override { simulation_.detach(*this); }

  void begin_choices(const law::StepProblem&, const law::Response&) override {}
  law::LawStatus choose(const law::StepProblem&, const law::Response&, law::Guards,
                        std::span<double> effort) override {
    if (failures_ < patience_) throw Error(ErrorKind::not_converged, {}, "crushed", "pull less");
    effort[0] = kPull;
    return law::LawStatus::solved;
  }
  double foreseen() const override { return 0.0; }
  std::span<const double> guard_multipliers() const override { return {}; }
  Merit merit(const law::StepProblem&, const VectorX&, std::span<const double>,
              std::span<const double>) const override {
    return {};
  }
  void accept(const law::StepProblem&, const law::Response&, const VectorX&,
              std::span<const double>, std::span<const double>) override {}
  void begin_step(int failures) override {
    failures_ = failures;
    most_ = std::max(most_, failures);
  }
  void hold_back(int failures) override { held_back_ = failures; }
  int most() const { return most_; }
  int held_back() const { return held_back_; }

 private:
  Simulation& simulation_;
  int patience_;
  int failures_ = 0, most_ = 0, held_back_ = 0;
};

class RejectedChoice
    : public ::testing::TestWithParam<std::pair<mechanics::Integrator, model::Method>> {
 protected:
  static std::shared_ptr<const model::Model> robot() {
    BeamOptions options;
    options.step.integrator = GetParam().first;
    options.step.method = GetParam().second;
    return beam(options);
  }
};

TEST_P(RejectedChoice, GivesWayToAnother) {
  Simulation simulation(robot()), careful(robot());
  Reckless controller(simulation, 3), other(careful, 0);
  const run::StepReport& report = simulation.step();
  EXPECT_EQ(controller.most(), 3);
  EXPECT_GE(report.retries, 3);
  EXPECT_EQ(simulation.actuator(0).effort, kPull);
  careful.step();
  EXPECT_EQ(other.most(), 0);
  // Smaller steps are not tried before: another choice costs less.
  EXPECT_EQ(simulation.state().bodies, careful.state().bodies);
  EXPECT_EQ(report.substeps, 1);
}

// After six choices, the actuators keep the efforts of the last step.
TEST_P(RejectedChoice, HoldsTheLastEffortsInTheEnd) {
  Simulation simulation(robot());
  {
    Reckless controller(simulation, 0);
    simulation.step();
    ASSERT_EQ(simulation.actuator(0).effort, kPull);
  }
  Reckless controller(simulation, 100);
  const run::StepReport& report = simulation.step();
  EXPECT_EQ(controller.most(), 5);
  EXPECT_EQ(controller.held_back(), 6);
  EXPECT_TRUE(report.choice_held);
  EXPECT_EQ(simulation.steps(), 2);
  EXPECT_EQ(simulation.actuator(0).effort, kPull);
}

INSTANTIATE_TEST_SUITE_P(
    Steps, RejectedChoice,
    ::testing::Values(
        std::pair{mechanics::Integrator::quasi_static, model::Method::newton},
        std::pair{mechanics::Integrator::quasi_static, model::Method::one_linearisation},
        std::pair{mechanics::Integrator::backward_euler, model::Method::newton},
        std::pair{mechanics::Integrator::backward_euler, model::Method::one_linearisation},
        std::pair{mechanics::Integrator::bdf2, model::Method::newton}));

}  // namespace
}  // namespace sinew::sim
