// Bodies with moving bases.
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/load_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"

namespace sinew::sim {
namespace {

using mechanics::Integrator;

constexpr double kAmplitude = 1e-3;  // m
constexpr double kFrequency = 40.0;  // Hz, above the block's fundamental

struct Options {
  Integrator integrator = Integrator::bdf2;
  double time_step = 1e-3;
  model::Method method = model::Method::newton;
  fem::MassMatrix mass = fem::MassMatrix::lumped;
  fem::RayleighDamping damping;
  material::Law law = material::Law::linear;
  bool hung = false;          ///< a mass at the tip, another in the lowest cells
  bool moving_frame = false;  ///< the base stands still, and an acceleration acts instead
  double shake = kAmplitude;  ///< m, amplitude of the base's displacement
  double turn = 0.0;          ///< rad, amplitude of its rotation
  double frequency = kFrequency;
  std::optional<model::AdaptiveStep> adaptive;
};

// Oscillation of a base from rest: amplitude (1 - cos(w t)).
model::Signal to_and_fro(double amplitude, double frequency) {
  return model::Signal::sine({.mean = amplitude,
                              .amplitude = amplitude,
                              .period = 1.0 / frequency,
                              .phase = -0.5 * std::numbers::pi});
}

/// A block of 20 x 20 x 60 mm of 100 kPa on its base at z = 0.
std::shared_ptr<const model::Model> block(const Options& options) {
  model::StepSettings step;
  step.integrator = options.integrator;
  step.time_step = options.time_step;
  step.method = options.method;
  step.tangent = mechanics::Tangent::exact;
  step.tolerance = 1e-11;
  step.adaptive = options.adaptive;
  builder::ModelBuilder builder(step);
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.02, 0.02, 0.06}, .cells = {2, 2, 6}}));
  body.mesh = mesh;
  body.damping = options.damping;
  body.elements.regions = {{{1e5, 0.3}, options.law, 1000.0, {}}};
  body.elements.mass = options.mass;
  body.elements.fixed_nodes = mesh->node_sets.at("z_min");
  if (options.hung) {
    body.masses = {{"tip", {}, {0.011, 0.013, 0.055}, 0.01, mesh::Outside::error},
                   {"low", {}, {0.006, 0.012, 0.004}, 0.03, mesh::Outside::error}};
  }
  const int number = builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.points.resize(1, 3);
  tip.points << 0.01, 0.01, 0.06;
  builder.add_effector(tip);
  if (options.moving_frame) {
    // -y'' = -a w^2 cos(w t).
    const double w = 2.0 * std::numbers::pi * kFrequency;
    builder.add_load({.name = "frame",
                      .body = number,
                      .load = builder::BodyLoadSettings{{-options.shake * w * w, 0.0, 0.0}},
                      .factor = model::Signal::sine({.mean = 0.0,
                                                     .amplitude = 1.0,
                                                     .period = 1.0 / kFrequency,
                                                     .phase = 0.5 * std::numbers::pi})});
  } else if (options.shake != 0.0 || options.turn != 0.0) {
    model::BaseMotion motion;
    motion.body = number;
    motion.translation[0] = to_and_fro(options.shake, options.frequency);
    motion.angle = to_and_fro(options.turn, options.frequency);
    motion.axis = Vector3::UnitY();
    motion.centre = {0.01, 0.01, 0.0};
    builder.add_base_motion(motion, {});
  }
  return builder.build();
}

double base_at(double time) {
  return kAmplitude * (1.0 - std::cos(2.0 * std::numbers::pi * kFrequency * time));
}

// Displacement of the tip relative to the base, every 5 ms up to the end.
std::vector<Vector3> sway(const Options& options, double end = 0.1) {
  Simulation simulation(block(options));
  const auto stride = std::lround(0.005 / options.time_step);
  std::vector<Vector3> result;
  for (long k = 1; k <= std::lround(end / options.time_step); ++k) {
    simulation.step();
    if (k % stride != 0) continue;
    const double base = options.moving_frame ? 0.0 : base_at(simulation.time());
    result.push_back(simulation.effector_value(0) - Vector3(base, 0.0, 0.0));
  }
  return result;
}

double largest_gap(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double gap = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) gap = std::max(gap, (a[k] - b[k]).norm());
  return gap;
}

using ShakenCase = std::tuple<Integrator, fem::MassMatrix, double, bool>;
std::string case_name(const ::testing::TestParamInfo<ShakenCase>& test) {
  const auto& [integrator, mass, damping, hung] = test.param;
  return std::string(integrator == Integrator::bdf2 ? "bdf2" : "alpha") +
         (mass == fem::MassMatrix::consistent ? "_consistent" : "_lumped") +
         (damping > 0.0 ? "_damped" : "") + (hung ? "_hung" : "");
}

