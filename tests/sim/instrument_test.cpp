// An instrument that the library does not know: it counts what it is told.
#include "sinew/run/instrument.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/builder/force_settings.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/instrument_model.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/run/instruments.hpp"
#include "sinew/run/run.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/state_io.hpp"
#include "sinew/statics/path_settings.hpp"
#include "sinew/statics/static_settings.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

/// Sums the times of the steps that it sees.
class Clock : public run::Instrument {
 public:
  Clock(const run::Run& run, std::string name) : run_(run), name_(std::move(name)) {}

  void begin() override {
    sum_ = 0.0;
    seen_ = "begin";
  }
  void advance() override {
    sum_ += run_.time();
    seen_ += " step";
  }
  void settle(run::Rest rest) override {
    seen_ += rest == run::Rest::found ? " found" : rest == run::Rest::on_path ? " point" : " end";
  }
  void save(std::vector<double>& memory) const override { memory.push_back(sum_); }
  void load(std::span<const double> memory) override {
    if (memory.size() != 1) throw Error(ErrorKind::wrong_length, {}, "damaged");
    sum_ = memory.front();
  }
  std::vector<run::Reading> readings() const override {
    return {{{observable_of(run::ObservableKind::sensor, name_, "sum", "s")},
             [this](std::span<double> to) { to[0] = sum_; }}};
  }

  const std::string& seen() const { return seen_; }
  double sum() const { return sum_; }

 private:
  const run::Run& run_;
  std::string name_, seen_;
  double sum_ = 0.0;
};

class ClockModel : public model::InstrumentModel {
 public:
  explicit ClockModel(std::string name) : name_(std::move(name)) {}
  std::uint64_t hash() const override { return ValueHash().add(name_).value(); }
  std::unique_ptr<run::Instrument> start(const run::Run& run) const override {
    return std::make_unique<Clock>(run, name_);
  }

 private:
  std::string name_;
};

// A beam with clocks of these names.
std::shared_ptr<const model::Model> with_clocks(const std::vector<std::string>& names) {
  builder::ModelBuilder builder(
      {.time_step = 0.5, .integrator = mechanics::Integrator::quasi_static});
  fem::FemBodySettings body;
  body.name = "beam";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {0.0, 0.0, 0.0}, .size = {0.06, 0.02, 0.02}, .cells = {3, 1, 1}}));
  body.mesh = mesh;
  body.gravity = {0.0, 0.0, -9.81};
  body.elements.regions = {{{200e3, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::ForceSettings push;
  push.name = "push";
  push.point = {0.06, 0.01, 0.01};
  push.command = {model::CommandKind::effort, model::Signal::constant(0.02)};
  builder.add_force(push);
  for (const std::string& name : names) {
    builder.data().instruments.push_back(std::make_unique<ClockModel>(name));
  }
  return builder.build();
}

const Clock& clock_of(const Simulation& simulation, std::size_t index = 0) {
  return dynamic_cast<const Clock&>(*simulation.instruments().all()[index]);
}

TEST(Instruments, SeeStepsAndEquilibria) {
  Simulation simulation(with_clocks({"clock"}));
  EXPECT_EQ(clock_of(simulation).seen(), "begin");
  simulation.step();
  simulation.step();
  simulation.solve_static();
  EXPECT_EQ(clock_of(simulation).seen(), "begin step step found");
  simulation.reset();
  EXPECT_EQ(clock_of(simulation).seen(), "begin");
  const statics::Path path = simulation.follow_path({});
  std::string expected = "begin";
  for (std::size_t k = 0; k < path.points.size(); ++k) expected += " point";
  EXPECT_EQ(clock_of(simulation).seen(), expected + " end");
}

TEST(Instruments, HaveObservables) {
  Simulation simulation(with_clocks({"a", "b"}));
  Observables list(simulation);
  simulation.step();
  simulation.step();
  list.refresh();
  EXPECT_EQ(list.number(list.find("a.sum")), 1.5);
  EXPECT_EQ(list.number(list.find("b.sum")), 1.5);
}

TEST(Instruments, OnlyLook) {
  Simulation with(with_clocks({"clock"})), without(with_clocks({}));
  EXPECT_EQ(with.model().fingerprint(), without.model().fingerprint());
  with.step();
  without.step();
  run::State state = with.state();
  ASSERT_EQ(state.instruments.size(), 1u);
  state.instruments.clear();
  EXPECT_EQ(state, without.state());
  EXPECT_TRUE(without.state().instruments.empty());
}

// States name instruments by their hashes: others and missing ones do no harm, whatever the order.
TEST(Instruments, TakeTheirOwnMemoryFromAState) {
  Simulation simulation(with_clocks({"a", "b"})), other(with_clocks({"c", "b", "a"}));
  simulation.step();
  const run::State early = simulation.state();
  simulation.step();
  run::State mixed = simulation.state();
  mixed.instruments[0] = early.instruments[0];  // a: 0.5 s, b: 1.5 s
  other.step();
  other.restore(mixed);
  EXPECT_EQ(clock_of(other, 0).sum(), 0.0) << "'c' is not in the state and begins afresh";
  EXPECT_EQ(clock_of(other, 1).sum(), 1.5);
  EXPECT_EQ(clock_of(other, 2).sum(), 0.5);
  parse_state(simulation, format_state(other), "state");
  EXPECT_EQ(clock_of(simulation, 0).sum(), 0.5);
  EXPECT_EQ(simulation.clone()->state(), simulation.state());
}

// The others are restored, and so is the robot, before the damage is told.
TEST(Instruments, TellOfDamage) {
  Simulation simulation(with_clocks({"a", "b"}));
  simulation.step();
  run::State state = simulation.state();
  state.instruments[0].push_back(1.0);
  Simulation other(with_clocks({"a", "b"}));
  try {
    other.restore(state);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::wrong_length);
  }
  EXPECT_EQ(clock_of(other, 0).seen(), "begin");
  EXPECT_EQ(clock_of(other, 1).sum(), 0.5);
  EXPECT_EQ(other.steps(), 1);
}

TEST(Instruments, AreFoundByType) {
  Simulation simulation(with_clocks({"clock"})), without(with_clocks({}));
  EXPECT_EQ(&simulation.instruments().get<Clock>(), &clock_of(simulation));
  EXPECT_THROW(without.instruments().get<Clock>(), Error);
  EXPECT_NE(simulation.model().instrument<const ClockModel>(), nullptr);
  EXPECT_EQ(without.model().instrument<const ClockModel>(), nullptr);
}

}  // namespace
}  // namespace sinew::sim
