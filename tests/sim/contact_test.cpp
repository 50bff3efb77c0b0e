#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

#include "contact_robots.hpp"
#include "support/allocation_guard.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::block_on_plane;
using sinew::testing::BlockOptions;
using sinew::testing::kBlockWeight;
using sinew::testing::kGravity;
using sinew::testing::mean_velocity;

TEST(Contact, BlockSticksBelowTheFrictionAngle) {
  const double critical = std::atan(0.5);
  for (const double share : {0.5, 0.95}) {
    Simulation simulation(block_on_plane({.angle = share * critical}).build());
    for (int k = 0; k < 500; ++k) simulation.step();
    const Vector3 before = simulation.body(0).positions().colwise().mean();
    for (int k = 0; k < 500; ++k) simulation.step();
    const Vector3 after = simulation.body(0).positions().colwise().mean();
    EXPECT_LT((after - before).norm(), 1e-9) << share;
    const contact::ContactResultant resultant = simulation.contacts().resultant(0);
    EXPECT_NEAR(resultant.normal_force, kBlockWeight * std::cos(share * critical),
                1e-6 * kBlockWeight);
    EXPECT_NEAR(resultant.force[0], -kBlockWeight * std::sin(share * critical),
                1e-6 * kBlockWeight);
    EXPECT_LT(simulation.report().contact_residual, 1e-9);
  }
}

TEST(Contact, BlockSlidesAsCoulombSaysAboveIt) {
  for (const double angle : {0.55, 0.8}) {
    Simulation simulation(block_on_plane({.angle = angle}).build());
    // Wait until the rubber has settled.
    for (int k = 0; k < 600; ++k) simulation.step();
    const double before = mean_velocity(simulation)[0];
    for (int k = 0; k < 400; ++k) simulation.step();
    const double acceleration = (mean_velocity(simulation)[0] - before) / 0.4;
    const double expected = kGravity * (std::sin(angle) - 0.5 * std::cos(angle));
    EXPECT_NEAR(acceleration, expected, 1e-3 * expected) << angle;
    const contact::ContactResultant resultant = simulation.contacts().resultant(0);
    EXPECT_EQ(resultant.sticking, 0);
    EXPECT_NEAR(resultant.friction_force, 0.5 * resultant.normal_force, 1e-9 * kBlockWeight);
  }
}

double total(Simulation& simulation) {
  const mechanics::Energies energies = simulation.energies();
  return energies.strain + energies.kinetic + energies.gravity;
}

// Without friction, the forces at rest are the static ones, whatever the history.
TEST(Contact, RestingForcesDoNotDependOnTheTimeStep) {
  std::vector<double> first;
  for (const double time_step : {1e-3, 4e-3, 10e-3}) {
    BlockOptions options{.friction = 0.0};
    options.step.time_step = time_step;
    Simulation simulation(block_on_plane(options).build());
    for (int k = 0; k < 400; ++k) simulation.step();
    double sum = 0.0;
    const auto points = simulation.contacts().points(0);
    for (std::size_t k = 0; k < points.size(); ++k) {
      sum += points[k].normal_force;
      EXPECT_GE(points[k].gap, -1e-12);
      if (first.size() == points.size()) {
        EXPECT_NEAR(points[k].normal_force, first[k], 1e-6 * kBlockWeight);
      }
    }
    EXPECT_NEAR(sum, kBlockWeight, 1e-8 * kBlockWeight);
    if (first.empty()) {
      for (const contact::ContactPoint& point : points) first.push_back(point.normal_force);
    }
  }
}

TEST(Contact, ImpactTakesEnergyAndNeverGivesAny) {
  for (const model::Method method : {model::Method::one_linearisation, model::Method::newton}) {
    for (const double friction : {0.0, 0.5}) {
      BlockOptions options{.angle = 0.3, .friction = friction, .height = 0.005, .modulus = 1e5};
      options.damping = {};
      options.step.method = method;
      Simulation simulation(block_on_plane(options).build());
      const double fall = 0.005 * kBlockWeight * std::cos(0.3);
      double before = total(simulation);
      bool touched = false;
      for (int k = 0; k < 300; ++k) {
        simulation.step();
        const double after = total(simulation);
        EXPECT_LE(after, before + 1e-9 * fall) << k;
        before = after;
        touched |= simulation.contacts().resultant(0).normal_force > 0.0;
      }
      EXPECT_TRUE(touched);
      EXPECT_LT(before, -0.9 * fall);  // it no longer bounces
    }
  }
}

