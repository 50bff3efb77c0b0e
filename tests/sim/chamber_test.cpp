#include "sinew/constraint/chamber.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/chamber_settings.hpp"
#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/spring_line_settings.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/spring_drive.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "chambers.hpp"
#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::chamber;
using sinew::testing::ChamberOptions;
using sinew::testing::kVoid;

model::Command effort(double value) {
  return {model::CommandKind::effort, model::Signal::constant(value)};
}
model::Command input(double value) {
  return {model::CommandKind::input, model::Signal::constant(value)};
}

TEST(Chamber, GrowsUnderPressureAndObeysEitherCommand) {
  Simulation by_pressure(chamber());
  by_pressure.command(0, effort(5e3));
  by_pressure.solve_static();
  const double growth = by_pressure.actuator(0).motion;
  EXPECT_GT(growth, 0.05 * kVoid);
  EXPECT_DOUBLE_EQ(by_pressure.actuator(0).effort, 5e3);
  Simulation by_volume(chamber());
  by_volume.command(0, sinew::testing::pull(growth));
  by_volume.solve_static();
  EXPECT_NEAR(by_volume.actuator(0).effort, 5e3, 1e-5);
}

TEST(Chamber, StepsReachTheStaticSolution) {
  for (const bool stiffness : {true, false}) {
    Simulation steps(chamber({.load_stiffness = stiffness})), still(chamber());
    steps.command(0, effort(5e3));
    still.command(0, effort(5e3));
    for (int i = 0; i < 60; ++i) steps.step();
    still.solve_static();
    EXPECT_NEAR(steps.actuator(0).motion, still.actuator(0).motion,
                1e-8 * still.actuator(0).motion);
  }
}

TEST(Chamber, WorkOfPressureIsTheStrainEnergy) {
  ChamberOptions options;
  options.step.method = model::Method::newton;
  Simulation simulation(chamber(options));
  constexpr int kSteps = 400;
  double before = 0.0, work = 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const double p = 5e3 * i / kSteps;
    simulation.command(0, effort(p));
    simulation.step();
    work += (p - 2.5e3 / kSteps) * (simulation.actuator(0).motion - before);
    before = simulation.actuator(0).motion;
  }
  EXPECT_NEAR(work, simulation.energies().strain, 1e-5 * work);
}

TEST(Chamber, GasFollowsItsLaw) {
  for (const double exponent : {1.0, 1.4}) {
    model::GasSettings gas;
    gas.exponent = exponent;
    gas.dead_volume = 0.5 * kVoid;
    Simulation simulation(chamber({.gas = gas}));
    const double amount = 0.2 * kVoid;
    simulation.command(0, input(amount));
    for (int i = 0; i < 40; ++i) simulation.step();
    const double volume = 1.5 * kVoid + simulation.actuator(0).motion;
    const double pressure = simulation.actuator(0).effort + gas.ambient_pressure;
    EXPECT_GT(simulation.actuator(0).effort, 500.0);
    EXPECT_NEAR(pressure,
                gas.ambient_pressure * std::pow((1.5 * kVoid + amount) / volume, exponent),
                1e-8 * pressure);
    EXPECT_NEAR(simulation.drive_state(0)[0], 1.5 * kVoid + amount, 1e-9 * kVoid);
    // The static solution is the same.
    const double growth = simulation.actuator(0).motion;
    simulation.solve_static();
    EXPECT_NEAR(simulation.actuator(0).motion, growth, 1e-7 * growth);
  }
}