class ShakenBases : public ::testing::TestWithParam<ShakenCase> {};

// In the frame of a translating base, the motion is that over a resting base under the acceleration
// -y'', where moving nodes have no inertia or damping forces. The two runs converge to each other
// with the integrator's order.
TEST_P(ShakenBases, ConvergesToTheMotionInItsFrame) {
  const auto [integrator, mass, damping, hung] = GetParam();
  Options options;
  options.integrator = integrator;
  options.mass = mass;
  options.damping = {0.0, damping};
  options.hung = hung;
  Options frame = options;
  frame.moving_frame = true;
  frame.time_step = 3.125e-5;
  const std::vector<Vector3> exact = sway(frame);
  double swing = 0.0;
  for (const Vector3& x : exact) swing = std::max(swing, (x - Vector3(0.01, 0.01, 0.06)).norm());
  EXPECT_GT(swing, 0.5 * kAmplitude);
  std::vector<double> errors;
  for (const double h : {2.5e-4, 1.25e-4}) {
    options.time_step = h;
    errors.push_back(largest_gap(sway(options), exact) / swing);
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7) << errors[0] << " " << errors[1];
  EXPECT_LT(errors[1], 0.02);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ShakenBases,
    ::testing::Values(
        ShakenCase{Integrator::bdf2, fem::MassMatrix::consistent, 0.0, false},
        ShakenCase{Integrator::generalized_alpha, fem::MassMatrix::consistent, 0.0, false},
        ShakenCase{Integrator::bdf2, fem::MassMatrix::lumped, 2e-3, false},
        ShakenCase{Integrator::generalized_alpha, fem::MassMatrix::lumped, 2e-3, false},
        ShakenCase{Integrator::generalized_alpha, fem::MassMatrix::consistent, 2e-3, true},
        ShakenCase{Integrator::bdf2, fem::MassMatrix::lumped, 2e-3, true}),
    case_name);

// A rotating base with damping, against a run with much smaller steps.
TEST(TurnedBase, DampingKeepsTheOrder) {
  Options options;
  options.law = material::Law::corotational;
  options.damping = {0.0, 2e-3};
  options.shake = 0.0;
  options.turn = 0.05;
  options.frequency = 5.0;
  for (const auto integrator : {Integrator::bdf2, Integrator::generalized_alpha}) {
    options.integrator = integrator;
    options.time_step = 1.25e-4;
    const std::vector<Vector3> exact = sway(options, 0.2);
    std::vector<double> errors;
    for (const double h : {1e-3, 5e-4}) {
      options.time_step = h;
      errors.push_back(largest_gap(sway(options, 0.2), exact));
    }
    EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7)
        << mechanics::integrator_name(integrator) << " " << errors[0] << " " << errors[1];
  }
}

// An unstrained body that moves at constant velocity is not damped.
TEST(ShakenBase, EvenSpeedIsNotDamped) {
  for (const auto method : {model::Method::newton, model::Method::one_linearisation}) {
    Options options;
    options.method = method;
    options.law = material::Law::corotational;
    options.damping = {0.0, 2e-3};
    options.shake = 0.0;
    Simulation simulation(block(options));
    for (int k = 1; k <= 200; ++k) {
      simulation.move_base(0, {0.0, 0.0, 2e-4 * k}, Vector3::Zero(), Vector3::Zero());
      simulation.step();
    }
    // The vibration after the initial jump of velocity decays; the uniform motion remains.
    const double kinetic = 0.5 * 1000.0 * 0.02 * 0.02 * 0.06 * 0.2 * 0.2;
    EXPECT_LT(simulation.energies().strain, 1e-6 * kinetic);
    EXPECT_NEAR(simulation.energies().kinetic, kinetic, 1e-4 * kinetic);
    // The damping dissipates the energy of the initial shock, which is the kinetic energy relative
    // to the base, and nothing else.
    EXPECT_GT(simulation.ledger().dissipated, 0.3 * kinetic);
    EXPECT_LT(simulation.ledger().dissipated, 1.1 * kinetic);
  }
}

std::string integrator_case(const ::testing::TestParamInfo<Integrator>& test) {
  std::string name(mechanics::integrator_name(test.param));
  std::erase(name, '-');
  return name;
}

class BaseStates : public ::testing::TestWithParam<Integrator> {};

