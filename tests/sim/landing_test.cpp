// Bodies that land with BDF2: no step gains energy, wherever within it the impact occurs.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "sinew/contact/contact_state.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/run.hpp"
#include "sinew/step/stepper.hpp"
#include "sinew/step/substep.hpp"

#include "event_robots.hpp"
#include "robots.hpp"

namespace sinew::testing {
namespace {

constexpr double kFall = 0.03;     // m
constexpr double kNothing = 1e-9;  // of m g h
// The same for round bodies that roll after they have landed: BDF2 reaches back to steps whose
// contact point was elsewhere (docs/contact.md).
constexpr double kLater = 1e-6;
const Vector3 kSize(0.06, 0.04, 0.02);

using Scene = void (*)(builder::ModelBuilder& builder, double friction);

struct Landing {
  const char* name;
  Scene scene;
  double end;  ///< s: until then nothing is gained, before sliding and turning bodies add errors
  double last = 0.0;  ///< s: until then kLater may be gained
};

int add_block(builder::ModelBuilder& builder, const std::string& name, const Vector3& at,
              const Vector3& velocity = Vector3::Zero(), double lean = 0.0) {
  rigid::RigidSettings block;
  block.name = name;
  block.shape = rigid::Box{kSize};
  block.mass = 0.05;
  block.position = at;
  block.velocity = velocity;
  block.rotation = Eigen::AngleAxisd(lean, Vector3::UnitY()).toRotationMatrix();
  block.gravity = Vector3(0.0, 0.0, -kGravity);
  return builder.add_body<rigid::RigidBodyModel>(block);
}

// A block that lands flat and slides.
void block(builder::ModelBuilder& builder, double friction) {
  const int body = add_block(builder, "block", {0.0, 0.0, 0.01 + kFall}, {0.3, 0.0, 0.0});
  add_floor(builder, body, Vector3::UnitZ(), friction);
}

// A block that lands on an edge and turns about it.
void leaning_block(builder::ModelBuilder& builder, double friction) {
  const int body = add_block(builder, "block", {0.0, 0.0, 0.06}, {0.3, 0.0, 0.0}, 0.4);
  add_floor(builder, body, Vector3::UnitZ(), friction);
}

// Three blocks that land one after the other, off-centre; the highest one slides.
void stack(builder::ModelBuilder& builder, double friction) {
  const int low = add_block(builder, "low", {0.0, 0.0, 0.01 + 0.5 * kFall});
  const int middle = add_block(builder, "middle", {0.01, 0.003, 0.04 + kFall});
  const int high = add_block(builder, "high", {-0.005, 0.0, 0.09 + kFall}, {0.2, 0.0, 0.0});
  add_floor(builder, low, Vector3::UnitZ(), friction);
  add_pair(builder, low, middle, friction);
  add_pair(builder, middle, high, friction);
}

// A ball lands on another falling ball and rolls off it.
void balls(builder::ModelBuilder& builder, double friction) {
  const Vector3 gravity(0.0, 0.0, -kGravity);
  const int low =
      add_ball(builder, "low", {0.0, 0.0, 0.02 + kFall}, Vector3::Zero(), gravity, 0.02);
  const int high =
      add_ball(builder, "high", {0.005, 0.0, 0.09 + kFall}, Vector3::Zero(), gravity, 0.02);
  for (const int ball : {low, high}) add_floor(builder, ball, Vector3::UnitZ(), friction);
  add_pair(builder, low, high, friction);
}

// m: largest overlap at a contact point. A corner that has turned into another body before its
// point was found is pushed out in the next step, which lifts bodies (docs/contact.md).
double overlap(const sim::Simulation& simulation) {
  double deepest = 0.0;
  for (std::size_t i = 0; i < simulation.model().contacts().size(); ++i) {
    for (const auto& point : simulation.contacts().points(static_cast<int>(i))) {
      if (point.normal_force > 0.0) deepest = std::max(deepest, -point.gap);
    }
  }
  return deepest;
}

class Landings : public ::testing::TestWithParam<Landing> {};

TEST_P(Landings, GainNoEnergy) {
  for (const double friction : {0.0, 0.5}) {
    for (const double time_step : {5e-3, 2e-3, 1e-3, 0.5e-3}) {
      builder::ModelBuilder builder(
          {.time_step = time_step, .integrator = mechanics::Integrator::bdf2});
      GetParam().scene(builder, friction);
      sim::Simulation simulation(builder.build());
      double mass = 0.0;
      for (int k = 0; k < simulation.bodies(); ++k) {
        mass += mechanics::as<const mechanics::HasShape>(simulation.body(k).model())->mass();
      }
      const double start = simulation.energies().total();
      double energy = start, least = start;
      while (simulation.time() < std::max(GetParam().end, GetParam().last)) {
        const double allowed = simulation.time() < GetParam().end ? kNothing : kLater;
        const double lifted = overlap(simulation);
        simulation.step();
        const double now = simulation.energies().total();
        EXPECT_LE(now - energy, mass * kGravity * (allowed * kFall + lifted))
            << "at " << simulation.time() << ", steps of " << time_step << ", mu " << friction;
        energy = now;
        least = std::min(least, now);
      }
      EXPECT_LT(least, start) << "nothing has landed";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bdf2, Landings,
                         ::testing::Values(Landing{"block", block, 0.11},
                                           Landing{"leaning_block", leaning_block, 0.11},
                                           Landing{"stack", stack, 0.3},
                                           Landing{"balls", balls, 0.112, 0.3}),
                         [](const auto& one) { return std::string(one.param.name); });

// A beam with a cable, and a block that falls beside it. A base moves, too, so a BDF2 step in which
// the block lands counts as one that gains energy.
std::shared_ptr<const model::Model> block_beside_beam(mechanics::Integrator integrator, double h) {
  builder::ModelBuilder builder({.time_step = h, .integrator = integrator});
  const int block = add_block(builder, "block", {0.0, 0.0, 0.017}, {0.0, 0.0, -1.0});
  add_floor(builder, block);
  rigid::RigidSettings base;
  base.name = "base";
  base.shape = rigid::Box{kSize};
  base.position = Vector3(0.0, -0.1, 0.05);
  base.fixed = true;
  model::BaseMotion motion;
  motion.body = builder.add_body<rigid::RigidBodyModel>(base);
  motion.translation[0] = model::Signal::ramp({0.0, 0.1, 0.0, 1.0});
  builder.add_base_motion(motion, {});
  fem::FemBodySettings beam;
  beam.name = "beam";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {0.0, 0.09, 0.04}, .size = {0.1, 0.02, 0.02}, .cells = {10, 2, 2}}));
  beam.mesh = mesh;
  beam.elements.regions = {{{200e3, 0.4}, material::Law::corotational, 1070.0, {}}};
  beam.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder::CableSettings cable;
  cable.name = "cable";
  cable.body = builder.add_body<fem::FemBodyModel>(std::move(beam));
  cable.points.resize(2, 3);
  cable.points << 0.0, 0.1, 0.056, 0.097, 0.1, 0.056;
  cable.tension = {.min = 0.0};
  builder.add_cable(cable);
  return builder.build();
}

// In the first half of a divided step, a cable is to make half of its jump, also if the block lands
// and this half is solved again with backward Euler.
TEST(LandingsInParts, LeaveCommandsInProportion) {
  using enum mechanics::Integrator;
  const double h = 5e-3, jump = 2e-4;
  for (const mechanics::Integrator integrator : {bdf2, generalized_alpha}) {
    run::Run run(block_beside_beam(integrator, h), 1);
    const auto& block = *mechanics::as<const mechanics::HasPose>(*run.world.bodies().all()[0]);
    step::Stepper(run).step();
    ASSERT_EQ(run.last_step, h) << "the block landed too early";
    const double height = block.origin()[2];
    run.actuation.command(0, pull(jump));
    step::Substep part(run);
    part.read_commands(1.5 * h, 0.5 * h);
    run::blend(run.world.problem().actuators, run.actuation.states(), 0.5);
    const double goal = run.world.problem().actuators[0].value;
    ASSERT_NEAR(goal, 0.5 * jump, 0.1 * jump);
    part.begin(0.5 * h);
    part.solve(0.5 * h);
    part.end(0.5 * h);
    EXPECT_NEAR(block.origin()[2], 0.01, 1e-5) << "the block has not landed";
    EXPECT_NEAR(block.linear_velocity()[2], (block.origin()[2] - height) / (0.5 * h), 1e-6)
        << "this was no step of backward Euler";
    EXPECT_EQ(run.actuation.states()[0].setpoint, goal);
  }
}

}  // namespace
}  // namespace sinew::testing
