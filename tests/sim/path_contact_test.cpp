#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/load_settings.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "arches.hpp"
#include "contact_robots.hpp"
#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::arch;
using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::block_on_plane;
using sinew::testing::pull;
using sinew::testing::tension;

constexpr double kAgrees = 1e-6;  // relative, of sizes and forces

struct Visit {
  double depth = 0.0, normal = 0.0;
  Points positions;
  std::vector<contact::ContactPoint> points;
  run::State state;
};

struct Followed {
  std::vector<statics::PathPoint> path;
  std::vector<Visit> visits;

  int turns() const {
    int count = 0;
    for (std::size_t k = 2; k < path.size(); ++k) {
      const double now = path[k].load_fraction - path[k - 1].load_fraction;
      const double before = path[k - 1].load_fraction - path[k - 2].load_fraction;
      count += now * before < 0.0 ? 1 : 0;
    }
    return count;
  }
  static int touching(const Visit& visit) {
    return static_cast<int>(std::ranges::count_if(
        visit.points, [](const contact::ContactPoint& point) { return point.normal_force > 0.0; }));
  }
};

Followed follow(Simulation& simulation, const statics::PathSettings& settings) {
  Followed result;
  const double top = simulation.effector_value(0).z();
  const statics::Path path = simulation.follow_path(settings, [&] {
    result.visits.push_back(
        {top - simulation.effector_value(0).z(), simulation.contacts().resultant(0).normal_force,
         simulation.body(0).positions(), simulation.contacts().points(0), simulation.state()});
  });
  EXPECT_EQ(path.end, statics::PathEnd::full_load) << path.reason;
  result.path = path.points;
  return result;
}

// On the unstable branch the crown meets the floor: the load turns at that corner and rises again.
// A commanded motion passes through the same points.
TEST(PathContact, ASnapThatAFloorEndsAgreesWithControlByMotion) {
  Simulation loaded(arch({.floor = 0.003})), moved(arch({.by_load = false, .floor = 0.003}));
  loaded.set_load(0, model::Signal::constant(20.0));
  const Followed all = follow(loaded, {.first_step = 2e-3, .largest_step = 5e-3});
  const double size = loaded.model().size();
  int falling = 0, touched = 0;
  for (std::size_t k = 0; k < all.path.size(); ++k) {
    const Visit& visit = all.visits[k];
    moved.command(0, pull(visit.depth));
    moved.solve_static();
    const double load = 0.4 * all.path[k].load_fraction;
    EXPECT_NEAR(moved.actuator(0).effort, load, kAgrees * std::max(load, 0.02)) << k;
    EXPECT_NEAR(moved.contacts().resultant(0).normal_force, visit.normal,
                kAgrees * std::max(load, 0.02));
    EXPECT_LT((moved.body(0).positions() - visit.positions).cwiseAbs().maxCoeff(), kAgrees * size);
    const bool touches = Followed::touching(visit) > 0;
    falling += all.path[k].negative_pivots;
    touched += touches ? 1 : 0;
    EXPECT_TRUE(!touches || all.path[k].negative_pivots == 0) << k;
  }
  EXPECT_GE(falling, 3);
  EXPECT_GE(touched, 3);
  EXPECT_EQ(all.turns(), 2);  // at the peak, and at the floor
  EXPECT_GE(all.path.back().load_fraction, 1.0);
  EXPECT_LE(all.path.back().load_fraction, 1.1);
}

TEST(PathContact, WeldsHoldBesideAFloor) {
  Simulation cut(arch({.cut = true, .floor = 0.003}));
  Simulation whole(arch({.by_load = false, .floor = 0.003}));
  cut.set_load(0, model::Signal::constant(20.0));
  const Followed all = follow(cut, {.first_step = 5e-3, .largest_step = 1e-2});
  for (std::size_t k = 0; k < all.path.size(); ++k) {
    whole.command(0, pull(all.visits[k].depth));
    whole.solve_static();
    const double load = 0.4 * all.path[k].load_fraction;
    EXPECT_NEAR(whole.actuator(0).effort, load, kAgrees * std::max(load, 0.02)) << k;
    EXPECT_NEAR(whole.contacts().resultant(0).normal_force, all.visits[k].normal,
                kAgrees * std::max(load, 0.02));
  }
  EXPECT_GT(all.visits.back().normal, 0.1);
  EXPECT_EQ(all.turns(), 2);
}

