// Built-in shapes, their refinement, and selection of their parts.
#include "sinew/mesh/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include <gmock/gmock.h>

#include "sinew/mesh/check.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/refine.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/scale.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/split_hexahedra.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/mesh/topology.hpp"

#include "support.hpp"

namespace sinew::mesh {
namespace {

using test::error_text;
using testing::HasSubstr;

/// Requires a valid, closed mesh with positively ordered elements whose surface encloses its
/// volume.
MeshReport require_sound(Mesh mesh) {
  check(mesh);
  EXPECT_EQ(mesh.notes.reordered_elements, 0);
  const Surface surface = boundary_surface(mesh);
  EXPECT_NO_THROW(require_closed(surface));
  EXPECT_NEAR(solid_moments(surface).volume / volume(mesh), 1.0, 1e-12);
  return describe(mesh);
}

TEST(Shapes, BlockFillsItsBox) {
  const MeshReport report =
      require_sound(block({.corner = {1, 2, 3}, .size = {0.1, 0.2, 0.3}, .cells = {2, 3, 4}}));
  EXPECT_NEAR(report.volume, 0.006, 1e-15);
  EXPECT_EQ(report.nodes, 3 * 4 * 5);
  EXPECT_EQ(report.tetrahedra, 6 * 2 * 3 * 4);
  EXPECT_NEAR((report.low - Vector3(1, 2, 3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((report.high - Vector3(1.1, 2.2, 3.3)).norm(), 0.0, 1e-15);
}

/// The elements, each as its sorted corners, with the nodes of the mirror image along an axis.
std::set<std::array<NodeId, 4>> mirrored(const Mesh& mesh, int axis, bool mirror) {
  const double high = mesh.nodes.col(axis).maxCoeff(), low = mesh.nodes.col(axis).minCoeff();
  std::map<std::array<long, 3>, NodeId> at;
  const auto key = [&](const Vector3& x) {
    return std::array{std::lround(1e6 * x.x()), std::lround(1e6 * x.y()), std::lround(1e6 * x.z())};
  };
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    at[key(mesh.nodes.row(node).transpose())] = node;
  }
  std::set<std::array<NodeId, 4>> result;
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    std::array<NodeId, 4> corners{};
    for (std::size_t k = 0; k < 4; ++k) {
      Vector3 x = mesh.nodes.row(tetrahedron[k]).transpose();
      if (mirror) x[axis] = high + low - x[axis];
      corners[k] = at.at(key(x));
    }
    std::ranges::sort(corners);
    result.insert(corners);
  }
  return result;
}

TEST(Shapes, BlockOfTetrahedraIsItsOwnMirrorImage) {
  const Mesh mesh = block({.size = {0.06, 0.02, 0.04}, .cells = {6, 2, 4}});
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(mirrored(mesh, axis, true), mirrored(mesh, axis, false)) << axis;
  }
  const Mesh finger = ribbed_finger({.ribs = 3, .rib_cells = 2, .width_cells = 4});
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_EQ(mirrored(finger, axis, true), mirrored(finger, axis, false)) << axis;
  }
}

TEST(Shapes, HexahedraSplitIntoTetrahedraThatFit) {
  const Mesh hexahedra = cylinder({.rings = 3, .layers = 4}, Cells::hexahedra);
  const Mesh split = split_hexahedra(hexahedra);
  EXPECT_EQ(split.nodes, hexahedra.nodes);
  EXPECT_EQ(require_sound(split).tetrahedra, 6 * static_cast<int>(hexahedra.hexahedra.size()));
  EXPECT_NEAR(volume(split), volume(hexahedra), 1e-12 * volume(hexahedra));
}

TEST(Shapes, HexahedralBlockMatchesTheTetrahedralOne) {
  const BlockShape shape{.size = {0.1, 0.2, 0.3}, .cells = {2, 3, 4}};
  const Mesh hexahedra = block(shape, Cells::hexahedra), tetrahedra = block(shape);
  EXPECT_EQ(hexahedra.nodes, tetrahedra.nodes);
  EXPECT_EQ(hexahedra.node_sets, tetrahedra.node_sets);
  EXPECT_EQ(require_sound(hexahedra).hexahedra, 24);
}

TEST(Shapes, RoundSolidsHaveTheirVolume) {
  EXPECT_NEAR(
      require_sound(cylinder({.radius = 0.01, .height = 0.1, .rings = 3, .layers = 5})).volume,
      std::numbers::pi * 1e-4 * 0.1, 1e-15);
  // V = pi h/3 (r0^2 + r0 r1 + r1^2). The twisted faces of the tetrahedra give it to second order
  // in the layer height only.
  const double taper = std::numbers::pi * 0.1 / 3 * (4e-4 + 2e-4 + 1e-4);
  EXPECT_NEAR(require_sound(cone({})).volume / taper, 1.0, 2e-3);
  const HollowCylinderShape tube{.around = 30};
  EXPECT_NEAR(require_sound(hollow_cylinder(tube)).volume,
              std::numbers::pi * (1.44e-4 - 0.64e-4) * 0.05, 1e-15);
}

TEST(Shapes, QuadraticTetrahedraFollowTheCircle) {
  const Mesh mesh =
      cylinder({.radius = 0.01, .height = 0.02, .rings = 2, .layers = 2}, Cells::quadratic);
  int on = 0;
  for (const NodeId node : mesh.node_sets.at("side")) {
    const double radius = mesh.nodes.row(node).head<2>().norm();
    if (node >= 3 * 19) {
      EXPECT_NEAR(radius, 0.01, 1e-15);
    }
    on += std::abs(radius - 0.01) < 1e-12 ? 1 : 0;
  }
  EXPECT_GT(on, 3 * 12 + 2 * 12);
  // With four triangles per curved face, the surface is much nearer to the circle than a polygon of
  // 12 corners.
  const double volume = solid_moments(boundary_surface(mesh)).volume;
  EXPECT_NEAR(volume / (std::numbers::pi * 1e-4 * 0.02), 1.0, 0.015);
}

TEST(Shapes, TheChamberIsAVoidOfItsVolume) {
  const ChamberedCylinderShape shape{.chamber_bottom = 0.005};
  const double whole = std::numbers::pi * shape.radius * shape.radius * shape.height;
  const double chamber = std::numbers::pi * shape.chamber_radius * shape.chamber_radius * 0.055;
  for (const Cells cells : {Cells::tetrahedra, Cells::hexahedra}) {
    const Mesh mesh = chambered_cylinder(shape, cells);
    EXPECT_NEAR(require_sound(mesh).volume, whole - chamber, 1e-13);
    const auto wall = enclosing_surface(mesh, {shape.chamber_offset, 0.0, 0.03}, "chamber");
    EXPECT_EQ(wall.size(), select_faces(mesh, NamedRegion{"chamber"}, "chamber").size());
    EXPECT_TRUE(open_loops(wall).empty());
    ChamberedCylinderShape open = shape;
    open.chamber_bottom = 0.0;
    const Mesh bore = chambered_cylinder(open, cells);
    const auto loops = open_loops(select_faces(bore, NamedRegion{"chamber"}, "chamber"));
    ASSERT_EQ(loops.size(), 1U);
    EXPECT_EQ(loops.front().size(), 16U);
  }
  ChamberedCylinderShape wide = shape;
  wide.chamber_offset = 0.01;
  EXPECT_THROW(chambered_cylinder(wide), Error);
}

struct HexahedraMeasures {
  double volume = 0.0;          // m^3, by the elements' quadrature
  double least_jacobian = 1.0;  // relative to its mean, at the quadrature points
};

HexahedraMeasures measure_hexahedra(const Mesh& mesh) {
  HexahedraMeasures result;
  for (const Hexahedron& nodes : mesh.hexahedra) {
    Eigen::Matrix<double, 8, 3> x;
    for (int a = 0; a < 8; ++a) x.row(a) = mesh.nodes.row(nodes[static_cast<std::size_t>(a)]);
    double least = std::numeric_limits<double>::infinity(), sum = 0.0;
    for (const Vector3& point : hexahedron_points()) {
      const double j = (x.transpose() * hexahedron_gradients(point)).determinant();
      least = std::min(least, j);
      sum += j;
    }
    result.volume += sum;
    result.least_jacobian = std::min(result.least_jacobian, 8.0 * least / sum);
  }
  return result;
}

TEST(Shapes, RoundSolidsOfHexahedraHaveTheirVolume) {
  // 2, 3, 4 and 5 rings have a core of 2, 4, 4 and 6 cells per side.
  for (const auto& [rings, around] : {std::pair(2, 8), {3, 16}, {4, 16}, {5, 24}}) {
    const Mesh mesh =
        cylinder({.radius = 0.01, .height = 0.1, .rings = rings, .layers = 5}, Cells::hexahedra);
    const MeshReport report = require_sound(mesh);
    EXPECT_NEAR(report.volume, std::numbers::pi * 1e-4 * 0.1, 1e-15) << rings;
    EXPECT_EQ(report.tetrahedra, 0);
    EXPECT_EQ(mesh.node_sets.at("side").size(), static_cast<std::size_t>(6 * around)) << rings;
    // No cell is degenerate: its smallest Jacobian is a good part of its mean.
    EXPECT_GT(measure_hexahedra(mesh).least_jacobian, 0.5);
  }
  EXPECT_NEAR(require_sound(hollow_cylinder({.around = 30}, Cells::hexahedra)).volume,
              std::numbers::pi * (1.44e-4 - 0.64e-4) * 0.05, 1e-15);
  const double taper = std::numbers::pi * 0.1 / 3 * (4e-4 + 2e-4 + 1e-4);
  EXPECT_NEAR(require_sound(cone({}, Cells::hexahedra)).volume / taper, 1.0, 2e-3);
  EXPECT_EQ(require_sound(trunk({}, Cells::hexahedra)).tetrahedra, 0);
  error_text(ErrorKind::out_of_range, [] { cylinder({.rings = 1}, Cells::hexahedra); });
}

TEST(Shapes, AreOfGoodQuality) {
  EXPECT_GT(require_sound(cylinder({})).min_radius_ratio, 0.3);
  EXPECT_GT(require_sound(cone({})).min_radius_ratio, 0.3);
  EXPECT_GT(require_sound(hollow_cylinder({})).min_radius_ratio, 0.3);
}

constexpr double kBall = 4.0 / 3.0 * std::numbers::pi * 1e-6;  // m^3, radius 10 mm
constexpr double kTube = std::numbers::pi * 1e-4 * 0.03;       // m^3, 30 mm long

TEST(Shapes, BallsAndCapsulesHaveTheirVolume) {
  for (const int rings : {1, 2, 3, 4, 5}) {
    const MeshReport ball = require_sound(sphere({.radius = 0.01, .rings = rings}));
    EXPECT_NEAR(ball.volume / kBall, 1.0, 1e-12) << rings;
    EXPECT_EQ(ball.tetrahedra, 12 * rings * rings * rings);
    EXPECT_GT(ball.min_radius_ratio, 0.55) << rings;
    const MeshReport lengthy = require_sound(
        capsule({.radius = 0.01, .length = 0.03, .rings = rings, .layers = 3 * rings}));
    EXPECT_NEAR(lengthy.volume / (kBall + kTube), 1.0, 1e-12) << rings;
    EXPECT_GT(lengthy.min_radius_ratio, 0.4) << rings;
  }
}

TEST(Shapes, BallsAndCapsulesOfHexahedraHaveTheirVolume) {
  for (const int rings : {2, 3, 4, 5}) {
    Mesh ball = sphere({.radius = 0.01, .rings = rings}, Cells::hexahedra);
    Mesh lengthy = capsule({.radius = 0.01, .length = 0.03, .rings = rings, .layers = 3 * rings},
                           Cells::hexahedra);
    for (Mesh* mesh : {&ball, &lengthy}) {
      check(*mesh);
      EXPECT_NO_THROW(require_closed(boundary_surface(*mesh)));
      EXPECT_TRUE(mesh->tetrahedra.empty());
      const HexahedraMeasures measures = measure_hexahedra(*mesh);
      EXPECT_NEAR(measures.volume / (mesh == &ball ? kBall : kBall + kTube), 1.0, 1e-12) << rings;
      EXPECT_GT(measures.least_jacobian, 0.45) << rings;
    }
  }
}

TEST(Shapes, TheSurfaceOfABallIsOneOfItsSets) {
  for (const Cells cells : {Cells::tetrahedra, Cells::hexahedra, Cells::quadratic}) {
    for (const double length : {0.0, 0.03}) {
      const Mesh mesh =
          length == 0.0
              ? sphere({.radius = 0.01, .rings = 3}, cells)
              : capsule({.radius = 0.01, .length = length, .rings = 3, .layers = 3}, cells);
      const std::vector<NodeId> nodes = outer_nodes(mesh);
      EXPECT_EQ(mesh.node_sets.at("surface"), nodes);
      const double end = 0.5 * length;
      for (const NodeId node : mesh.node_sets.at("top"))
        EXPECT_GE(mesh.nodes(node, 2), end - 1e-15);
      for (const NodeId node : mesh.node_sets.at("bottom")) {
        EXPECT_LE(mesh.nodes(node, 2), -end + 1e-15);
      }
      // All surface nodes, middle nodes included, have the same distance from the axis segment;
      // with quadratic elements it equals the radius.
      const auto distance = [&](NodeId node) {
        const Vector3 x = mesh.nodes.row(node).transpose();
        return (x - Vector3(0.0, 0.0, std::clamp(x.z(), -end, end))).norm();
      };
      const double radius = cells == Cells::quadratic ? 0.01 : distance(nodes.front());
      for (const NodeId node : nodes) EXPECT_NEAR(distance(node), radius, 1e-15);
      EXPECT_LT(radius, 0.0108);
    }
  }
}

TEST(Shapes, AQuadraticBallIsRound) {
  const Mesh mesh = sphere({.radius = 0.01, .rings = 3}, Cells::quadratic);
  const double volume = solid_moments(boundary_surface(mesh)).volume;  // four triangles per face
  EXPECT_NEAR(volume / kBall, 1.0, 0.03);
}

TEST(Shapes, ARibbedFingerIsItsBoxWithoutTheGaps) {
  const RibbedFingerShape shape{
      .size = {0.1, 0.02, 0.015}, .spine = 0.005, .gap = 0.004, .ribs = 6};
  for (const Cells cells : {Cells::tetrahedra, Cells::hexahedra}) {
    const Mesh mesh = ribbed_finger(shape, cells);
    const MeshReport report = require_sound(mesh);
    EXPECT_NEAR(report.volume, 0.1 * 0.02 * 0.015 - 5 * 0.004 * 0.02 * 0.010, 1e-15);
    EXPECT_NEAR(report.low.norm(), 0.0, 1e-15);
    EXPECT_NEAR((report.high - shape.size).norm(), 0.0, 1e-15);
    EXPECT_EQ(report.unused_nodes, 0);
    EXPECT_EQ(mesh.node_sets.at("z_max").size(), 6u * 3u * 4u);
    EXPECT_EQ(mesh.node_sets.at("x_max").size(), 4u * 4u);
  }
}

TEST(Scale, AMirrorImageIsSound) {
  Mesh mesh = ribbed_finger({}, Cells::quadratic);
  mesh.triangles = boundary_surface(ribbed_finger({})).triangles;
  const double before = volume(mesh);
  scale(mesh, {2.0, 1.0, -0.5});
  check(mesh);
  EXPECT_EQ(mesh.notes.reordered_elements, 0);
  EXPECT_NEAR(volume(mesh), before, 1e-12 * before);
  EXPECT_NEAR(mesh.nodes.col(2).minCoeff(), -0.01, 1e-15);
  const Surface outside{.name = "own", .nodes = mesh.nodes, .triangles = mesh.triangles};
  EXPECT_NEAR(solid_moments(outside).volume, before, 1e-12 * before);
  Surface surface = boundary_surface(sphere({}));
  const double ball = solid_moments(surface).volume;
  scale(surface, {-1.0, 1.0, 3.0});
  EXPECT_NEAR(solid_moments(surface).volume, 3.0 * ball, 1e-12 * ball);
}

TEST(Shapes, TrunkHasBellowsAndRoomForCables) {
  const Mesh mesh = trunk();
  const MeshReport report = require_sound(mesh);
  EXPECT_EQ(report.nodes, 703);
  EXPECT_EQ(report.tetrahedra, 2592);
  EXPECT_NEAR(report.high.z(), 0.195, 1e-15);
  EXPECT_NEAR(report.high.x(), 0.020, 1e-4);
  EXPECT_GT(report.min_radius_ratio, 0.45);
  EXPECT_GT(report.min_dihedral, 20.0);
  EXPECT_LT(report.max_dihedral, 140.0);
  const Embedder embedder(mesh);
  EXPECT_EQ(embedder.locate({0, 0, 0.195}, Outside::error, "tip").distance, 0.0);
  // The lines of the cables, from 10 mm to 2 mm beside the axis, lie inside the mesh.
  for (int cable = 0; cable < 4; ++cable) {
    for (int k = 0; k <= 40; ++k) {
      const double z = 0.19 * k / 40, radius = 0.010 - 0.008 * z / 0.195;
      const Vector3 via(radius * std::cos(cable * std::numbers::pi / 2),
                        radius * std::sin(cable * std::numbers::pi / 2), z);
      EXPECT_NO_THROW(embedder.locate(via, Outside::error, "via")) << via.transpose();
    }
  }
}

TEST(Shapes, RefuseMeasuresThatMakeNoBody) {
  error_text(ErrorKind::out_of_range, [] { block({.size = {0.1, 0.0, 0.1}}); });
  error_text(ErrorKind::out_of_range, [] { block({.cells = {1, 0, 1}}); });
  error_text(ErrorKind::out_of_range, [] { cylinder({.radius = -1.0}); });
  error_text(ErrorKind::out_of_range, [] { cone({.top_radius = 0.0}); });
  error_text(ErrorKind::out_of_range, [] { hollow_cylinder({.inner_radius = 0.02}); });
  error_text(ErrorKind::out_of_range, [] { trunk({.groove_depth = 0.9}); });
  error_text(ErrorKind::out_of_range, [] { trunk({.height = std::nan("")}); });
  error_text(ErrorKind::out_of_range, [] { sphere({.radius = 0.0}); });
  error_text(ErrorKind::out_of_range, [] { sphere({.rings = 1}, Cells::hexahedra); });
  error_text(ErrorKind::out_of_range, [] { capsule({.length = -0.01}); });
  error_text(ErrorKind::out_of_range, [] { ribbed_finger({.spine = 0.02}); });
  error_text(ErrorKind::out_of_range, [] { ribbed_finger({.gap = 0.02, .ribs = 6}); });
  error_text(ErrorKind::out_of_range, [] { ribbed_finger({.ribs = 1}); });
}

TEST(Refine, KeepsVolumeOrientationAndQuality) {
  const Mesh coarse = trunk();
  const Mesh fine = refine(coarse);
  EXPECT_EQ(fine.tetrahedra.size(), 8 * coarse.tetrahedra.size());
  EXPECT_EQ(fine.nodes.topRows(coarse.node_count()), coarse.nodes);
  EXPECT_NEAR(volume(fine) / volume(coarse), 1.0, 1e-12);
  const double before = describe(coarse).min_radius_ratio;
  const MeshReport first = require_sound(fine), second = require_sound(refine(fine));
  EXPECT_GT(first.min_radius_ratio, 0.4 * before);
  EXPECT_GT(second.min_radius_ratio, 0.4 * before) << "repeated refinement goes on as it began";
}

TEST(Refine, CarriesSets) {
  Mesh coarse = block({.size = {0.2, 0.1, 0.1}, .cells = {4, 2, 2}});
  coarse.tetrahedron_sets["left"] = {};
  for (NodeId e = 0; e < static_cast<NodeId>(coarse.tetrahedra.size()); ++e) {
    const auto corners = corners_of(coarse, e);
    if ((corners[0] + corners[1] + corners[2] + corners[3]).x() / 4 < 0.1) {
      coarse.tetrahedron_sets["left"].push_back(e);
    }
  }
  coarse.triangles = boundary_surface(coarse).triangles;
  coarse.triangle_sets["first"] = {0};
  const Mesh fine = refine(coarse);
  double left = 0.0;
  for (const NodeId e : fine.tetrahedron_sets.at("left"))
    left += signed_volume(corners_of(fine, e));
  EXPECT_NEAR(left, 0.1 * 0.1 * 0.1, 1e-15);
  EXPECT_EQ(fine.triangles.size(), 4 * coarse.triangles.size());
  EXPECT_EQ(fine.triangle_sets.at("first").size(), 4u);
  EXPECT_EQ(fine.node_sets.at("x_min").size(), 25u);
  for (const NodeId node : fine.node_sets.at("x_min")) EXPECT_EQ(fine.nodes(node, 0), 0.0);
  const Surface boundary = boundary_surface(fine);
  EXPECT_EQ(boundary.triangles.size(), fine.triangles.size());
  error_text(ErrorKind::unsupported_element, [] { refine(block({}, Cells::hexahedra)); });
}

TEST(Selection, PicksNodesByPlace) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}});
  const auto count = [&](const Region& region) { return select_nodes(mesh, region, "r").size(); };
  EXPECT_EQ(count(BoxRegion{{0, 0, 0}, {0.1, 0.1, 0}}), 9u);
  EXPECT_EQ(count(BoxRegion{{0, 0, 0.1 + 1e-12}, {0.1, 0.1, 0.1 + 1e-12}}), 9u) << "rounding";
  EXPECT_EQ(count(SphereRegion{{0.05, 0.05, 0.05}, 0.05}), 7u);
  EXPECT_EQ(count(SphereRegion{{0.05, 0.05, 0.05}, 0.04}), 1u);
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(count(PlaneRegion{{0, 0, 0.05}, {0, 0, 3}, -inf, 0.0}), 18u);
  EXPECT_EQ(count(PlaneRegion{{0, 0, 0}, {1, 1, 0}, 0.05, 0.1}), 6u + 3u);
  EXPECT_EQ(count(NamedRegion{"y_max"}), 9u);
}

