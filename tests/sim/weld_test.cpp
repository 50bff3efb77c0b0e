// Bodies joined by welds, and cables that run through both.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/joint_settings.hpp"
#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/sim/joint_load.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/row_efforts.hpp"
#include "sinew/sim/simulation.hpp"

#include "cut_beam.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::add_part;
using sinew::testing::beam_part;
using sinew::testing::cut_beam;
using sinew::testing::CutBeam;
using sinew::testing::kBeamGravity;
using sinew::testing::kBeamLength;

model::Command pull_cable(double metres) {
  return {model::CommandKind::motion, model::Signal::constant(metres)};
}
model::Command effort(double newtons) {
  return {model::CommandKind::effort, model::Signal::constant(newtons)};
}

Vector3 tip_of(const Simulation& simulation) { return simulation.effector_value(0); }

TEST(Weld, CutBeamIsTheUncutBeam) {
  for (const bool rubber : {false, true}) {
    CutBeam options{.rubber = rubber, .cables = 1, .push = true};
    options.step.tangent = mechanics::Tangent::exact;
    Simulation cut(cut_beam(options));
    options.cut = false;
    Simulation whole(cut_beam(options));
    for (Simulation* simulation : {&cut, &whole}) {
      simulation->command(0, effort(3.0));
      simulation->command(1, effort(0.05));
      const statics::StaticReport report = simulation->solve_static();
      EXPECT_TRUE(report.stable);
      EXPECT_EQ(report.negative_pivots, 0);
    }
    EXPECT_GT((tip_of(whole) - Vector3(kBeamLength, 0.0, 0.0)).norm(), 0.004);
    EXPECT_LT((tip_of(cut) - tip_of(whole)).norm(), 1e-8 * kBeamLength);
    EXPECT_NEAR(cut.actuator(0).motion, whole.actuator(0).motion, 1e-9 * kBeamLength);
    EXPECT_LT(joint_load(cut, 0).gap, 1e-9 * kBeamLength);
  }
}

TEST(Weld, DefaultStepsOfTheCutBeamAreThoseOfTheUncut) {
  using mechanics::Integrator;
  for (const auto integrator : {Integrator::quasi_static, Integrator::backward_euler,
                                Integrator::bdf2, Integrator::generalized_alpha}) {
    CutBeam options{.cables = 1};
    options.step.integrator = integrator;
    options.step.tolerance = 1e-10;
    Simulation cut(cut_beam(options));
    options.cut = false;
    Simulation whole(cut_beam(options));
    for (int k = 0; k < 30; ++k) {
      for (Simulation* simulation : {&cut, &whole}) {
        simulation->command(0, pull_cable(2e-4 * std::min(k, 20)));
        EXPECT_EQ(simulation->step().status, run::StepStatus::solved);
      }
      // The cable's geometric stiffness between the bodies is as exact as within them.
      EXPECT_LE(cut.report().iterations, whole.report().iterations + 1) << k;
      EXPECT_LT((tip_of(cut) - tip_of(whole)).norm(), 1e-7 * kBeamLength)
          << mechanics::integrator_name(integrator) << " step " << k;
    }
  }
}

TEST(Weld, CarriesTheWeightOfWhatHangsOnIt) {
  Simulation simulation(cut_beam({.finer = 2}));
  simulation.solve_static();
  const JointLoad load = joint_load(simulation, 0);
  const double weight = 0.5 * kBeamLength * 0.02 * 0.02 * 1070.0 * kBeamGravity;
  // The force on the weld's second body, which carries the first.
  EXPECT_LT((load.force - Vector3(0.0, 0.0, -weight)).norm(), 1e-8 * weight);
  const Vector3 middle = simulation.body(1).positions().colwise().mean();
  const Vector3 expected = (middle - load.centre).cross(Vector3(0.0, 0.0, -weight));
  EXPECT_LT((load.moment - expected).norm(), 0.02 * expected.norm());  // mean of nodes, not of mass
  EXPECT_GT(load.moment[1], 0.9 * expected[1]);
}

// With non-matching meshes, the seam behaves like that of the coarser mesh.
TEST(Weld, FinerPartBendsAsTheCoarserOneOrMore) {
  const auto sag = [](const CutBeam& options) {
    Simulation simulation(cut_beam(options));
    simulation.solve_static();
    return -tip_of(simulation)[2];
  };
  const double whole = sag({.cut = false}), half = sag({.finer = 2});
  EXPECT_GT(half, whole);
  EXPECT_LT(half, 1.2 * whole);
}

