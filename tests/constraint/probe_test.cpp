// Probes on a block with prescribed deformations.
#include "sinew/constraint/probe.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "../sim/shaped_block.hpp"

namespace sinew::constraint {
namespace {

struct Block : sim::ShapedBlock {
  template <typename What>
  void add(const char* name, What what, mesh::Outside outside = mesh::Outside::error) {
    builder_.add_probe({name, {}, outside, std::move(what)});
  }
  std::vector<double> values(const char* name) {
    return simulation_->probe_values(simulation_->model().probe_index(name));
  }
  std::vector<NodeId> all_nodes() const {
    std::vector<NodeId> nodes(static_cast<std::size_t>(mesh_->nodes.rows()));
    std::iota(nodes.begin(), nodes.end(), 0);
    return nodes;
  }
  builder::ProbeBend ends(const std::optional<Vector3>& about = {}) const {
    return {{{{0, mesh_->node_sets.at("x_min"), {}}, {0, mesh_->node_sets.at("x_max"), {}}}},
            about};
  }
  builder::ProbeLine axis(int samples) const {
    builder::ProbeLine line;
    line.corners.resize(2, 3);
    line.corners << 0.0, 0.0, 0.0, kLength, 0.0, 0.0;
    line.samples = samples;
    return line;
  }
};

class Probes : public ::testing::Test, public Block {};

TEST_F(Probes, ABendIsTheAngleBetweenTheEnds) {
  add("bend", ends());
  add("about y", ends(Vector3(0.0, 2.0, 0.0)));
  add("about -y", ends(Vector3(0.0, -1.0, 0.0)));
  finish();
  EXPECT_NEAR(values("bend")[0], 0.0, 1e-12);
  for (const double angle : {0.3, -0.3, 1.9, 3.0}) {
    bend(angle);
    // A rotation from x to z is left-handed about y.
    EXPECT_NEAR(values("bend")[0], std::abs(angle), 1e-9) << angle;
    EXPECT_NEAR(values("about y")[0], -angle, 1e-9);
    EXPECT_NEAR(values("about -y")[0], angle, 1e-9);
  }
}

TEST_F(Probes, ABendKnowsNothingOfRigidMotions) {
  add("bend", ends());
  add("sides",
      builder::ProbeBend{
          {{{0, mesh_->node_sets.at("x_max"), {}}, {0, mesh_->node_sets.at("z_max"), {}}}}, {}});
  finish();
  const double square = values("sides")[0];
  EXPECT_NEAR(square, std::numbers::pi / 2.0, 1e-9);
  const Matrix3 turn = Eigen::AngleAxisd(2.0, Vector3(1, 2, -3).normalized()).toRotationMatrix();
  deform([&](const Vector3& x) -> Vector3 { return turn * x + Vector3(1, 2, 3); });
  EXPECT_NEAR(values("bend")[0], 0.0, 1e-7);  // rounding in atan2
  EXPECT_NEAR(values("sides")[0], square, 1e-9);
}

// Nodes of a slab as thick as wide do not determine a normal; a given normal is used instead.
TEST_F(Probes, ACrossSectionTakesTheNormalThatIsGiven) {
  std::vector<NodeId> thick;
  for (Eigen::Index i = 0; i < mesh_->nodes.rows(); ++i) {
    if (mesh_->nodes(i, 0) > 0.0395 && mesh_->nodes(i, 0) < 0.0605) {
      thick.push_back(static_cast<NodeId>(i));
    }
  }
  builder::ProbeBend bend = ends();
  bend.faces[1].nodes = thick;
  try {
    add("bad", bend);
    ADD_FAILURE() << "a cube has no plane of its own";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::degenerate_orientation) << error.what();
  }
  bend.faces[1].normal = Vector3(1.0, 0.0, 0.0);
  add("half", bend);
  finish();
  this->bend(1.0);
  EXPECT_NEAR(values("half")[0], 0.5, 5e-3);  // the mean over a slab of a fifth of the length
}

TEST_F(Probes, ALineHasItsPointsAndTheirLength) {
  add("axis", axis(11));
  builder::ProbeLine corner = axis(5);
  corner.corners.resize(3, 3);
  corner.corners << 0.0, 0.0, 0.0, 0.06, 0.0, 0.0, 0.06, 0.0, 0.006;
  add("corner", corner);
  finish();
  ASSERT_EQ(values("axis").size(), 1 + 3 * 11u);
  EXPECT_NEAR(values("axis")[0], kLength, 1e-15);
  EXPECT_NEAR(values("corner")[0], 0.066, 1e-15) << "corners are among the points";
  const double angle = 1.2, radius = kLength / angle;
  bend(angle);
  const auto bent = values("axis");
  EXPECT_NEAR(bent[0], 10.0 * 2.0 * radius * std::sin(angle / 20.0), 1e-12) << "chords of the arc";
  EXPECT_NEAR(bent[1 + 3 * 5], radius * std::sin(angle / 2.0), 1e-12);
  EXPECT_NEAR(bent[3 + 3 * 10], radius * (1.0 - std::cos(angle)), 1e-12);
  const auto& names = simulation_->model().probe(0).components();
  EXPECT_EQ(names[0].name, "length");
  EXPECT_EQ(names[3 + 3 * 10].name, "10.z");
}

TEST_F(Probes, DistancesAndMeans) {
  builder::ProbeSpot start, end;
  start.points = Vector3(0.0, 0.0, 0.0).transpose();
  end.nodes = mesh_->node_sets.at("x_max");
  add("span", builder::ProbeDistance{{start, end}});
  add("end", end);
  finish();
  const double angle = 1.2, radius = kLength / angle;
  bend(angle);
  EXPECT_NEAR(values("span")[0], 2.0 * radius * std::sin(angle / 2.0), 1e-9);
  EXPECT_NEAR(values("end")[0], radius * std::sin(angle), 1e-9);
  EXPECT_NEAR(values("end")[2], radius * (1.0 - std::cos(angle)), 1e-9);
}

TEST_F(Probes, ExtentsAreThoseOfEveryDirection) {
  using Way = ExtentProbe::Way;
  add("along", builder::ProbeExtent{0, all_nodes(), Vector3(0.6, 0.0, 0.8), Way::along});
  add("smallest", builder::ProbeExtent{0, all_nodes(), Vector3::UnitX(), Way::smallest_across});
  add("largest", builder::ProbeExtent{0, all_nodes(), Vector3::UnitX(), Way::largest_across});
  finish();
  EXPECT_NEAR(values("smallest")[0], kWidth, 1e-15);
  EXPECT_NEAR(values("largest")[0], std::numbers::sqrt2 * kWidth, 1e-15);
  Matrix3 f;
  f << 1.1, 0.2, 0.0, 0.1, 0.8, 0.35, -0.1, 0.1, 1.3;
  deform([&](const Vector3& x) -> Vector3 { return f * x; });
  const Points& now = simulation_->body(0).positions();
  const auto reach = [&](const Vector3& d) { return (now * d).maxCoeff() - (now * d).minCoeff(); };
  EXPECT_NEAR(values("along")[0], reach({0.6, 0.0, 0.8}), 1e-15);
  double least = 1.0, most = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double angle = std::numbers::pi * k / 20000.0;
    const double size = reach({0.0, std::cos(angle), std::sin(angle)});
    least = std::min(least, size);
    most = std::max(most, size);
  }
  EXPECT_LE(values("smallest")[0], least + 1e-12);
  EXPECT_NEAR(values("smallest")[0], least, 1e-4 * least);
  EXPECT_GE(values("largest")[0], most - 1e-12);
  EXPECT_NEAR(values("largest")[0], most, 1e-7 * most);
}