TEST(Chamber, ASupplyFillsItInTimeThatStepsDoNotChange) {
  model::GasSettings gas;
  gas.supply = model::Supply{2e-11, 0.3, 0.0};
  std::vector<double> half_way;
  for (const double step : {4e-3, 2e-3, 1e-3, 5e-4}) {
    ChamberOptions options{.gas = gas};
    options.step.time_step = step;
    Simulation simulation(chamber(options));
    simulation.command(0, effort(5e3));
    double last = 0.0;
    while (simulation.time() < 0.1 - 1e-9) {
      simulation.step();
      EXPECT_GE(simulation.actuator(0).effort, last - 1e-9);
      last = simulation.actuator(0).effort;
    }
    half_way.push_back(last);
    EXPECT_LT(last, 4e3);  // not yet filled
    while (simulation.time() < 2.0) simulation.step();
    EXPECT_NEAR(simulation.actuator(0).effort, 5e3, 1e-3);
  }
  // First order: the differences halve with the step.
  for (std::size_t k = 2; k < half_way.size(); ++k) {
    const double ratio = (half_way[k - 1] - half_way[k - 2]) / (half_way[k] - half_way[k - 1]);
    EXPECT_NEAR(ratio, 2.0, 0.2);
  }
}

TEST(Chamber, ALeakLowersThePressureThatIsReached) {
  model::GasSettings gas;
  gas.supply = model::Supply{2e-10, 0.3, 2e-10};
  Simulation simulation(chamber({.gas = gas}));
  simulation.command(0, effort(5e3));
  for (int i = 0; i < 400; ++i) simulation.step();
  const double reached = simulation.actuator(0).effort;
  EXPECT_GT(reached, 1e3);
  EXPECT_LT(reached, 4e3);
  simulation.solve_static();
  EXPECT_NEAR(simulation.actuator(0).effort, reached, 1e-6 * reached);
}

TEST(Chamber, LiquidIsStiff) {
  Simulation simulation(chamber({.liquid = model::LiquidSettings{}}));
  simulation.command(0, input(0.1 * kVoid));
  for (int i = 0; i < 30; ++i) simulation.step();
  const auto& state = simulation.actuator(0);
  EXPECT_NEAR(state.motion, 0.1 * kVoid, 1e-5 * kVoid);
  EXPECT_NEAR(state.effort, 2.2e9 / kVoid * (0.1 * kVoid - state.motion), 1e-3 * state.effort);
}

TEST(Chamber, SavedStatesHoldTheGas) {
  model::GasSettings gas;
  gas.supply = model::Supply{2e-11, 0.3, 0.0};
  Simulation a(chamber({.gas = gas})), b(chamber({.gas = gas}));
  a.command(0, effort(5e3));
  b.command(0, effort(5e3));
  for (int i = 0; i < 5; ++i) a.step();
  run::State state = a.state();
  b.restore(state);
  for (int i = 0; i < 5; ++i) {
    a.step();
    b.step();
  }
  EXPECT_EQ(a.state().hash(), b.state().hash());
  a.reset();
  EXPECT_DOUBLE_EQ(a.drive_state(0)[0], kVoid);
}

