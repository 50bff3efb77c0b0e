// Contact between the surfaces of two blocks with non-matching meshes.
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/row_motions.hpp"
#include "sinew/world/world.hpp"

#include "../support/allocation_guard.hpp"

namespace sinew::sim {
namespace {

constexpr double kWide = 0.04, kThick = 0.01, kSmall = 0.02;

void add_block(builder::ModelBuilder& builder, const char* name, const mesh::BlockShape& shape,
               const Vector3& gravity, const char* fixed, int threads) {
  fem::FemBodySettings body;
  body.name = name;
  const auto mesh = std::make_shared<const mesh::Mesh>(mesh::block(shape));
  body.mesh = mesh;
  body.gravity = gravity;
  body.damping = {.mass = 0.0, .stiffness = 0.002};
  body.elements.regions = {{{2e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  if (fixed != nullptr) body.elements.fixed_nodes = mesh->node_sets.at(fixed);
  body.factorisation.threads = threads;
  builder.add_body<fem::FemBodyModel>(std::move(body));
}

// A small block falls by 10 um onto a wide one.
std::shared_ptr<const model::Model> two_blocks(bool held, int threads = 1) {
  builder::ModelBuilder builder(
      {.time_step = 1e-3, .integrator = mechanics::Integrator::backward_euler});
  const Vector3 gravity(0.0, 0.0, -9.81);
  add_block(builder, "low",
            {.corner = {0, 0, -kThick}, .size = {kWide, kWide, kThick}, .cells = {8, 8, 2}},
            held ? gravity : Vector3::Zero(), held ? "z_min" : nullptr, threads);
  add_block(
      builder, "top",
      {.corner = {0.0073, 0.0091, 1e-5}, .size = {kSmall, kSmall, kThick}, .cells = {5, 5, 2}},
      gravity, nullptr, threads);
  builder::ContactSettings contact;
  contact.name = "touch";
  contact.body = 1;
  contact.touched = 0;
  contact.friction = 0.4;
  builder.add_contact(contact);
  return builder.build();
}

TEST(SurfaceContact, RowsPushEquallyAndOppositely) {
  Simulation simulation(two_blocks(false));
  for (int k = 0; k < 20; ++k) simulation.step();
  const world::World& world = simulation.world();
  const constraint::Contact& contact = simulation.model().contact(0);
  std::vector<int> problem_rows;
  for (std::size_t k = 0; k < contact.size(); ++k) {
    if (!(simulation.contacts().point(0, k).normal_force > 0.0)) continue;
    for (int c = 0; c < 3; ++c)
      problem_rows.push_back(world.numbering().problem_row_of(contact.row(k) + c));
  }
  ASSERT_GT(problem_rows.size(), 60U);
  const MatrixX forces = world::row_forces(simulation.world(), problem_rows);
  Eigen::Index at = 0;
  MatrixX force = MatrixX::Zero(3, forces.cols()), moment = force;
  for (const int body : {0, 1}) {
    const Points& nodes = simulation.body(body).positions();
    for (Eigen::Index node = 0; node < nodes.rows(); ++node, at += 3) {
      const Vector3 x = nodes.row(node).transpose();
      force += forces.middleRows(at, 3);
      for (Eigen::Index k = 0; k < forces.cols(); ++k) {
        moment.col(k) += x.cross(Vector3(forces.block<3, 1>(at, k)));
      }
    }
  }
  ASSERT_EQ(at, forces.rows());
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-12);
  // The two points of a pair are apart by the separation, 1e-7 of the body's size.
  EXPECT_LT(moment.cwiseAbs().maxCoeff(), 1e-8);
}

TEST(SurfaceContact, ARestoredStateIsTheSavedOne) {
  const auto model = two_blocks(false);
  Simulation first(model), second(model);
  for (int k = 0; k < 20; ++k) first.step();
  ASSERT_GT(first.contacts().resultant(0).normal_force, 0.0);
  const run::State saved = first.state();
  second.restore(saved);
  EXPECT_EQ(second.state(), saved);
  first.step();
  second.step();
  EXPECT_EQ(second.state(), first.state());
}

class Steady : public ::testing::TestWithParam<int> {};

TEST_P(Steady, StepsAllocateNothing) {
  if (!sinew::testing::counts_allocations()) GTEST_SKIP();
  Simulation simulation(two_blocks(true, GetParam()), GetParam());
  for (int k = 0; k < 80; ++k) simulation.step();  // it lands and comes to rest
  const long before = sinew::testing::allocations();
  for (int k = 0; k < 20; ++k) simulation.step();
  EXPECT_EQ(sinew::testing::allocations(), before);
  EXPECT_GT(simulation.contacts().resultant(0).normal_force, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Threads, Steady, ::testing::Values(1, 2));

}  // namespace
}  // namespace sinew::sim