// Nodes of a cylinder coincide along its axis, up to rounding.
TEST(RoundProbes, HaveOneDiameterInEveryDirection) {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "disc";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::cylinder({.radius = 0.02, .height = 0.02, .rings = 6, .layers = 4}));
  body.mesh = mesh;
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = {0, 1, 2};
  builder.add_body<fem::FemBodyModel>(std::move(body));
  std::vector<NodeId> all(static_cast<std::size_t>(mesh->nodes.rows()));
  std::iota(all.begin(), all.end(), 0);
  using Way = ExtentProbe::Way;
  builder.add_probe(
      {"least", {}, {}, builder::ProbeExtent{0, all, Vector3::UnitZ(), Way::smallest_across}});
  builder.add_probe(
      {"most", {}, {}, builder::ProbeExtent{0, all, Vector3::UnitZ(), Way::largest_across}});
  sim::Simulation simulation(builder.build());
  // Ring r of the mesh has 6 r nodes, so the outermost is a polygon of 36 corners.
  const double most = simulation.probe_values(1)[0];
  EXPECT_NEAR(most, 0.04, 0.001);
  EXPECT_NEAR(simulation.probe_values(0)[0], most * std::cos(std::numbers::pi / 36.0), 1e-9);
}

TEST_F(Probes, OnlyLook) {
  add("axis", axis(11));
  add("bend", ends());
  add("height", builder::ProbeExtent{0, all_nodes(), Vector3::UnitZ(), ExtentProbe::Way::along});
  finish();
  EXPECT_EQ(simulation_->model().rows().rows(), 0);
  Block bare;
  bare.finish();
  for (Block* one : {static_cast<Block*>(this), &bare}) {
    mechanics::as<mechanics::TakesForces>(one->simulation_->body(0))
        ->external_forces()
        .col(2)
        .setConstant(1e-3);
    for (int k = 0; k < 3; ++k) one->simulation_->step();
  }
  EXPECT_GT(values("bend")[0], 1e-3);
  EXPECT_EQ(simulation_->state().hash(), bare.simulation_->state().hash());
  EXPECT_EQ(simulation_->model().fingerprint(), bare.simulation_->model().fingerprint())
      << "states may be exchanged";
}

TEST_F(Probes, RefuseWhatCannotBeMeasured) {
  const auto expect = [&](auto what, ErrorKind kind) {
    try {
      add("p", what);
      ADD_FAILURE() << "accepted; expected " << error_kind_name(kind);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
    }
  };
  builder::ProbeBend line = ends();
  line.faces[0].nodes = {0, 1, 2};
  expect(line, ErrorKind::degenerate_orientation);
  expect(ends(Vector3::UnitX()), ErrorKind::degenerate_orientation);
  expect(builder::ProbeExtent{}, ErrorKind::empty_region);
  expect(builder::ProbeLine{}, ErrorKind::too_few_points);
  expect(builder::ProbeSpot{}, ErrorKind::too_few_points);
  builder::ProbeSpot away;
  away.points = Vector3(1.0, 1.0, 1.0).transpose();
  expect(away, ErrorKind::point_outside_mesh);
  add("twice", ends());
  try {
    add("twice", ends());
    ADD_FAILURE() << "two of one name";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::duplicate_key);
  }
}

}  // namespace
}  // namespace sinew::constraint
