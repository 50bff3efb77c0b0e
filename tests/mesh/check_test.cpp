// Checks of meshes: which differences are conventions, which are defects, and how each is reported.
#include "sinew/mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <gmock/gmock.h>

#include "sinew/mesh/duplicates.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/shapes.hpp"

#include "support.hpp"

namespace sinew::mesh {
namespace {

using test::error_text;
using test::one_tetrahedron;
using test::two_tetrahedra;
using testing::AllOf;
using testing::HasSubstr;

std::string refused(ErrorKind kind, Mesh mesh, const CheckOptions& options = {}) {
  return error_text(kind, [&] { check(mesh, options); });
}

Mesh small_block() { return block({.size = {0.1, 0.1, 0.1}, .cells = {3, 3, 3}}); }

TEST(Check, PassesSoundMeshesUnchanged) {
  Mesh mesh = small_block();
  const auto before = mesh.tetrahedra;
  check(mesh);
  EXPECT_EQ(mesh.tetrahedra, before);
  EXPECT_EQ(mesh.notes.reordered_elements, 0);
}

TEST(Check, ReordersElementsOfTheOtherConvention) {
  for (const std::size_t every : {1u, 3u}) {  // all of them, and a third
    Mesh mesh = small_block();
    const double sound = volume(mesh);
    int turned = 0;
    for (std::size_t e = 0; e < mesh.tetrahedra.size(); e += every) {
      std::swap(mesh.tetrahedra[e][0], mesh.tetrahedra[e][1]);
      ++turned;
    }
    check(mesh);
    EXPECT_EQ(mesh.notes.reordered_elements, turned);
    EXPECT_NEAR(volume(mesh), sound, 1e-15);
  }
}

TEST(Check, TellsInvertedElementsFromReorderedOnes) {
  // An inner node is displaced through the opposite faces of some of its elements.
  Mesh mesh = small_block();
  const NodeId inner = 1 + 4 * (1 + 4 * 1);
  mesh.nodes.row(inner) += Vector3(0.05, 0.05, 0.05).transpose();
  const std::string text = refused(ErrorKind::inverted_element, mesh);
  EXPECT_THAT(text, AllOf(HasSubstr("same side of their common face"), HasSubstr("tetrahedra ")));
}

TEST(Check, FindsAnElementFoldedOntoItsNeighbour) {
  Mesh mesh = two_tetrahedra();
  mesh.nodes.row(4) << 0.01, 0.01, 0.01;  // on the same side of face (1, 2, 3) as node 0
  const std::string text = refused(ErrorKind::inverted_element, mesh);
  EXPECT_THAT(text, AllOf(HasSubstr("tetrahedra 0 and 1"), HasSubstr("(nodes 1, 2, 3)")));
}

TEST(Check, FindsAnElementThatIsThereTwice) {
  Mesh mesh = two_tetrahedra();
  mesh.tetrahedra.push_back(mesh.tetrahedra[1]);
  refused(ErrorKind::inverted_element, mesh);
}

TEST(Check, RefusesFlatElements) {
  Mesh mesh = one_tetrahedron();
  mesh.nodes(3, 2) = 1e-9;
  EXPECT_THAT(refused(ErrorKind::zero_volume, mesh),
              AllOf(HasSubstr("tetrahedron 0 (nodes 0, 1, 2, 3)"), HasSubstr("volume")));
  mesh.nodes(3, 2) = 0.0;
  mesh.nodes(3, 0) = 0.03;
  mesh.nodes(3, 1) = 0.03;
  refused(ErrorKind::zero_volume, mesh);
}

TEST(Check, JudgesFlatnessBySizeNotByUnits) {
  for (const double scale : {1e-6, 1.0, 50.0}) {
    Mesh mesh = one_tetrahedron();
    mesh.nodes *= scale;
    EXPECT_NO_THROW(check(mesh)) << scale;
  }
}

TEST(Check, RefusesRepeatedNodesInAnElement) {
  Mesh mesh = two_tetrahedra();
  mesh.tetrahedra[1][3] = 2;
  EXPECT_THAT(refused(ErrorKind::repeated_node_in_element, mesh),
              HasSubstr("tetrahedron 1 names a node twice: 1, 2, 3, 2"));
}

TEST(Check, RefusesDuplicateNodesNamingBoth) {
  Mesh mesh = two_tetrahedra();
  mesh.nodes.conservativeResize(6, 3);
  mesh.nodes.row(5) = mesh.nodes.row(2);
  mesh.tetrahedra[1][1] = 5;
  EXPECT_THAT(refused(ErrorKind::duplicate_node, mesh), HasSubstr("nodes 2 and 5"));
}

TEST(Check, LetsUnusedNodesPassAndCountsThem) {
  Mesh mesh = one_tetrahedron();
  mesh.nodes.conservativeResize(6, 3);
  mesh.nodes.row(4) << 0.05, 0.05, 0.05;
  mesh.nodes.row(5) = mesh.nodes.row(0);  // unused, so the same position does no harm
  EXPECT_NO_THROW(check(mesh));
  EXPECT_EQ(describe(mesh).unused_nodes, 2);
}

TEST(Check, RefusesNumbersThatAreNone) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mesh mesh = one_tetrahedron();
    mesh.nodes(2, 1) = bad;
    EXPECT_THAT(refused(ErrorKind::non_finite_node, mesh), HasSubstr("node 2"));
  }
}