// Impulse, contact time and energy of an impact are measured in contact_impact_test.cpp.
TEST(Contact, SecondOrderStepsDoNotGainEnergyInAnImpact) {
  BlockOptions options{.angle = 0.3, .height = 0.005, .modulus = 1e5};
  options.damping = {};
  for (const auto integrator :
       {mechanics::Integrator::bdf2, mechanics::Integrator::generalized_alpha}) {
    options.step.integrator = integrator;
    Simulation simulation(block_on_plane(options).build());
    const double start = total(simulation);
    for (int k = 0; k < 300; ++k) {
      simulation.step();
      EXPECT_LE(total(simulation), start);
    }
  }
}

// strain + kinetic + gravity + dissipation by friction, impacts and damping never exceeds the
// initial energy plus the work of the surfaces; the difference is the numerical dissipation of
// backward Euler.
TEST(Contact, LedgerOfACarriedBlock) {
  BlockOptions options{.friction = 0.5, .floor = false};
  builder::ModelBuilder builder = block_on_plane(options);
  builder::ContactSettings belt;
  belt.name = "belt";
  belt.surface = collision::Plane{};
  belt.friction = 0.5;
  const auto mesh =
      mesh::block({.corner = {-0.02, -0.02, 0.0}, .size = {0.04, 0.04, 0.02}, .cells = {4, 4, 2}});
  belt.nodes = mesh.node_sets.at("z_min");
  model::BaseMotion motion;
  motion.translation = {model::Signal::ramp({0.0, 0.2, 0.0, 1.0}), model::Signal::constant(0.0),
                        model::Signal::constant(0.0)};
  belt.motion = motion;
  builder.add_contact(belt);
  Simulation simulation(builder.build());
  const double start = total(simulation);
  double lost = 0.0;
  for (int k = 0; k < 500; ++k) {
    simulation.step();
    const double now =
        start + simulation.ledger().outside - simulation.ledger().dissipated - total(simulation);
    EXPECT_GE(now, lost - 1e-12);
    lost = now;
  }
  // The belt runs at 0.2 m/s; the block slips until it has this speed, then it sticks.
  EXPECT_NEAR(mean_velocity(simulation)[0], 0.2, 1e-6);
  EXPECT_GT(simulation.contacts().resultant(0).sticking, 20);
  const double kinetic = simulation.energies().kinetic;
  EXPECT_NEAR(simulation.ledger().outside, 2.0 * kinetic,
              0.05 * kinetic);  // half of it became heat
}

mesh::Mesh block_mesh(int cells) {
  return mesh::block({.corner = {-0.02, -0.02, 0.0},
                      .size = {0.04, 0.04, 0.02},
                      .cells = {cells, cells, cells / 2}});
}