// One cable draws a beam onto a plane, another one off it: points close and open one after the
// other. Every point of the path equals a static solution from rest.
TEST(PathContact, ABeamIsLaidDownAndLifted) {
  const auto model = beam({.wall = -0.0102, .wall_friction = 0.0});
  Simulation path(model);
  const double size = model->size();
  double down = 0.0, up = 0.0;  // N, at the start
  std::vector<int> touching;
  for (const auto& [next_down, next_up] : {std::pair{12.0, 0.0}, std::pair{0.0, 4.0}}) {
    path.command(2, tension(next_down));
    path.command(0, tension(next_up));
    const Followed all = follow(path, {});
    for (std::size_t k = 0; k < all.path.size(); ++k) {
      Simulation fresh(model);
      const double load_fraction = all.path[k].load_fraction;
      if (load_fraction > 1.0) continue;  // the slackening cable would push
      fresh.command(2, tension(down + load_fraction * (next_down - down)));
      fresh.command(0, tension(up + load_fraction * (next_up - up)));
      fresh.solve_static();
      EXPECT_LT((fresh.body(0).positions() - all.visits[k].positions).cwiseAbs().maxCoeff(),
                kAgrees * size)
          << k;
      EXPECT_NEAR(fresh.contacts().resultant(0).normal_force, all.visits[k].normal, kAgrees) << k;
    }
    for (const Visit& visit : all.visits) touching.push_back(Followed::touching(visit));
    down += all.path.back().load_fraction * (next_down - down);
    up += all.path.back().load_fraction * (next_up - up);
  }
  EXPECT_GE(*std::ranges::max_element(touching), 3);  // all nodes of its end
  EXPECT_EQ(touching.back(), 0);
}

// The points of a bulging bottom close in symmetric groups of four and eight.
TEST(PathContact, SymmetricPointsCloseTogether) {
  builder::ModelBuilder builder =
      block_on_plane({.friction = 0.0, .height = 2e-4, .top_fixed = true});
  builder.add_load(
      {.name = "draw", .body = 0, .load = builder::BodyLoadSettings{{0.0, 0.0, -4000.0}}});
  builder::EffectorSettings centre;
  centre.name = "centre";
  centre.points = Vector3(0.0, 0.0, 2e-4).transpose();
  builder.add_effector(centre);
  const auto model = builder.build();
  Simulation path(model);
  const Followed all = follow(path, {.first_step = 1e-3, .largest_step = 2e-3});
  std::vector<int> touching;
  for (std::size_t k = 0; k < all.path.size(); ++k) {
    Simulation fresh(model);
    fresh.set_load(0, model::Signal::constant(all.path[k].load_fraction));
    fresh.solve_static();
    EXPECT_LT((fresh.body(0).positions() - all.visits[k].positions).cwiseAbs().maxCoeff(),
              kAgrees * model->size());
    EXPECT_NEAR(fresh.contacts().resultant(0).normal_force, all.visits[k].normal, 100.0 * kAgrees)
        << k;
    touching.push_back(Followed::touching(all.visits[k]));
  }
  EXPECT_GE(touching.back(), 5);
}

// Coulomb's law for the actual motion from one point of a path to the next.
void check_friction(const Followed& all, double friction, double size, int& stuck, int& slid) {
  for (std::size_t k = 1; k < all.visits.size(); ++k) {
    for (std::size_t i = 0; i < all.visits[k].points.size(); ++i) {
      const contact::ContactPoint& point = all.visits[k].points[i];
      const double limit = friction * point.normal_force;
      EXPECT_LE(point.friction_force.norm(), limit * (1.0 + 1e-7));
      if (!(point.normal_force > 0.0)) continue;
      Vector3 slip = point.position - all.visits[k - 1].points[i].position;
      slip -= slip.dot(point.normal) * point.normal;
      if (slip.norm() > 1e-7 * size) {
        const Vector3 expected = -limit * slip.normalized();
        EXPECT_LT((point.friction_force - expected).norm(), 1e-5 * limit) << k << " " << i;
        ++slid;
      } else {
        ++stuck;
      }
      EXPECT_TRUE(point.friction_force.norm() > 0.99 * limit || slip.norm() < 1e-8 * size);
    }
  }
}

TEST(PathContact, FrictionObeysCoulombsLawThroughASnap) {
  const double friction = 0.2;
  Simulation path(arch({.floor = 0.003, .friction = friction}));
  path.set_load(0, model::Signal::constant(20.0));
  const Followed all = follow(path, {.first_step = 2e-3, .largest_step = 5e-3});
  int stuck = 0, slid = 0;
  check_friction(all, friction, path.model().size(), stuck, slid);
  EXPECT_GE(stuck, 4);
  EXPECT_GE(slid, 4);
  EXPECT_EQ(all.turns(), 2);
}