TEST(Check, RefusesIndicesOutOfRange) {
  Mesh mesh = one_tetrahedron();
  mesh.tetrahedra[0][2] = 4;
  EXPECT_THAT(refused(ErrorKind::index_out_of_range, mesh), HasSubstr("uses node 4"));
  mesh.tetrahedra[0][2] = -1;
  refused(ErrorKind::index_out_of_range, mesh);
  mesh = one_tetrahedron();
  mesh.node_sets["grip"] = {0, 9};
  EXPECT_THAT(refused(ErrorKind::index_out_of_range, mesh), HasSubstr("`grip`"));
}

TEST(Check, RefusesSeveralPartsUnlessAllowed) {
  Mesh mesh = one_tetrahedron();
  mesh.nodes.conservativeResize(8, 3);
  mesh.nodes.bottomRows(4) = mesh.nodes.topRows(4).rowwise() + Vector3(1, 0, 0).transpose();
  mesh.tetrahedra.push_back({4, 5, 6, 7});
  EXPECT_THAT(refused(ErrorKind::disconnected_mesh, mesh),
              AllOf(HasSubstr("2 parts"), HasSubstr("1 elements (with node 4)")));
  EXPECT_NO_THROW(check(mesh, {.allow_several_components = true}));
}

TEST(Check, RefusesMeshesWithoutVolume) {
  Mesh mesh = one_tetrahedron();
  mesh.tetrahedra.clear();
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THAT(refused(ErrorKind::no_volume_elements, mesh), HasSubstr("sinew mesh"));
}

TEST(Check, SuspectsTheUnitOfHugeMeshes) {
  Mesh mesh = one_tetrahedron();
  mesh.nodes *= 1950.0;
  EXPECT_THAT(refused(ErrorKind::suspicious_unit, mesh),
              AllOf(HasSubstr("195 m large"), HasSubstr("unit: mm")));
  EXPECT_NO_THROW(check(mesh, {.unit_given = true}));
}

TEST(Check, TurnsAndRefusesHexahedra) {
  Mesh mesh = block({.cells = {2, 1, 1}}, Cells::hexahedra);
  const double sound = volume(mesh);
  std::swap_ranges(mesh.hexahedra[0].begin(), mesh.hexahedra[0].begin() + 4,
                   mesh.hexahedra[0].begin() + 4);
  check(mesh);
  EXPECT_EQ(mesh.notes.reordered_elements, 1);
  EXPECT_NEAR(volume(mesh), sound, 1e-15);
  std::swap(mesh.hexahedra[1][1], mesh.hexahedra[1][2]);  // a twisted bottom
  refused(ErrorKind::inverted_element, mesh);
}

TEST(Check, RefusesHexahedraThatMeetTetrahedra) {
  Mesh mesh = block({.cells = {2, 1, 1}}, Cells::hexahedra);
  const Mesh tetrahedra = block({.cells = {2, 1, 1}}, Cells::tetrahedra);
  const Hexahedron second = mesh.hexahedra[1];
  mesh.hexahedra.pop_back();
  for (const Tetrahedron& t : tetrahedra.tetrahedra) {
    const bool of_second = std::ranges::all_of(
        t, [&](NodeId node) { return std::ranges::find(second, node) != second.end(); });
    if (of_second) mesh.tetrahedra.push_back(t);
  }
  ASSERT_GE(mesh.tetrahedra.size(), 5U);
  const std::vector<Defect> defects = find_defects(mesh);
  ASSERT_EQ(defects.size(), 1U);
  EXPECT_EQ(defects.front().kind, ErrorKind::unsupported_element);
  EXPECT_NE(defects.front().message.find("(2 such in all)"), std::string::npos)
      << defects.front().message;
  // Side by side without a common face they are valid, but form two parts.
  for (auto& nodes : mesh.tetrahedra) {
    for (NodeId& node : nodes) node += mesh.node_count();
  }
  const Points own = mesh.nodes;
  mesh.nodes.resize(2 * own.rows(), 3);
  mesh.nodes << own, own.rowwise() + Eigen::RowVector3d(0.5, 0.0, 0.0);
  EXPECT_TRUE(find_defects(mesh, {.allow_several_components = true}).empty());
}