/// The block with fixed bottom, and a ball that is lowered onto its top quasi-statically.
std::shared_ptr<const model::Model> pressed_by_a_ball(model::Method method, double friction,
                                                      double depth) {
  BlockOptions options{.floor = false};
  options.step = {.time_step = 0.1, .method = method};
  builder::ModelBuilder builder(options.step);
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(block_mesh(8));
  body.mesh = mesh;
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("z_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::ContactSettings ball;
  ball.name = "ball";
  ball.surface = collision::Sphere{Vector3(0.001, 0.002, 0.02 + 0.03), 0.03};
  ball.nodes = mesh->node_sets.at("z_max");
  ball.friction = friction;
  model::BaseMotion motion;
  motion.translation[2] = model::Signal::ramp({0.0, -depth, 0.0, 1.0});
  ball.motion = motion;
  builder.add_contact(ball);
  return builder.build();
}

TEST(Contact, BallPressedIntoABlockIsNotPenetrated) {
  for (const model::Method method : {model::Method::one_linearisation, model::Method::newton}) {
    for (const double friction : {0.0, 0.6}) {
      Simulation simulation(pressed_by_a_ball(method, friction, 0.004));
      for (int k = 0; k < 10; ++k) simulation.step();
      simulation.solve_static();
      int closed = 0;
      for (const contact::ContactPoint& point : simulation.contacts().points(0)) {
        EXPECT_GE(point.gap, -1e-9 * 0.06);
        if (point.normal_force > 0.0) {
          ++closed;
          EXPECT_NEAR(point.gap, 0.0, 1e-9 * 0.06);
        }
      }
      EXPECT_GT(closed, 8);
      EXPECT_LT(simulation.contacts().resultant(0).force[2], -0.1);
    }
  }
}

// Fast and slow paths give the same static forces, since frictionless contact has no history.
TEST(Contact, FrictionlessStaticsDoNotDependOnTheWay) {
  Simulation slow(pressed_by_a_ball(model::Method::newton, 0.0, 0.004));
  for (int k = 0; k < 10; ++k) slow.step();
  slow.solve_static();
  Simulation fast(pressed_by_a_ball(model::Method::one_linearisation, 0.0, 0.004));
  for (int k = 0; k < 10; ++k) fast.step();
  fast.solve_static();
  const Vector3 expected = slow.contacts().resultant(0).force;
  EXPECT_LT((fast.contacts().resultant(0).force - expected).norm(), 1e-6 * expected.norm());
}

/// Two capsules along y close on a block from both sides and hold it by friction.
TEST(Contact, TwoCapsulesHoldABlockByFriction) {
  for (const double friction : {0.6, 0.05}) {
    BlockOptions options{.floor = false};
    options.step.time_step = 2e-3;
    options.modulus = 1e5;
    builder::ModelBuilder builder = block_on_plane(options);
    const mesh::Mesh mesh = block_mesh(4);
    for (const double side : {-1.0, 1.0}) {
      builder::ContactSettings finger;
      finger.name = side < 0.0 ? "left" : "right";
      const double x = side * (0.02 + 0.008);
      finger.surface = collision::Capsule{{x, -0.03, 0.01}, {x, 0.03, 0.01}, 0.008};
      finger.nodes = mesh.node_sets.at(side < 0.0 ? "x_min" : "x_max");
      finger.friction = friction;
      model::BaseMotion motion;
      // A deep indentation alone would support the block.
      const double depth = friction > 0.5 ? 3e-3 : 1e-4;
      motion.translation[0] = model::Signal::ramp({0.0, -side * depth, 0.0, 0.02});
      finger.motion = motion;
      builder.add_contact(finger);
    }
    Simulation simulation(builder.build());
    for (int k = 0; k < 300; ++k) simulation.step();
    const double fallen = -mean_velocity(simulation)[2];
    const contact::ContactResultant left = simulation.contacts().resultant(0),
                                    right = simulation.contacts().resultant(1);
    if (friction > 0.5) {
      EXPECT_NEAR(left.force[2] + right.force[2], kBlockWeight, 1e-3 * kBlockWeight);
      EXPECT_NEAR(left.force[0], -right.force[0], 1e-3 * left.normal_force);
      EXPECT_LT(fallen, 1e-3);
      EXPECT_GT(left.normal_force, 1.0 * kBlockWeight);
    } else {
      EXPECT_GT(fallen, 0.1);  // it slips out
    }
  }
}

TEST(Contact, ActuatorsAndContactsShareOneProblem) {
  // A clamped block pushed down by a force with a limited stroke: the floor takes the rest.
  for (const double pushed : {0.5, 20.0}) {
    BlockOptions options{.height = 1e-3, .modulus = 1e5};
    options.step = {.time_step = 0.1, .method = model::Method::newton};
    builder::ModelBuilder builder(options.step);
    fem::FemBodySettings body;
    body.name = "block";
    const auto mesh = std::make_shared<const mesh::Mesh>(block_mesh(4));
    body.mesh = mesh;
    body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
    body.elements.fixed_nodes = mesh->node_sets.at("x_min");
    builder.add_body<fem::FemBodyModel>(std::move(body));
    builder::ContactSettings floor;
    floor.name = "floor";
    floor.surface = collision::Plane{{0.0, 0.0, -0.0005}, Vector3::UnitZ()};
    floor.nodes = mesh->node_sets.at("z_min");
    floor.friction = 0.3;
    builder.add_contact(floor);
    builder::ForceSettings push;
    push.name = "push";
    push.point = {0.02, 0.0, 0.02};
    push.direction = -Vector3::UnitZ();
    push.displacement.max = 0.004;
    push.command = {model::CommandKind::effort, model::Signal::constant(pushed)};
    builder.add_force(push);
    Simulation simulation(builder.build());
    for (int k = 0; k < 5; ++k) simulation.step();
    EXPECT_LT(simulation.report().violation, 1e-9);
    const contact::ContactResultant resultant = simulation.contacts().resultant(0);
    const model::ActuatorState& state = simulation.actuator(0);
    EXPECT_GE(resultant.smallest_gap, -1e-12);
    EXPECT_GT(resultant.normal_force, 0.0);
    if (pushed < 1.0) {
      EXPECT_NEAR(state.effort, pushed, 1e-12);
      EXPECT_LT(state.motion, 0.004);
    } else {
      EXPECT_LT(state.effort, pushed);  // the stroke limit is reached first
      EXPECT_NEAR(state.motion, 0.004, 1e-9);
    }
  }
}

/// A block with one end fixed that a cable with friction bends towards a floor `below` it.
Simulation bent_to_a_floor(double below, bool floor, bool led) {
  builder::ModelBuilder builder(
      model::StepSettings{.time_step = 0.01, .method = model::Method::newton, .tolerance = 1e-10});
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.1, 0.02, 0.02}, .cells = {10, 2, 2}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::CableSettings cable;
  cable.name = "rope";
  cable.friction = 0.3;
  cable.points.resize(4, 3);
  cable.points << 0.0, 0.01, 0.004, 0.04, 0.01, 0.003, 0.07, 0.01, 0.004, 0.095, 0.01, 0.004;
  cable.command = {led ? model::CommandKind::motion : model::CommandKind::effort,
                   model::Signal::ramp({0.0, led ? 0.004 : 0.5, 0.0, 0.1})};
  builder.add_cable(cable);
  if (floor) {
    builder::ContactSettings contact;
    contact.name = "floor";
    contact.surface = collision::Plane{{0.0, 0.0, -below}};
    contact.nodes = mesh->node_sets.at("z_min");
    contact.friction = 0.4;
    builder.add_contact(contact);
  }
  return Simulation(builder.build());
}