TEST(Weld, ComplianceIsThatOfFiniteDifferences) {
  CutBeam options{.gravity = {0.0, 0.0, -2.0}, .cables = 1, .push = true};
  Simulation simulation(cut_beam(options));
  const auto solve = [&](double tension, double push) {
    simulation.command(0, effort(tension));
    simulation.command(1, effort(push));
    simulation.solve_static({.tolerance = 1e-12});
    VectorX delta(5);
    delta << simulation.actuator(0).motion, simulation.actuator(1).motion, tip_of(simulation);
    return delta;
  };
  const double tension = 2.0, push = 0.02, step = 1e-4;
  const VectorX by_tension =
      (solve(tension + step, push) - solve(tension - step, push)) / (2 * step);
  const VectorX by_push = (solve(tension, push + step) - solve(tension, push - step)) / (2 * step);
  solve(tension, push);
  const Linearisation linear = linearise(simulation);
  ASSERT_EQ(linear.rows, (std::vector<std::string>{"cable_0", "tip.x", "tip.y", "tip.z", "push"}));
  EXPECT_EQ(linear.negative_pivots, 0);
  const auto column = [&](const char* name) {
    const auto found = std::ranges::find(linear.rows, name);
    VectorX result(5);
    const VectorX all = linear.compliance.col(found - linear.rows.begin());
    const std::array<const char*, 5> order{"cable_0", "push", "tip.x", "tip.y", "tip.z"};
    for (std::size_t k = 0; k < order.size(); ++k) {
      result[static_cast<Eigen::Index>(k)] =
          all[std::ranges::find(linear.rows, order[k]) - linear.rows.begin()];
    }
    return result;
  };
  EXPECT_LT((column("cable_0") - by_tension).norm(), 1e-5 * by_tension.norm());
  EXPECT_LT((column("push") - by_push).norm(), 1e-5 * by_push.norm());
}

TEST(Weld, StandsBesideContactAndFrictionOfCables) {
  CutBeam options{.cables = 1, .cable_friction = 0.2, .wall = -0.012};
  options.step.tolerance = 1e-10;
  Simulation cut(cut_beam(options));
  options.cut = false;
  Simulation whole(cut_beam(options));
  for (int k = 0; k < 30; ++k) {
    for (Simulation* simulation : {&cut, &whole}) {
      simulation->command(0, effort(0.05 * k));
      EXPECT_EQ(simulation->step().status, run::StepStatus::solved) << k;
    }
    // Friction amplifies the differences of the two solutions where a point begins to touch.
    const bool touches = whole.contacts().resultant(0).normal_force > 0.0;
    EXPECT_LT((tip_of(cut) - tip_of(whole)).norm(), (touches ? 1e-5 : 1e-6) * kBeamLength) << k;
  }
  EXPECT_GT(whole.contacts().resultant(0).normal_force, 0.0);
  EXPECT_NEAR(cut.contacts().resultant(0).normal_force, whole.contacts().resultant(0).normal_force,
              1e-4 * whole.contacts().resultant(0).normal_force);
}

TEST(Weld, IsNoActuator) {
  CutBeam options{.cables = 1, .cable_friction = 0.2, .wall = -0.012};
  Simulation simulation(cut_beam(options));
  for (int k = 0; k < 30; ++k) {
    simulation.command(0, effort(0.05 * k));
    simulation.step();
  }
  const RowEfforts efforts = split_efforts(simulation);
  const constraint::Tie& seam = *simulation.model().tie(0);
  const constraint::Cable& cable = *simulation.model().cable(0);
  double held = 0.0;
  for (int row = 0; row < static_cast<int>(efforts.actuation.size()); ++row) {
    const auto k = static_cast<std::size_t>(row);
    const auto is_of = [row](const constraint::Constraint& constraint) {
      return row >= constraint.first_row() && row < constraint.first_row() + constraint.row_count();
    };
    if (is_of(seam)) held += std::abs(simulation.efforts()[k]);
    EXPECT_EQ(efforts.actuation[k], is_of(cable) ? simulation.efforts()[k] : 0.0) << row;
  }
  EXPECT_GT(held, 0.1);
  EXPECT_EQ(cable.row_count(), 4);  // friction at three guide points
}

TEST(Weld, HoldsBetweenTwoBodiesThatAreFixed) {
  CutBeam options{.second_fixed = true};
  Simulation cut(cut_beam(options));
  cut.solve_static();
  EXPECT_TRUE(cut.model().anchors().empty());
  EXPECT_LT(joint_load(cut, 0).gap, 1e-9 * kBeamLength);
  EXPECT_LT(std::abs(tip_of(cut)[2]), 1e-12);
}

ErrorKind refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::internal;
}

TEST(Weld, WhatHoldsNothingIsRefused) {
  EXPECT_EQ(refusal([] { cut_beam({.weld = false}); }), ErrorKind::nothing_fixed);
  const auto welded_at = [](const Points& points) {
    builder::ModelBuilder builder;
    const CutBeam options;
    const int lower =
        add_part(builder, "lower", beam_part(0.0, 0.05, 5, 1), options, true, "x_min");
    const int upper =
        add_part(builder, "upper", beam_part(0.05, 0.1, 5, 1), options, false, "x_min");
    builder::WeldSettings weld{.name = "seam", .first = upper, .second = lower};
    weld.points = points;
    builder.add_weld(weld);
    builder.build();
  };
  Points line(2, 3), triangle(3, 3);
  line << 0.05, 0.0, 0.0, 0.05, 0.005, 0.0;
  triangle << 0.05, 0.0, 0.0, 0.05, 0.005, 0.0, 0.05, 0.0, 0.005;
  EXPECT_EQ(refusal([&] { welded_at(line); }), ErrorKind::nothing_fixed);
  EXPECT_NO_THROW(welded_at(triangle));
  Points outside(1, 3);
  outside << 0.06, 0.0, 0.0;
  EXPECT_EQ(refusal([&] { welded_at(outside); }), ErrorKind::point_outside_mesh);
}

}  // namespace
}  // namespace sinew::sim
