// Lids over openings: hubs in the planes of their rims, and rims without planes.
#include "sinew/builder/lid.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sinew/constraint/chamber.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/model/actuator.hpp"

#include "chambers.hpp"
#include "robots.hpp"
#include "support/error_kind.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::kind_of;

Vector3 hub_of(const builder::Rim& rim, const std::vector<double>& weights) {
  Vector3 hub = Vector3::Zero();
  for (std::size_t k = 0; k < weights.size(); ++k) hub += weights[k] * rim.corners[k];
  return hub;
}

builder::Rim rim_of(std::vector<Vector3> corners) {
  builder::Rim rim{std::move(corners), {}, {}};
  rim.held.assign(rim.corners.size(), 0);
  return rim;
}

/// An arc about the line through `centre` along z, from `start`; without its end.
void add_arc(std::vector<Vector3>& rim, const Vector3& centre, const Vector3& start, double angle) {
  constexpr int kParts = 9;
  for (int k = 0; k < kParts; ++k) {
    rim.push_back(centre +
                  Eigen::AngleAxisd(angle * k / kParts, Vector3::UnitZ()) * (start - centre));
  }
}

void add_line(std::vector<Vector3>& rim, const Vector3& a, const Vector3& b) {
  for (int k = 0; k < 7; ++k) rim.push_back(a + (b - a) * k / 7.0);
}

/// Corners of a body that the planes x = 0, y = 0 and z = 0 bound, with the rims below on them.
Points quadrant() {
  Points corners(4, 3);
  corners << -2, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 9;
  corners.row(0) << 2, 2, 9;
  return corners;
}

TEST(Lid, APlaneRimHasItsMeanAsHub) {
  std::vector<Vector3> corners;
  add_arc(corners, Vector3(1, 2, 3), Vector3(2, 2, 3), 2.0 * std::numbers::pi);
  const builder::Rim rim = rim_of(corners);
  const auto weights = builder::find_hub(rim, quadrant());
  ASSERT_TRUE(weights);
  EXPECT_LT((hub_of(rim, *weights) - Vector3(1, 2, 3)).norm(), 1e-12);
}

// Half of a bore of radius 1 and depth 5, open at z = 0 and at y = 0.
std::vector<Vector3> half_bore() {
  std::vector<Vector3> corners;
  add_arc(corners, Vector3::Zero(), Vector3(1, 0, 0), std::numbers::pi);
  add_line(corners, Vector3(-1, 0, 0), Vector3(-1, 0, 5));
  add_line(corners, Vector3(-1, 0, 5), Vector3(1, 0, 5));
  add_line(corners, Vector3(1, 0, 5), Vector3(1, 0, 0));
  return corners;
}

TEST(Lid, ARimInTwoPlanesHasItsHubOnBoth) {
  const builder::Rim rim = rim_of(half_bore());
  const auto weights = builder::find_hub(rim, quadrant());
  ASSERT_TRUE(weights);
  EXPECT_LT(hub_of(rim, *weights).norm(), 1e-12);
  for (std::size_t k = 0; k < weights->size(); ++k) {
    const bool on_both = std::abs(rim.corners[k].z()) + std::abs(rim.corners[k].y()) < 1e-12;
    EXPECT_EQ((*weights)[k] != 0.0, on_both) << k;
  }
}

TEST(Lid, ARimInThreePlanesNeedsImmovableNodes) {
  std::vector<Vector3> corners;
  add_arc(corners, Vector3::Zero(), Vector3(1, 0, 0), 0.5 * std::numbers::pi);
  add_line(corners, Vector3(0, 1, 0), Vector3(0, 1, 5));
  add_line(corners, Vector3(0, 1, 5), Vector3(0, 0, 5));
  add_line(corners, Vector3(0, 0, 5), Vector3(1, 0, 5));
  add_line(corners, Vector3(1, 0, 5), Vector3(1, 0, 0));
  builder::Rim rim = rim_of(corners);
  EXPECT_FALSE(builder::find_hub(rim, quadrant())) << "nothing holds the hub in three planes";
  for (std::size_t k = 0; k < corners.size(); ++k) rim.held[k] = corners[k].z() == 0.0 ? 1 : 0;
  const auto weights = builder::find_hub(rim, quadrant());
  ASSERT_TRUE(weights);
  EXPECT_LT(hub_of(rim, *weights).norm(), 1e-12);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const bool unused = (*weights)[k] == 0.0;
    EXPECT_TRUE(unused || rim.held[k] != 0) << k;
  }
}

TEST(Lid, ACurvedRimHasNoHubAndAnUncertainVolume) {
  std::vector<Vector3> corners;
  for (int k = 0; k < 24; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 24;
    corners.emplace_back(std::cos(angle), std::sin(angle), 0.3 * std::cos(2.0 * angle));
  }
  const builder::Rim rim = rim_of(corners);
  EXPECT_FALSE(builder::find_hub(rim, quadrant()));
  const builder::RimShape shape = builder::rim_shape(rim);
  EXPECT_NEAR(shape.rise, 0.6, 1e-12);
  // The area of the polygon along z is 12 sin(15 degrees).
  EXPECT_NEAR(shape.area.z(), 12.0 * std::sin(std::numbers::pi / 12.0), 1e-12);
  EXPECT_NEAR(shape.uncertainty(), 0.2 * shape.area.norm(), 1e-12);
}