TEST(Contact, CablesWithFrictionAndContactsShareOneProblem) {
  for (const bool led : {true, false}) {
    Simulation free = bent_to_a_floor(0.0, false, led), far = bent_to_a_floor(1.0, true, led),
               near = bent_to_a_floor(0.002, true, led);
    for (int k = 0; k < 12; ++k) {
      free.step();
      far.step();
      near.step();
      EXPECT_LT(near.report().violation, 1e-9);
    }
    EXPECT_LT((far.body(0).positions() - free.body(0).positions()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT(far.body(0).positions().col(2).minCoeff(), -0.004);
    EXPECT_EQ(far.contacts().resultant(0).normal_force, 0.0);
    const contact::ContactResultant resultant = near.contacts().resultant(0);
    EXPECT_GE(resultant.smallest_gap, -1e-9);
    EXPECT_GT(resultant.normal_force, 0.01);
    // Along the cable, the tension changes by no more than friction allows.
    const auto tensions = near.model().cable(0)->tensions(near.efforts());
    for (int via = 0; via + 1 < static_cast<int>(tensions.size()); ++via) {
      const auto i = static_cast<std::size_t>(via);
      const double most = std::exp(0.3 * near.model().cable(0)->turn(near.configuration(), via));
      EXPECT_LE(tensions[i], most * tensions[i + 1] * (1.0 + 1e-6)) << via;
      EXPECT_LE(tensions[i + 1], most * tensions[i] * (1.0 + 1e-6)) << via;
    }
  }
}

/// A block that falls onto the floor and slides; all its nodes may touch, or only those of its
/// bottom.
Simulation sliding(bool whole, model::Method method) {
  BlockOptions options{.angle = 0.6, .height = 2e-3, .floor = false};
  options.step.method = method;
  builder::ModelBuilder builder = block_on_plane(options);
  const mesh::Mesh mesh = mesh::block({.corner = {-0.02, -0.02, options.height},
                                       .size = {0.04, 0.04, 0.02},
                                       .cells = options.cells});
  builder::ContactSettings floor;
  floor.name = "floor";
  floor.surface = collision::Plane{};
  floor.friction = 0.5;
  if (whole) {
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
      floor.nodes.push_back(static_cast<NodeId>(n));
    }
  } else {
    floor.nodes = mesh.node_sets.at("z_min");
  }
  builder.add_contact(floor);
  return Simulation(builder.build());
}

TEST(Contact, PointsThatStayAwayChangeNothing) {
  for (const model::Method method : {model::Method::one_linearisation, model::Method::newton}) {
    Simulation whole = sliding(true, method), bottom = sliding(false, method);
    int left_out = 0;
    for (int k = 0; k < 150; ++k) {
      whole.step();
      bottom.step();
      left_out += whole.world().contacts().leave_points_out() ? 1 : 0;
    }
    EXPECT_EQ(left_out, 150);
    EXPECT_GT(bottom.contacts().resultant(0).normal_force, 0.0);
    EXPECT_LT((whole.body(0).positions() - bottom.body(0).positions()).cwiseAbs().maxCoeff(),
              1e-9 * 0.06);
    EXPECT_NEAR(whole.contacts().resultant(0).normal_force,
                bottom.contacts().resultant(0).normal_force, 1e-6 * kBlockWeight);
  }
}

// One step carries the block across a gap much larger than the distance that counts as near.
TEST(Contact, PointsThatArriveUnexpectedlyAreTakenIn) {
  for (const model::Method method : {model::Method::one_linearisation, model::Method::newton}) {
    for (const double pushed : {0.05, 1.5}) {
      builder::ModelBuilder builder(model::StepSettings{.time_step = 0.1, .method = method});
      fem::FemBodySettings body;
      body.name = "block";
      const auto mesh = std::make_shared<const mesh::Mesh>(block_mesh(4));
      body.mesh = mesh;
      body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
      body.elements.fixed_nodes = mesh->node_sets.at("x_min");
      builder.add_body<fem::FemBodyModel>(std::move(body));
      builder::ContactSettings floor;
      floor.name = "floor";
      floor.surface = collision::Plane{{0.0, 0.0, -0.003}};
      floor.nodes = mesh->node_sets.at("z_min");
      floor.friction = 0.3;
      builder.add_contact(floor);
      builder::ForceSettings push;
      push.name = "push";
      push.point = {0.02, 0.0, 0.02};
      push.direction = -Vector3::UnitZ();
      push.command = {model::CommandKind::effort, model::Signal::constant(pushed)};
      builder.add_force(push);
      Simulation simulation(builder.build());
      simulation.step(OnFailure::keep_going);  // one linearisation leaves 42 % of the forces
      const contact::ContactResultant resultant = simulation.contacts().resultant(0);
      EXPECT_GE(resultant.smallest_gap, -1e-9 * 0.06);
      if (pushed < 1.0) {
        EXPECT_EQ(resultant.normal_force, 0.0);
        EXPECT_GT(resultant.smallest_gap, 1e-3);
      } else {
        EXPECT_GT(resultant.normal_force, 0.1);
        EXPECT_LT(resultant.smallest_gap, 1e-9);
      }
    }
  }
}

TEST(Contact, StepsDoNotAllocate) {
  if (!sinew::testing::counts_allocations()) GTEST_SKIP();
  Simulation simulation = sliding(true, model::Method::one_linearisation);
  for (int k = 0; k < 60; ++k) simulation.step();
  const long before = sinew::testing::allocations();
  for (int k = 0; k < 60; ++k) simulation.step();
  EXPECT_EQ(sinew::testing::allocations(), before);
  EXPECT_TRUE(simulation.world().contacts().leave_points_out());
}

TEST(Contact, RunsGoOnFromASavedStateBitForBit) {
  BlockOptions options{.angle = 0.3, .height = 1e-4};
  const auto model = block_on_plane(options).build();
  Simulation whole(model), first(model), second(model);
  for (int k = 0; k < 60; ++k) whole.step();
  for (int k = 0; k < 30; ++k) first.step();
  run::State state = first.state();
  second.restore(state);
  for (int k = 0; k < 30; ++k) second.step();
  EXPECT_EQ(second.state().hash(), whole.state().hash());
  whole.reset();
  for (int k = 0; k < 60; ++k) whole.step();
  EXPECT_EQ(second.state().hash(), whole.state().hash());
}

/// The fingerprint of a block with one modified contact.
std::uint64_t fingerprint(const std::function<void(builder::ContactSettings&)>& change) {
  builder::ModelBuilder builder = block_on_plane({.floor = false});
  builder::ContactSettings contact;
  contact.name = "tool";
  contact.surface = collision::Capsule{{0.0, 0.0, -0.02}, {0.01, 0.0, -0.02}, 0.01};
  contact.points = Points::Zero(2, 3);
  contact.points.row(1) << 0.01, 0.0, 0.0;
  model::BaseMotion motion;
  motion.translation[2] = model::Signal::ramp({0.0, 0.001, 0.0, 1.0});
  contact.motion = motion;
  change(contact);
  builder.add_contact(contact);
  return builder.build()->fingerprint();
}

TEST(Contact, FingerprintsTellApartWhatMovesDifferently) {
  using Change = std::function<void(builder::ContactSettings&)>;
  const auto capsule = [](builder::ContactSettings& c) -> collision::Capsule& {
    return std::get<collision::Capsule>(c.surface);
  };
  const std::vector<Change> changes = {
      [](builder::ContactSettings&) {},
      [](builder::ContactSettings& c) { c.friction = 0.25; },
      [&](builder::ContactSettings& c) { capsule(c).radius = 0.011; },
      [&](builder::ContactSettings& c) { capsule(c).from[1] = 0.001; },
      [&](builder::ContactSettings& c) { capsule(c).to[1] = 0.001; },
      [](builder::ContactSettings& c) { c.points.row(1) << 0.011, 0.0, 0.0; },
      [](builder::ContactSettings& c) { c.points.conservativeResize(1, 3); },
      [](builder::ContactSettings& c) { c.motion.reset(); },
      [](builder::ContactSettings& c) {
        c.motion->translation[2] = model::Signal::ramp({0.0, 0.001, 0.0, 2.0});
      },
      [](builder::ContactSettings& c) {
        c.motion->translation[2] = model::Signal::constant(0.001);
      },
      [](builder::ContactSettings& c) {
        c.motion->translation[2] = model::Signal::sine({0.0, 0.001, 1.0, 0.0});
      },
      [](builder::ContactSettings& c) {
        c.motion->translation[2] = model::Signal::steps({{0.0, 0.001}});
      },
      [](builder::ContactSettings& c) {
        c.motion->translation[2] = model::Signal::sampled({0.0}, {0.001});
      },
      [](builder::ContactSettings& c) { c.motion->axis = Vector3::UnitX(); },
      [](builder::ContactSettings& c) { c.motion->centre[0] = 0.001; },
      [](builder::ContactSettings& c) { c.motion->angle = model::Signal::constant(0.1); },
      [](builder::ContactSettings& c) {
        c.surface = collision::Plane{{0.0, 0.0, -0.03}};
      },
      [](builder::ContactSettings& c) {
        c.surface = collision::Plane{{0.0, 0.0, -0.04}};
      },
      [](builder::ContactSettings& c) {
        c.surface = collision::Plane{{0.0, 0.0, -0.03}, {0.0, 0.1, 1.0}};
      },
      [](builder::ContactSettings& c) {
        c.surface = collision::Sphere{{0.0, 0.0, -0.03}, 0.01};
      },
      [](builder::ContactSettings& c) {
        c.surface = collision::Sphere{{0.0, 0.0, -0.04}, 0.01};
      },
      [](builder::ContactSettings& c) {
        c.surface = collision::Sphere{{0.0, 0.0, -0.03}, 0.02};
      },
  };
  std::map<std::uint64_t, std::size_t> seen;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const auto [other, is_new] = seen.emplace(fingerprint(changes[k]), k);
    EXPECT_TRUE(is_new) << k << " and " << other->second;
    EXPECT_EQ(fingerprint(changes[k]), other->first) << k;
  }
}