TEST(Check, ListsAllKindsOfDefectsAtOnce) {
  Mesh mesh = two_tetrahedra();
  mesh.nodes *= 1000.0;
  mesh.tetrahedra[1][3] = 2;
  const auto defects = find_defects(mesh);
  ASSERT_GE(defects.size(), 2u);
  EXPECT_EQ(defects[0].kind, ErrorKind::suspicious_unit);
  EXPECT_EQ(defects[1].kind, ErrorKind::repeated_node_in_element);
}

TEST(Duplicates, AreFoundWithinTheToleranceAcrossCells) {
  Points points(5, 3);
  points << 0, 0, 0, 1, 1, 1, 0.5, 0.5, 0.5, 0.5 + 1e-10, 0.5 - 1e-10, 0.5, 0.5 + 1e-6, 0.5, 0.5;
  const auto pairs = find_duplicate_nodes(points, {}, 1e-9);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0], std::pair(NodeId{2}, NodeId{3}));
}

TEST(Quality, OfRegularAndFlatTetrahedra) {
  const Corners regular = {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1),
                           Vector3(-1, -1, 1)};
  EXPECT_NEAR(radius_ratio(regular), 1.0, 1e-14);
  EXPECT_NEAR(std::abs(signed_volume(regular)), 8.0 / 3.0, 1e-14);
  for (const double angle : dihedral_angles(regular)) {
    EXPECT_NEAR(angle, std::acos(1.0 / 3.0), 1e-14);
  }
  // The corner of a cube: r = 1 / (3 + sqrt 3), R = sqrt 3 / 2.
  const Corners corner = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)};
  EXPECT_NEAR(radius_ratio(corner), 3.0 / (3.0 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2.0), 1e-14);
  const Corners flat = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(0, 1, 0)};
  EXPECT_EQ(radius_ratio(flat), 0.0);
}

TEST(Report, TellsWhatAUserWantsToKnow) {
  Mesh mesh = small_block();
  mesh.name = "cube";
  const MeshReport report = describe(mesh);
  EXPECT_EQ(report.nodes, 64);
  EXPECT_EQ(report.tetrahedra, 162);
  EXPECT_NEAR(report.volume, 1e-3, 1e-15);
  EXPECT_NEAR(report.surface_area, 0.06, 1e-14);
  EXPECT_NEAR(report.min_dihedral, 45.0, 1e-9);
  EXPECT_NEAR(report.max_dihedral, 90.0, 1e-9);
  EXPECT_EQ(std::accumulate(report.dihedral.counts.begin(), report.dihedral.counts.end(), 0),
            6 * 162);
  EXPECT_EQ(report.components.element_count, std::vector<int>{162});
  EXPECT_TRUE(report.defects.empty());
  const std::string text = format_report(report);
  EXPECT_THAT(text, AllOf(HasSubstr("100 mm x 100 mm x 100 mm"), HasSubstr("x_min: 16 nodes"),
                          HasSubstr("1000 cm^3"), HasSubstr("defects      none")));
}

// Products of such lengths overflow, and qualities become nan.
TEST(Report, NamesNodesThatAreTooFarAway) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double far : {1e13, 1e39, 1e103, 1e155, 1e308, -1e308, kInfinity, -kInfinity,
                           std::numeric_limits<double>::quiet_NaN()}) {
    Mesh mesh = one_tetrahedron();
    mesh.nodes(1, 0) = far;
    const MeshReport report = describe(mesh, {.unit_given = true});
    ASSERT_EQ(report.defects.size(), 1U) << far;
    EXPECT_EQ(report.defects.front().kind, ErrorKind::non_finite_node) << far;
    EXPECT_THAT(report.defects.front().message, HasSubstr("node 1")) << far;
    EXPECT_NO_THROW(format_report(report));
  }
  for (const double size : {1e-320, 1e-200, 1e-100, 1e-30, 1e3, 1e11}) {
    Mesh mesh = one_tetrahedron();
    mesh.nodes *= size;
    const MeshReport report = describe(mesh, {.unit_given = true});
    EXPECT_FALSE(std::isnan(report.mean_radius_ratio)) << size;
    EXPECT_FALSE(format_report(report).empty());
  }
}

TEST(Report, DescribesDefectiveMeshesWithoutThrowing) {
  Mesh mesh = two_tetrahedra();
  mesh.nodes(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(format_report(describe(mesh)), HasSubstr("[non-finite-node]"));
  mesh = one_tetrahedron();
  mesh.tetrahedra.clear();
  EXPECT_THAT(format_report(describe(mesh)), HasSubstr("[no-volume-elements]"));
  EXPECT_THAT(format_report(describe(Mesh{})), HasSubstr("[no-volume-elements]"));
}

}  // namespace
}  // namespace sinew::mesh