/// A block of 30 mm with a bore of 10 mm, 15 mm deep, from its bottom, and its parts between planes
/// of symmetry. `parts` of x and y: 1 the whole, 2 its lower half.
struct Bored {
  int along_x = 1, along_y = 1;
  double saddle =
      0.0;  ///< m: rise of the bottom at the middles of two sides, and fall of the others

  Vector3 size() const { return {0.03 / along_x, 0.03 / along_y, 0.03}; }
};

std::shared_ptr<const model::Model> bored(const Bored& part, mesh::Cells cells, bool cap = true) {
  const auto solid = cells == mesh::Cells::hexahedra ? cells : mesh::Cells::tetrahedra;
  mesh::Mesh linear =
      mesh::block({.size = part.size(), .cells = {6 / part.along_x, 6 / part.along_y, 6}}, solid);
  const auto in_bore = [&](const auto& element) {
    Vector3 middle = Vector3::Zero();
    for (const NodeId node : element) middle += linear.nodes.row(node).transpose();
    middle /= static_cast<double>(element.size());
    return std::abs(middle.x() - 0.015) < 0.005 && std::abs(middle.y() - 0.015) < 0.005 &&
           middle.z() < 0.015;
  };
  std::erase_if(linear.hexahedra, in_bore);
  std::erase_if(linear.tetrahedra, in_bore);
  for (Eigen::Index i = 0; i < linear.nodes.rows(); ++i) {
    const double x = linear.nodes(i, 0) - 0.015, y = linear.nodes(i, 1) - 0.015;
    linear.nodes(i, 2) +=
        part.saddle * (x * x - y * y) / (0.015 * 0.015) * (1.0 - linear.nodes(i, 2) / 0.03);
  }
  fem::FemBodySettings body;
  body.name = "block";
  body.mesh = std::make_shared<const mesh::Mesh>(
      cells == mesh::Cells::quadratic ? mesh::with_middle_nodes(linear) : linear);
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(30e3);
  region.hyperelastic->bulk_modulus = material::bulk_modulus_of(30e3, 0.45);
  body.elements.regions = {region};
  body.elements.fixed_nodes = body.mesh->node_sets.at("z_min");
  if (part.along_x == 2) {
    for (const NodeId node : body.mesh->node_sets.at("x_max")) {
      body.elements.held_axes.push_back({node, 0});
    }
  }
  if (part.along_y == 2) {
    for (const NodeId node : body.mesh->node_sets.at("y_max")) {
      body.elements.held_axes.push_back({node, 1});
    }
  }
  builder::ModelBuilder builder;
  const auto mesh = body.mesh;
  builder::ChamberSettings chamber;
  chamber.name = "air";
  chamber.body = builder.add_body<fem::FemBodyModel>(std::move(body));
  std::vector<mesh::Face> faces;
  for (const mesh::Face& face : mesh::boundary_faces(*mesh)) {
    Vector3 middle = Vector3::Zero();
    for (const NodeId node : face.nodes()) middle += mesh->nodes.row(node).transpose();
    middle /= static_cast<double>(face.corners());
    const auto within = [](double at) { return at > 0.0099 && at < 0.0201; };
    // The walls and the end of the bore, none of the planes that it opens to.
    bool in_plane = true;
    for (const NodeId node : face.nodes()) {
      in_plane = in_plane && ((part.along_x == 2 && mesh->nodes(node, 0) > 0.0149) ||
                              (part.along_y == 2 && mesh->nodes(node, 1) > 0.0149));
    }
    if (!in_plane && within(middle.x()) && within(middle.y()) && middle.z() < 0.02 &&
        middle.z() > 0.0005) {
      faces.push_back(face);
    }
  }
  chamber.surface = faces;
  chamber.cap = cap;
  builder.add_chamber(chamber);
  return builder.build();
}

class LidTest : public ::testing::TestWithParam<mesh::Cells> {};

TEST_P(LidTest, PartsOfARobotEncloseTheirPartOfTheVolume) {
  const double whole = 1.5e-6;
  for (const auto& [x, y] : {std::pair(1, 1), {2, 1}, {1, 2}, {2, 2}}) {
    const auto model = bored({x, y}, GetParam());
    EXPECT_NEAR(model->chamber(0)->rest_volume(), whole / (x * y), 1e-12 * whole) << x << y;
  }
}

// The whole block is symmetric, mesh included, so its parts grow alike.
TEST_P(LidTest, PartsOfARobotGrowLikeThePartsOfTheWhole) {
  const auto growth = [&](int x, int y) {
    Simulation simulation(bored({x, y}, GetParam()));
    simulation.command(0, {model::CommandKind::effort, model::Signal::constant(1000.0)});
    simulation.solve_static();
    return x * y * simulation.actuator(0).motion;
  };
  const double whole = growth(1, 1);
  EXPECT_GT(whole, 1e-9);
  for (const auto& [x, y] : {std::pair(2, 1), {1, 2}, {2, 2}}) {
    EXPECT_NEAR(growth(x, y), whole, 1e-6 * whole) << x << y;
  }
}

TEST_P(LidTest, AMouthThatIsNotPlaneIsRefused) {
  EXPECT_NO_THROW(bored({.saddle = 2e-4}, GetParam()));
  EXPECT_EQ(kind_of([] { bored({.saddle = 8e-3}, GetParam()); }), ErrorKind::surface_not_closed);
}

INSTANTIATE_TEST_SUITE_P(Cells, LidTest,
                         ::testing::Values(mesh::Cells::tetrahedra, mesh::Cells::quadratic,
                                           mesh::Cells::hexahedra));

}  // namespace
}  // namespace sinew::sim