TEST(Contact, ThreadsGiveTheSameBits) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 4}) {
    BlockOptions options{.angle = 0.3, .height = 1e-4};
    options.factorisation.threads = threads;
    options.factorisation.ordering = linalg::Ordering::amd;
    Simulation simulation(block_on_plane(options).build(), threads);
    for (int k = 0; k < 60; ++k) simulation.step();
    hashes.push_back(simulation.state().hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Contact, RefusesWhatItCannotDo) {
  const auto model = block_on_plane({}).build();
  BlockOptions sunk{.height = -1e-3};
  EXPECT_THROW(block_on_plane(sunk), Error);
  BlockOptions negative{.friction = -0.1};
  EXPECT_THROW(block_on_plane(negative), Error);
  EXPECT_EQ(model->contact_index("floor"), 0);
  EXPECT_THROW(static_cast<void>(model->contact_index("flor")), Error);
}

TEST(Contact, StiffBodiesLandInLongSteps) {
  for (const double modulus : {1e6, 1e8, 1e10}) {
    for (const double time_step : {1e-3, 1e-2, 5e-2}) {
      for (const double friction : {0.1, 0.5, 2.0}) {
        BlockOptions options{
            .angle = 0.4, .friction = friction, .height = 1e-3, .modulus = modulus};
        options.step.time_step = time_step;
        Simulation simulation(block_on_plane(options).build());
        for (int k = 0; k < 60; ++k) {
          simulation.step();
          ASSERT_EQ(simulation.contacts().result().status, qp::ConeStatus::solved)
              << modulus << " Pa, " << time_step << " s, mu " << friction << ", step " << k;
        }
      }
    }
  }
}

}  // namespace
}  // namespace sinew::sim