TEST(Selection, ExplainsEmptyAndSenselessRegions) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}});
  const auto refused = [&](ErrorKind kind, const Region& region) {
    return error_text(kind, [&] { select_nodes(mesh, region, "bodies.a.fixed[0]"); });
  };
  const std::string text = refused(ErrorKind::empty_region, BoxRegion{{-20, -20, 5}, {20, 20, 20}});
  EXPECT_THAT(text, HasSubstr("(0, 0, 0) to (0.1, 0.1, 0.1) m"));
  EXPECT_THAT(text, HasSubstr("bodies.a.fixed[0]"));
  refused(ErrorKind::empty_region, SphereRegion{{1, 1, 1}, 0.1});
  refused(ErrorKind::out_of_range, BoxRegion{{1, 0, 0}, {0, 1, 1}});
  refused(ErrorKind::out_of_range, SphereRegion{{0, 0, 0}, 0.0});
  refused(ErrorKind::out_of_range, PlaneRegion{{0, 0, 0}, {0, 0, 0}, 0, 1});
  refused(ErrorKind::out_of_range, PlaneRegion{{0, 0, 0}, {0, 0, 1}, 1, 0});
  refused(ErrorKind::not_finite, SphereRegion{{0, 0, std::nan("")}, 0.1});
  EXPECT_THAT(refused(ErrorKind::unknown_set, NamedRegion{"z_mn"}),
              HasSubstr("did you mean `z_mi"));
  EXPECT_THAT(error_text(ErrorKind::unknown_set,
                         [] { select_nodes(test::one_tetrahedron(), NamedRegion{"a"}, "r"); }),
              HasSubstr("no sets"));
}

TEST(Selection, LeavesUnusedNodesOut) {
  Mesh mesh = test::one_tetrahedron();
  mesh.nodes.conservativeResize(5, 3);
  mesh.nodes.row(4) << 0.5, 0.5, 0.5;
  mesh.node_sets["stray"] = {4};
  mesh.tetrahedron_sets["body"] = {0};
  EXPECT_EQ(select_nodes(mesh, BoxRegion{{0, 0, 0}, {1, 1, 1}}, "r").size(), 4u);
  error_text(ErrorKind::empty_region, [&] { select_nodes(mesh, NamedRegion{"stray"}, "r"); });
  EXPECT_EQ(select_nodes(mesh, NamedRegion{"body"}, "r").size(), 4u);
  EXPECT_EQ(select_tetrahedra(mesh, "body", "r").size(), 1u);
  error_text(ErrorKind::unknown_set, [&] { select_tetrahedra(mesh, "bdy", "r"); });
}

}  // namespace
}  // namespace sinew::mesh
