// Observables of a run: every value against the simulation's own, in a fixed order, read once.
#include "sinew/sim/observables.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/spring_line_settings.hpp"
#include "sinew/builder/torque_settings.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/row_efforts.hpp"
#include "sinew/sim/simulation.hpp"

#include "pcc/arms.hpp"
#include "sim/chambers.hpp"
#include "sim/contact_robots.hpp"
#include "sim/robots.hpp"
#include "support/allocation_guard.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::BlockOptions;

std::vector<double> values(Observables& list, std::string_view name) {
  const std::span<const double> numbers = list.read(list.find(name));
  return {numbers.begin(), numbers.end()};
}
double value(Observables& list, std::string_view name) { return list.number(list.find(name)); }
std::vector<double> numbers(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

model::Command ramp(model::CommandKind kind, double to) {
  return {kind, model::Signal::ramp({.from = 0.0, .to = to, .start = 0.0, .duration = 0.1})};
}

// A block that slides down a plane, pushed by a force, and an arm next to it: two bodies, dynamics.
std::shared_ptr<const model::Model> block_and_arm() {
  BlockOptions options{.angle = 0.5, .height = 1e-4};
  options.step.time_step = 2e-3;
  builder::ModelBuilder builder = sinew::testing::block_on_plane(options);
  pcc::ArmSettings settings = pcc::testing::mixed();
  settings.name = "arm";
  const int arm = builder.add_body<pcc::ArmBodyModel>(std::move(settings));
  builder::TorqueSettings torque;
  torque.name = "bend";
  torque.body = arm;
  torque.segment = 1;
  torque.command = ramp(model::CommandKind::effort, 0.05);
  builder.add_torque(torque);
  builder::ForceSettings push;
  push.name = "push";
  push.point = {0.0, 0.0, 0.01};
  push.command = ramp(model::CommandKind::effort, 0.2);
  builder.add_force(push);
  builder::EffectorSettings top;
  top.name = "top";
  top.points = push.point.transpose();
  builder.add_effector(top);
  builder::EffectorSettings turn = top;
  turn.name = "turn";
  turn.points.resize(3, 3);
  turn.points << 0.0, 0.0, 0.01, 0.01, 0.0, 0.01, 0.0, 0.01, 0.01;
  turn.kind = builder::EffectorSettings::Kind::orientation;
  builder.add_effector(turn);
  return builder.build();
}

TEST(Observables, HaveTheNamesUnitsAndShapesOfTheRobot) {
  BeamOptions options;
  options.cables = 1;
  options.probes = true;
  Simulation simulation(beam(options));
  const Observables list(simulation);
  std::vector<std::string> told;
  for (const run::Observable& one : list.list()) {
    std::string shape;
    for (const std::size_t length : one.shape) shape += " " + std::to_string(length);
    told.push_back(one.name + " [" + one.unit + "]" + shape);
  }
  EXPECT_EQ(told, (std::vector<std::string>{"time [s]",
                                            "beam.positions [m] 99 3",
                                            "cable_0.tension [N]",
                                            "cable_0.displacement [m]",
                                            "cable_0.tension_command [N]",
                                            "cable_0.displacement_command [m]",
                                            "tip.position [m] 3",
                                            "end.value [m] 3",
                                            "axis.value [m]",
                                            "axis.positions [m] 6 3",
                                            "bend.value [rad]",
                                            "strain_energy [J]",
                                            "kinetic_energy [J]",
                                            "gravity_energy [J]",
                                            "actuator_work [J]",
                                            "outside_work [J]",
                                            "dissipation [J]",
                                            "numerical_loss [J]",
                                            "residual [N]",
                                            "relative_residual []",
                                            "distance [m]",
                                            "iterations []",
                                            "substeps []",
                                            "scale []",
                                            "smallest_volume_ratio []",
                                            "snapped []",
                                            "status []",
                                            "time.step [s]",
                                            "time.detection [s]",
                                            "time.assembly [s]",
                                            "time.rows [s]",
                                            "time.factorisation [s]",
                                            "time.law [s]",
                                            "time.correction [s]"}));
  EXPECT_EQ(list.list()[list.find("axis.positions")].components.back(), "axis.5.z");
  EXPECT_THROW(static_cast<void>(list.find("tip.positon")), Error);
}

TEST(Observables, HaveTheValuesOfTheSimulation) {
  BeamOptions options;
  options.probes = true;
  options.gravity = {0.0, 0.0, -9.81};
  options.step.integrator = mechanics::Integrator::bdf2;
  Simulation simulation(beam(options));
  Observables list(simulation);
  EXPECT_EQ(list.word(list.find("status")), "start");
  simulation.command(0, ramp(model::CommandKind::motion, 0.005));
  simulation.command(2, ramp(model::CommandKind::effort, 0.3));
  for (int k = 0; k < 7; ++k) simulation.step();
  list.refresh();
  EXPECT_EQ(value(list, "time"), simulation.time());
  EXPECT_EQ(value(list, "cable_0.tension"), simulation.actuator(0).effort);
  EXPECT_GT(value(list, "cable_0.tension"), 0.0);
  EXPECT_EQ(value(list, "cable_2.displacement"), simulation.actuator(2).motion);
  EXPECT_EQ(values(list, "tip.position"), numbers(simulation.effector_value(0)));
  EXPECT_EQ(values(list, "end.value"), simulation.probe_values(0));
  EXPECT_EQ(value(list, "axis.value"), simulation.probe_values(1).front());
  std::vector<double> axis = simulation.probe_values(1);
  axis.erase(axis.begin());
  EXPECT_EQ(values(list, "axis.positions"), axis);
  EXPECT_EQ(values(list, "bend.value"), simulation.probe_values(2));
  const mechanics::Body& body = simulation.body(0);
  EXPECT_TRUE(std::ranges::equal(values(list, "beam.positions"),
                                 body.positions().reshaped<Eigen::RowMajor>()));
  EXPECT_TRUE(std::ranges::equal(values(list, "beam.velocities"),
                                 body.velocities().reshaped<Eigen::RowMajor>()));
  const mechanics::Energies energies = simulation.energies();
  EXPECT_EQ(value(list, "strain_energy"), energies.strain);
  EXPECT_EQ(value(list, "kinetic_energy"), energies.kinetic);
  EXPECT_EQ(value(list, "gravity_energy"), energies.gravity);
  const run::StepReport& report = simulation.report();
  EXPECT_EQ(value(list, "residual"), report.residual);
  EXPECT_EQ(value(list, "relative_residual"), report.relative_residual);
  EXPECT_EQ(value(list, "iterations"), report.iterations);
  EXPECT_EQ(value(list, "substeps"), report.substeps);
  EXPECT_EQ(value(list, "scale"), report.scale);
  EXPECT_EQ(value(list, "smallest_volume_ratio"), report.smallest_volume_ratio);
  EXPECT_EQ(list.word(list.find("status")), step_status_name(report.status));
  EXPECT_EQ(value(list, "time.step"), report.times.total);
  EXPECT_EQ(value(list, "time.law"), report.times[world::Stage::law]);
}

TEST(Observables, TheLedgerBeginsWithTheFirstReading) {
  BeamOptions options;
  options.step.integrator = mechanics::Integrator::backward_euler;
  options.gravity = {0.0, 0.0, -9.81};
  Simulation simulation(beam(options));
  simulation.command(0, ramp(model::CommandKind::motion, 0.005));
  for (int k = 0; k < 5; ++k) simulation.step();
  Observables list(simulation);
  const double before = simulation.ledger().actuators;
  EXPECT_GT(before, 0.0);
  for (const char* name : {"actuator_work", "outside_work", "dissipation", "numerical_loss"}) {
    EXPECT_EQ(value(list, name), 0.0) << name;
  }
  const auto energy = [&] {
    const mechanics::Energies now = simulation.energies();
    return now.strain + now.kinetic + now.gravity;
  };
  const double start = energy();
  for (int k = 0; k < 5; ++k) simulation.step();
  list.refresh();
  EXPECT_EQ(value(list, "actuator_work"), simulation.ledger().actuators - before);
  EXPECT_DOUBLE_EQ(value(list, "numerical_loss"),
                   value(list, "actuator_work") + value(list, "outside_work") -
                       value(list, "dissipation") - (energy() - start));
}

TEST(Observables, ContactsArmsAndTwoBodies) {
  Simulation simulation(block_and_arm());
  Observables list(simulation);
  double friction = 0.0;
  for (int k = 0; k < 40; ++k) {
    simulation.step();
    list.refresh();
    const contact::ContactResultant resultant = simulation.contacts().resultant(0);
    EXPECT_EQ(values(list, "floor.force"), numbers(resultant.force));
    EXPECT_EQ(value(list, "floor.normal_force"), resultant.normal_force);
    EXPECT_EQ(value(list, "floor.friction_force"), resultant.friction_force);
    EXPECT_EQ(value(list, "floor.gap"), resultant.smallest_gap);
    EXPECT_EQ(value(list, "floor.sticking"), resultant.sticking);
    EXPECT_EQ(value(list, "floor.slipping"), resultant.slipping);
    friction = std::max(friction, resultant.friction_force);
    const contact::ContactSnapshot snapshot = simulation.contacts().snapshot(0);
    const Eigen::Matrix<double, 3, 4> pose = snapshot.pose.affine();
    EXPECT_TRUE(std::ranges::equal(values(list, "floor.pose"), pose.reshaped<Eigen::RowMajor>()));
    for (std::size_t p = 0; p < snapshot.points.size(); ++p) {
      const contact::ContactPoint& point = snapshot.points[p];
      const auto vector = [&](const char* name) {
        const std::vector<double> all = values(list, name);
        return Vector3(all[3 * p], all[3 * p + 1], all[3 * p + 2]);
      };
      EXPECT_EQ(vector("floor.points.position"), point.position);
      EXPECT_EQ(vector("floor.points.normal"), point.normal);
      EXPECT_EQ(vector("floor.points.friction_force"), point.friction_force);
      EXPECT_EQ(values(list, "floor.points.gap")[p], point.gap);
      EXPECT_EQ(values(list, "floor.points.normal_force")[p], point.normal_force);
      EXPECT_EQ(values(list, "floor.points.state")[p], static_cast<double>(point.state));
    }
  }
  EXPECT_GT(friction, 0.0);
  const auto& arm = *mechanics::as<const mechanics::HasCoordinates>(simulation.body(1));
  EXPECT_TRUE(std::ranges::equal(values(list, "arm.coordinates"), arm.coordinates()));
  EXPECT_EQ(value(list, "bend.torque"), simulation.actuator(0).effort);
  EXPECT_EQ(value(list, "bend.angle"), simulation.actuator(0).motion);
  EXPECT_DOUBLE_EQ(value(list, "bend.torque_command"), 0.05 * 0.08 / 0.1);
  EXPECT_DOUBLE_EQ(value(list, "push.force_command"), 0.2 * 0.08 / 0.1);
  EXPECT_EQ(values(list, "turn.rotation"), numbers(simulation.effector_value(1)));
  EXPECT_EQ(list.list()[list.find("turn.rotation")].components.front(), "turn.rx");
  const run::Observable& state = list.list()[list.find("floor.points.state")];
  EXPECT_EQ(state.word(2.0), "slip");
  EXPECT_EQ(state.word(3.0), "");
}

TEST(Observables, AStateThatIsTakenUpShowsTheSame) {
  Simulation first(block_and_arm());
  Observables mine(first);
  for (int k = 0; k < 30; ++k) first.step();
  Simulation second(first.shared_model());
  second.set_inputs(first.inputs());
  second.restore(first.state());
  Observables theirs(second);
  mine.refresh();
  for (std::size_t k = 0; k < mine.list().size(); ++k) {
    const run::Observable& one = mine.list()[k];
    if (one.kind >= run::ObservableKind::ledger)
      continue;  // a state does not contain the last step
    const auto a = mine.read(k), b = theirs.read(k);
    EXPECT_TRUE(std::ranges::equal(a, b, [](double x, double y) {
      return x == y || (std::isnan(x) && std::isnan(y));
    })) << one.name;
  }
}

TEST(Observables, CommandsAreThoseOfTheQuantityThatIsCommanded) {
  BeamOptions options;
  options.tension = {.min = 0.0, .max = 1.0};
  Simulation simulation(beam(options));
  Observables list(simulation);
  EXPECT_EQ(value(list, "cable_0.tension_command"), 0.0) << "what the model commands";
  EXPECT_TRUE(std::isnan(value(list, "cable_0.displacement_command")));
  simulation.command(0, ramp(model::CommandKind::motion, 0.01));
  simulation.command(1, ramp(model::CommandKind::effort, 5.0));
  for (int k = 1; k <= 12; ++k) {
    simulation.step();
    list.refresh();
    const double part = std::min(0.1 * k, 1.0);
    EXPECT_DOUBLE_EQ(value(list, "cable_0.displacement_command"), 0.01 * part);
    EXPECT_TRUE(std::isnan(value(list, "cable_0.tension_command")));
    EXPECT_DOUBLE_EQ(value(list, "cable_1.tension_command"), 5.0 * part);
  }
  EXPECT_LE(value(list, "cable_1.tension"), 1.0 + 1e-9) << "limits bind, the command does not";
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(0.2)});
  list.refresh();
  EXPECT_EQ(value(list, "cable_0.tension_command"), 0.2);
  EXPECT_TRUE(std::isnan(value(list, "cable_0.displacement_command")));
}