/// A rubber strip with one end clamped, held on a plane by its weight and pulled along it by a
/// load.
std::shared_ptr<const model::Model> pulled_strip(double friction) {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "strip";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.06, 0.02, 0.02}, .cells = {12, 4, 4}}));
  body.mesh = mesh;
  body.gravity = {0.0, 0.0, -9.81};
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::ContactSettings floor;
  floor.name = "floor";
  floor.surface = collision::Plane{};
  floor.nodes = mesh->node_sets.at("z_min");
  floor.friction = friction;
  builder.add_contact(floor);
  builder.add_load({.name = "pull",
                    .body = 0,
                    .load = builder::PointLoadSettings{{0.06, 0.01, 0.01}, {0.3, 0.0, 0.0}}});
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.points = Vector3(0.06, 0.01, 0.01).transpose();
  builder.add_effector(tip);
  return builder.build();
}

// When the load is reversed, friction reverses only as far as the motion does.
TEST(PathContact, FrictionTurnsWithTheMotion) {
  const double friction = 0.5;
  Simulation path(pulled_strip(friction));
  std::vector<double> held;
  int stuck = 0, slid = 0;
  for (const double factor : {1.0, -1.0}) {
    path.set_load(0, model::Signal::constant(factor));
    const Followed all =
        follow(path, {.first_step = 1e-3, .largest_step = 5e-3, .tolerance = 1e-11});
    check_friction(all, friction, path.model().size(), stuck, slid);
    const contact::ContactResultant resultant = path.contacts().resultant(0);
    held.push_back(resultant.force.x() / (friction * resultant.normal_force));
  }
  EXPECT_NEAR(held[0], -1.0, 0.05);
  EXPECT_NEAR(held[1], 1.0, 0.05);
  EXPECT_GT(stuck, 20);
  EXPECT_GT(slid, 200);
}

// Equals the static solution for the same load, as one slow motion from the previous point.
TEST(PathContact, FrictionIsThatOfSlowMotionsFromPointToPoint) {
  const auto model = pulled_strip(0.5);
  Simulation path(model), still(model);
  const Followed all = follow(path, {.first_step = 1e-3, .largest_step = 5e-3, .tolerance = 1e-11});
  for (std::size_t k = 1; k < all.path.size(); ++k) {
    still.restore(all.visits[k - 1].state);
    still.set_load(0, model::Signal::constant(all.path[k].load_fraction));
    still.solve_static();
    EXPECT_LT((still.body(0).positions() - all.visits[k].positions).cwiseAbs().maxCoeff(),
              kAgrees * model->size())
        << k;
    for (std::size_t i = 0; i < all.visits[k].points.size(); ++i) {
      const Vector3 off =
          still.contacts().point(0, i).friction_force - all.visits[k].points[i].friction_force;
      EXPECT_LT(off.norm(), kAgrees) << k << " " << i;
    }
  }
  EXPECT_GE(all.path.size(), 5u);
}

// Balls and rods, whose tangent planes rotate as the points move.
TEST(PathContact, CurvedSurfacesEndASnap) {
  const collision::Sphere ball{{0.002, 0.002, -0.004}, 0.007};
  const collision::Capsule across{{0.002, -0.02, -0.001}, {0.002, 0.02, -0.001}, 0.004};
  const collision::Capsule askew{{-0.02, -0.01, -0.001}, {0.02, 0.02, -0.002}, 0.004};
  for (const collision::Shape& surface :
       {collision::Shape(ball), collision::Shape(across), collision::Shape(askew)}) {
    Simulation loaded(arch({.below = surface})), moved(arch({.by_load = false, .below = surface}));
    loaded.set_load(0, model::Signal::constant(10.0));
    const Followed all = follow(loaded, {.first_step = 2e-3, .largest_step = 5e-3});
    for (std::size_t k = 0; k < all.path.size(); ++k) {
      moved.command(0, pull(all.visits[k].depth));
      // A solution ends with gaps accurate to 1e-9, but normals only to its square root; so repeat
      // it.
      for (int again = 0; again < 6; ++again) moved.solve_static();
      const double load = 0.2 * all.path[k].load_fraction;
      EXPECT_NEAR(moved.actuator(0).effort, load, kAgrees * std::max(load, 0.02)) << k;
      EXPECT_NEAR(moved.contacts().resultant(0).normal_force, all.visits[k].normal,
                  kAgrees * std::max(load, 0.02));
    }
    EXPECT_GT(all.visits.back().normal, 0.1);
    EXPECT_GE(all.turns(), 2);
  }
}