// A state saved during a motion, restored, and reset to the start: the same run, bit for bit.
TEST_P(BaseStates, GoOnBitForBit) {
  Options options;
  options.integrator = GetParam();
  options.shake = 0.2 * kAmplitude;
  options.turn = 2e-3;
  options.damping = {1.0, 2e-3};
  options.mass = fem::MassMatrix::consistent;
  options.law = material::Law::corotational;
  const auto model = block(options);
  Simulation first(model), second(model);
  for (int k = 0; k < 20; ++k) first.step();
  parse_state(second, format_state(first), "memory");
  for (int k = 0; k < 20; ++k) {
    first.step();
    second.step();
    ASSERT_EQ(first.state().hash(), second.state().hash()) << k;
  }
  Simulation fresh(model);
  first.reset();
  EXPECT_EQ(first.state().hash(), fresh.state().hash());
  for (int k = 0; k < 5; ++k) {
    first.step();
    fresh.step();
  }
  EXPECT_EQ(first.state().hash(), fresh.state().hash());
}

TEST_P(BaseStates, KeepWhatAScriptMoved) {
  Options options;
  options.integrator = GetParam();
  options.law = material::Law::corotational;
  options.shake = 0.0;
  const auto model = block(options);
  Simulation first(model), second(model);
  const auto move = [](Simulation& simulation, int k) {
    simulation.move_base(0, {1e-4 * k, 0.0, 0.0}, {0.0, 2e-3 * k, 0.0}, {0.01, 0.01, 0.0});
  };
  for (int k = 1; k <= 10; ++k) {
    move(first, k);
    first.step();
  }
  parse_state(second, format_state(first), "memory");
  for (int k = 11; k <= 20; ++k) {
    if (k < 15) {  // then the base stops
      move(first, k);
      move(second, k);
    }
    first.step();
    second.step();
    ASSERT_EQ(first.state().hash(), second.state().hash()) << k;
  }
  first.reset();
  EXPECT_EQ(first.state().hash(), Simulation(model).state().hash());
  first.step();
  const Points moved = first.body(0).positions() - model->body(0).mesh().nodes;
  EXPECT_LT(moved.cwiseAbs().maxCoeff(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Integrators, BaseStates,
                         ::testing::Values(Integrator::quasi_static, Integrator::backward_euler,
                                           Integrator::bdf2, Integrator::generalized_alpha),
                         integrator_case);

// A rejected substep also resets the base.
TEST(Substeps, TakeTheBaseAlong) {
  Options options;
  options.integrator = Integrator::generalized_alpha;
  options.time_step = 5e-3;
  options.adaptive = model::AdaptiveStep{1e-5, 1e-6};
  Simulation simulation(block(options));
  int retries = 0;
  for (int k = 0; k < 10; ++k) retries += simulation.step().retries;
  EXPECT_GT(retries, 0);
  options.adaptive.reset();
  options.time_step = 2.5e-5;
  Simulation exact(block(options));
  while (exact.time() < 0.05 - 1e-9) exact.step();
  EXPECT_LT((simulation.effector_value(0) - exact.effector_value(0)).norm(), 0.03 * kAmplitude);
}

TEST(BaseEnergies, AreThoseOfAllTheMass) {
  Options options;
  options.shake = 0.0;
  options.hung = true;
  options.integrator = Integrator::backward_euler;
  options.time_step = 5e-3;
  for (const auto mass : {fem::MassMatrix::lumped, fem::MassMatrix::consistent}) {
    options.mass = mass;
    Simulation simulation(block(options));
    for (int k = 1; k <= 400; ++k) {
      simulation.move_base(0, {0.0, 3e-4 * k, 0.0}, Vector3::Zero(), Vector3::Zero());
      simulation.step();
    }
    const double all = 1000.0 * 0.02 * 0.02 * 0.06 + 0.04;
    EXPECT_NEAR(simulation.energies().kinetic, 0.5 * all * 0.06 * 0.06, 1e-4 * 0.5 * all * 3.6e-3);
  }
}

TEST(BaseErrors, SayWhatToDo) {
  const auto kind_of = [](Simulation& simulation, const Vector3& translation) {
    try {
      simulation.move_base(0, translation, Vector3::Zero(), Vector3::Zero());
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error.kind();
    }
    return ErrorKind::internal;
  };
  Options options;
  Simulation shaken(block(options));
  EXPECT_EQ(kind_of(shaken, Vector3::Zero()), ErrorKind::bad_argument);
  options.shake = 0.0;
  Simulation still(block(options));
  EXPECT_EQ(kind_of(still, {NAN, 0.0, 0.0}), ErrorKind::not_finite);
  builder::ModelBuilder builder(model::StepSettings{.integrator = Integrator::bdf2});
  fem::FemBodySettings body;
  body.name = "free";
  body.mesh = std::make_shared<const mesh::Mesh>(mesh::block({}));
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  builder.add_body<fem::FemBodyModel>(std::move(body));
  Simulation free(builder.build());
  EXPECT_EQ(kind_of(free, Vector3::Zero()), ErrorKind::nothing_fixed);
}

}  // namespace
}  // namespace sinew::sim