TEST(Observables, DrivesHaveTheirInputsAndPassiveSpringsNoCommand) {
  Simulation gas(sinew::testing::chamber({.gas = model::GasSettings{}}));
  Observables list(gas);
  gas.command(0, ramp(model::CommandKind::input, 1e-7));
  for (int k = 0; k < 5; ++k) gas.step();
  list.refresh();
  EXPECT_DOUBLE_EQ(value(list, "chamber.gas_command"), 0.5e-7);
  EXPECT_TRUE(std::isnan(value(list, "chamber.pressure_command")));
  EXPECT_TRUE(std::isnan(value(list, "chamber.volume_growth_command")));
  EXPECT_EQ(list.list()[list.find("chamber.gas_command")].unit, "m^3");
  EXPECT_EQ(value(list, "chamber.pressure"), gas.actuator(0).effort);

  BlockOptions options{.floor = false, .top_fixed = true};
  builder::ModelBuilder builder = sinew::testing::block_on_plane(options);
  builder::SpringLineSettings line;
  line.name = "spring";
  line.points.resize(2, 3);
  line.points << 0.0, 0.0, -0.05, 0.0, 0.0, 0.0;
  line.pull_from_world = true;
  line.spring = model::SpringSettings{50.0, 0.04, 0.0, false};
  builder.add_spring(line);
  Simulation sprung(builder.build());
  const Observables passive(sprung);
  EXPECT_TRUE(command_kinds(sprung.model().actuators()[0]).empty());
  for (const run::Observable& one : passive.list()) {
    EXPECT_EQ(one.name.find("_command"), std::string::npos) << one.name;
  }
}