TEST(Chamber, BadSettingsAreRefused) {
  const auto kind = [](const model::GasSettings& gas) {
    try {
      chamber({.gas = gas});
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  model::GasSettings gas;
  gas.exponent = 0.5;
  EXPECT_EQ(kind(gas), ErrorKind::out_of_range);
  gas = {};
  gas.supply = model::Supply{0.0, 0.5, 0.0};
  EXPECT_EQ(kind(gas), ErrorKind::out_of_range);
  gas = {};
  gas.dead_volume = -2.0 * kVoid;
  EXPECT_EQ(kind(gas), ErrorKind::out_of_range);
}

// The beam of the other tests with a spring from above to its tip.
std::shared_ptr<const model::Model> sprung(double damping, bool tension_only,
                                           std::optional<model::SmaSettings> wire = std::nullopt) {
  builder::ModelBuilder builder(model::StepSettings{});
  fem::FemBodySettings body;
  body.name = "beam";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {0.0, -0.01, -0.01}, .size = {0.1, 0.02, 0.02}, .cells = {10, 2, 2}}));
  body.mesh = mesh;
  body.elements.regions = {{{200e3, 0.4}, material::Law::corotational, 1070.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  const int number = builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::SpringLineSettings line;
  line.name = "spring";
  line.body = number;
  line.points.resize(2, 3);
  line.points << 0.1, 0.0, 0.06, 0.1, 0.0, 0.0;
  line.pull_from_world = true;
  if (wire) {
    line.spring = *wire;
  } else {
    line.spring = model::SpringSettings{50.0, 0.04, damping, tension_only};
  }
  builder.add_spring(line);
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.body = number;
  tip.points.resize(1, 3);
  tip.points << 0.1, 0.0, 0.0;
  builder.add_effector(tip);
  return builder.build();
}

TEST(Spring, PullsByItsStretch) {
  Simulation simulation(sprung(0.0, false));
  for (int i = 0; i < 30; ++i) simulation.step();
  const Vector3 tip = simulation.effector_value(0);
  const double length = (Vector3(0.1, 0.0, 0.06) - tip).norm();
  EXPECT_GT(tip.z(), 1e-3);
  EXPECT_NEAR(simulation.actuator(0).effort, 50.0 * (length - 0.04), 1e-6);
  const double steps = simulation.actuator(0).effort;
  simulation.solve_static();
  EXPECT_NEAR(simulation.actuator(0).effort, steps, 1e-6);
}

TEST(Spring, ABandGoesSlackWhereASpringPushes) {
  for (const bool band : {false, true}) {
    Simulation simulation(sprung(0.0, band));
    const auto& end = simulation.body(0).model().mesh().node_sets.at("x_max");
    for (const NodeId node : end) {
      mechanics::as<mechanics::TakesForces>(simulation.body(0))->external_forces()(node, 2) =
          (band ? 0.5 : 1.0) / 9.0;
    }
    for (int i = 0; i < 60; ++i) simulation.step();
    const double length = (Vector3(0.1, 0.0, 0.06) - simulation.effector_value(0)).norm();
    ASSERT_LT(length, 0.04);
    if (band) {
      EXPECT_EQ(simulation.actuator(0).effort, 0.0);
    } else {
      EXPECT_LT(simulation.actuator(0).effort, -0.1);
    }
  }
}

TEST(Spring, DampingSlowsButDoesNotMoveTheEnd) {
  Simulation damped(sprung(20.0, false)), free(sprung(0.0, false));
  damped.step();
  free.step();
  EXPECT_LT(damped.effector_value(0).z(), 0.5 * free.effector_value(0).z());
  for (int i = 0; i < 2000; ++i) damped.step();
  for (int i = 0; i < 60; ++i) free.step();
  EXPECT_NEAR(damped.effector_value(0).z(), free.effector_value(0).z(), 1e-6);
}

TEST(Spring, ShapeMemoryWireStiffensWhenHot) {
  const double cold = model::coil_stiffness(14.1e9, 0.0005, 0.0024, 10.0);
  EXPECT_NEAR(cold, 796.8, 0.1);  // G d^4/(8 n D^3), by hand
  model::SmaSettings wire;
  wire.free_length = 0.055;
  wire.heat_capacity = 0.01;
  Simulation simulation(sprung(0.0, false, wire));
  for (int i = 0; i < 30; ++i) simulation.step();
  const auto stiffness = [&] {
    const double length = (Vector3(0.1, 0.0, 0.06) - simulation.effector_value(0)).norm();
    return simulation.actuator(0).effort / (length - 0.055);
  };
  EXPECT_NEAR(stiffness(), cold, 1e-3 * cold);
  simulation.command(0, input(1.0));  // W: finally 100 K above ambient
  for (int i = 0; i < 600; ++i) simulation.step();
  EXPECT_NEAR(simulation.drive_state(0)[0], 393.15, 0.5);
  EXPECT_DOUBLE_EQ(simulation.drive_state(0)[1], 1.0);
  EXPECT_NEAR(stiffness(), cold * 24.7 / 14.1, 1e-3 * cold);
  simulation.command(0, input(0.0));
  for (int i = 0; i < 600; ++i) simulation.step();
  EXPECT_DOUBLE_EQ(simulation.drive_state(0)[1], 0.0);
  EXPECT_NEAR(stiffness(), cold, 1e-3 * cold);
}

TEST(Spring, PhaseHasHysteresis) {
  model::SmaSettings wire;
  model::SmaDrive drive(wire, 0.06);
  std::array<double, model::Drive::kMaxStates> state{};
  drive.rest(state);
  // A power whose steady temperature is between the two transformation ranges: on heating, the wire
  // remains martensite.
  const double power = wire.heat_loss * (333.0 - wire.ambient);
  const auto settle = [&](double watts) {
    const model::Drive::Step step{model::CommandKind::input, watts, 1e9, 0.0, state};
    drive.advance(step, 0.0, 0.0, state);
    return state[1];
  };
  EXPECT_DOUBLE_EQ(settle(power), 0.0);
  EXPECT_DOUBLE_EQ(settle(1.0), 1.0);
  EXPECT_DOUBLE_EQ(settle(power), 1.0);
  EXPECT_DOUBLE_EQ(settle(0.0), 0.0);
}

// A spherical shell of one layer of hexahedra, radius 10 mm, wall 1 mm, held at its bottom; mapped
// from a hollow cube.
std::shared_ptr<const model::Model> balloon() {
  constexpr int kCells = 8;
  mesh::Mesh made =
      mesh::block({.corner = {-1, -1, -1}, .size = {2, 2, 2}, .cells = {kCells, kCells, kCells}},
                  mesh::Cells::hexahedra);
  std::erase_if(made.hexahedra, [&](const auto& brick) {
    Vector3 middle = Vector3::Zero();
    for (const NodeId node : brick) middle += made.nodes.row(node).transpose() / 8.0;
    return middle.cwiseAbs().maxCoeff() < 1.0 - 2.0 / kCells;
  });
  std::vector<NodeId> bottom;
  for (NodeId node = 0; node < made.node_count(); ++node) {
    const Vector3 at = made.nodes.row(node).transpose();
    const double shell = at.cwiseAbs().maxCoeff();
    if (shell < 1.0 - 3.0 / kCells) continue;
    const double radius = shell > 1.0 - 1.0 / kCells ? 0.010 : 0.009;
    made.nodes.row(node) = (radius * at.normalized()).transpose();
    if (made.nodes(node, 2) < -0.0085) bottom.push_back(node);
  }
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "balloon";
  const auto mesh = std::make_shared<const mesh::Mesh>(std::move(made));
  body.mesh = mesh;
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(4e4);
  region.hyperelastic->bulk_modulus = 1e6;
  region.density = 1000.0;
  body.elements.regions = {region};
  body.elements.fixed_nodes = bottom;
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::ChamberSettings chamber;
  chamber.name = "inside";
  chamber.surface = mesh::enclosing_surface(*mesh, Vector3::Zero(), "inside");
  builder.add_chamber(chamber);
  return builder.build();
}

// A balloon has a maximum pressure; above it, the error message gives this limit.
TEST(Chamber, PressureBeyondTheLimitPointIsNamed) {
  const auto model = balloon();
  Simulation held(model);
  const double volume = model->chamber(0)->rest_volume();
  double peak = 0.0;
  for (int tenth = 1; tenth <= 40; ++tenth) {
    held.command(0, {model::CommandKind::motion, model::Signal::constant(0.1 * tenth * volume)});
    held.solve_static();
    peak = std::max(peak, held.actuator(0).effort);
  }
  ASSERT_LT(held.actuator(0).effort, 0.99 * peak);
  Simulation simulation(model);
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(1.5 * peak)});
  try {
    simulation.solve_static();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_converged);
    const std::string text = error.what();
    const auto at = text.find("about ");
    ASSERT_NE(at, std::string::npos) << text;
    EXPECT_NEAR(std::stod(text.substr(at + 6)), 1e-3 * peak, 0.02 * 1e-3 * peak) << text;
  }
}

}  // namespace
}  // namespace sinew::sim