/// A beam along x whose end is pressed onto the top of a ball, with a small sideways load.
std::shared_ptr<const model::Model> beam_on_a_ball() {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "beam";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {0.0, -0.01, -0.01}, .size = {0.1, 0.02, 0.02}, .cells = {10, 2, 2}},
                  mesh::Cells::hexahedra));
  body.mesh = mesh;
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(4e4);
  region.hyperelastic->bulk_modulus = 1e5;
  region.density = 1000.0;
  body.elements.regions = {region};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::ContactSettings ball;
  ball.name = "ball";
  ball.surface = collision::Sphere{{0.1, 0.0, -0.015}, 0.005};
  ball.points = Vector3(0.1, 0.0, -0.01).transpose();
  builder.add_contact(ball);
  const Vector3 end(0.1, 0.0, -0.01);
  builder.add_load(
      {.name = "press", .body = 0, .load = builder::PointLoadSettings{end, {0.0, 0.0, -0.1}}});
  builder.add_load(
      {.name = "aside", .body = 0, .load = builder::PointLoadSettings{end, {0.0, 1e-9, 0.0}}});
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.points = end.transpose();
  builder.add_effector(tip);
  return builder.build();
}

// The contact force of a ball rotates as the point moves, so above some load the point would slide
// off. Repeated static solutions, each with the tangent plane where the last one ended, then leave
// the top; below that load they return to it.
TEST(PathContact, ABallLetsGoOfWhatIsPressedOnIt) {
  const auto model = beam_on_a_ball();
  Simulation path(model);
  std::vector<int> unstable;
  for (const double factor : {0.05, 0.1, 0.15, 0.3, 0.6, 1.0}) {
    path.set_load(0, model::Signal::constant(factor));
    path.set_load(1, model::Signal::constant(0.0));
    const auto points = path.follow_path({.first_step = 1e-4, .largest_step = 2e-3}).points;
    Simulation pushed(model);
    pushed.restore(path.state());
    pushed.set_load(0, model::Signal::constant(factor));
    pushed.set_load(1, model::Signal::constant(1.0));
    std::vector<double> aside;
    for (int round = 0; round < 4; ++round) {
      pushed.solve_static({.stability = statics::StabilityChoice::any});
      aside.push_back(pushed.effector_value(0).y());
    }
    const bool leaves = aside[3] - aside[2] > aside[2] - aside[1];
    EXPECT_EQ(points.back().negative_pivots, leaves ? 1 : 0) << factor;
    unstable.push_back(points.back().negative_pivots);
  }
  EXPECT_EQ(unstable.front(), 0);
  EXPECT_EQ(unstable.back(), 1);
  EXPECT_TRUE(std::ranges::is_sorted(unstable));
}

TEST(PathContact, RefusesFrictionOnCurvedSurfaces) {
  const collision::Sphere ball{{0.0, 0.0, -0.01}, 0.01};
  Simulation rough(arch({.friction = 0.1, .below = ball}));
  try {
    rough.follow_path({});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_in_this_version);
    EXPECT_NE(std::string(error.what()).find("floor"), std::string::npos);
  }
}

TEST(PathContact, RefusesBodiesThatContactsAloneHold) {
  Simulation loose(block_on_plane({}).build());
  const std::uint64_t before = loose.state().hash();
  try {
    loose.follow_path({});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_in_this_version);
  }
  EXPECT_EQ(loose.state().hash(), before);
}

// Contacts that are closed at the start are found although nothing was solved before.
TEST(PathContact, BeginsWithTheWeightOnTheFloor) {
  BeamOptions options{.gravity = {0.0, 0.0, -9.81}, .wall = -0.0105, .wall_friction = 0.0};
  const auto model = beam(options);
  Simulation path(model), fresh(model);
  path.command(0, tension(2.0));
  const auto points = path.follow_path({}).points;
  fresh.command(0, tension(2.0 * points.back().load_fraction));
  fresh.solve_static();
  EXPECT_LT((fresh.body(0).positions() - path.body(0).positions()).cwiseAbs().maxCoeff(),
            kAgrees * model->size());
}

}  // namespace
}  // namespace sinew::sim