TEST(Observables, AReadingIsMadeOnceAMoment) {
  Simulation simulation(beam());
  Observables list(simulation);
  int readings = 0;
  run::Observable one{"one", "m", {}, run::ObservableKind::effector, "", "one", {"one"}, {}};
  run::Observable two{"two", "m", {2}, run::ObservableKind::effector, "", "two", {}, {}};
  list.add({one, two}, [&readings](std::span<double> to) {
    ++readings;
    for (std::size_t k = 0; k < 3; ++k) to[k] = readings + 0.1 * static_cast<double>(k);
  });
  EXPECT_EQ(readings, 0);
  EXPECT_EQ(value(list, "one"), 1.0);
  EXPECT_EQ(values(list, "two"), (std::vector<double>{1.1, 1.2}));
  EXPECT_EQ(readings, 1);
  list.refresh();
  EXPECT_EQ(values(list, "two"), (std::vector<double>{2.1, 2.2}));
  EXPECT_TRUE(std::ranges::is_sorted(list.list(), {}, &run::Observable::kind));
  EXPECT_EQ(values(list, "tip.position"), numbers(simulation.effector_value(0)))
      << "what was listed before stays what it was";
}

TEST(Observables, HeldNumbersStandUntilTheyAreReleased) {
  Simulation simulation(beam());
  Observables list(simulation);
  const std::size_t tip = list.find("tip.position");
  list.hold(tip, std::vector<double>{1.0, 2.0, 3.0});
  simulation.step();
  list.refresh();
  EXPECT_EQ(values(list, "tip.position"), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_THROW(list.hold(tip, std::vector<double>{1.0}), Error);
  list.release();
  EXPECT_EQ(values(list, "tip.position"), numbers(simulation.effector_value(0)));
}

TEST(Observables, ReadingAllocatesNothing) {
  if (!sinew::testing::counts_allocations()) return;
  Simulation simulation(block_and_arm());
  Observables list(simulation);
  const auto read_all = [&] {
    list.refresh();
    for (std::size_t k = 0; k < list.list().size(); ++k) list.read(k);
  };
  for (int k = 0; k < 30; ++k) simulation.step();
  read_all();
  const long before = sinew::testing::allocations();
  static_cast<void>(simulation.energies());
  const long energies = sinew::testing::allocations() - before;
  read_all();
  EXPECT_LE(sinew::testing::allocations() - before, 2 * energies);
}

TEST(RowEfforts, AreThoseOfContactsOrOfActuators) {
  Simulation simulation(block_and_arm());
  for (int k = 0; k < 40; ++k) simulation.step();
  const RowEfforts efforts = split_efforts(simulation);
  ASSERT_EQ(efforts.actuation.size(), simulation.efforts().size());
  std::set<std::size_t> touching;
  const constraint::Contact& contact = simulation.model().contact(0);
  for (int k = 0; k < contact.row_count(); ++k) {
    touching.insert(static_cast<std::size_t>(contact.first_row() + k));
  }
  double pressed = 0.0;
  for (std::size_t k = 0; k < efforts.actuation.size(); ++k) {
    const double all = simulation.efforts()[k];
    EXPECT_EQ(efforts.contact[k], touching.contains(k) ? all : 0.0) << k;
    EXPECT_EQ(efforts.actuation[k], touching.contains(k) ? 0.0 : all) << k;
    pressed += std::abs(efforts.contact[k]);
  }
  EXPECT_GT(pressed, 0.0);
  EXPECT_NE(efforts.actuation[static_cast<std::size_t>(simulation.model().actuators()[1].row)],
            0.0);
}

}  // namespace
}  // namespace sinew::sim
