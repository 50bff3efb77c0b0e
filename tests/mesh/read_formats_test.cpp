// Every format and encoding, written by meshio, Gmsh and a Python encoder (make_fixtures.py).
#include <algorithm>
#include <vector>

#include <gmock/gmock.h>

#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"

#include "support.hpp"

namespace sinew::mesh {
namespace {

using test::data_folder;
using testing::ElementsAre;

std::vector<std::string> fixtures(const std::string& prefix) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder())) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

class Cube : public testing::TestWithParam<std::string> {};

TEST_P(Cube, HasItsNodesElementsAndSets) {
  const Mesh mesh = read_mesh(data_folder() / GetParam());
  ASSERT_EQ(mesh.node_count(), 8);
  const std::vector<double> sixth_node = {0.1, 0.0, 0.1};
  for (Eigen::Index a = 0; a < 3; ++a) {
    EXPECT_DOUBLE_EQ(mesh.nodes(5, a), sixth_node[static_cast<std::size_t>(a)]);
  }
  ASSERT_EQ(mesh.tetrahedra.size(), 6u);
  EXPECT_THAT(mesh.tetrahedra[4], ElementsAre(0, 4, 5, 6));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_THAT(mesh.triangles[1], ElementsAre(0, 3, 2));
  EXPECT_NEAR(volume(mesh), 1e-3, 1e-15);
  EXPECT_EQ(mesh.notes.reordered_elements, 0);
  const bool gmsh = GetParam().find("gmsh") != std::string::npos;
  EXPECT_THAT(mesh.tetrahedron_sets.at(gmsh ? "soft" : "material:1"), ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.tetrahedron_sets.at(gmsh ? "stiff" : "material:2"), ElementsAre(3, 4, 5));
  EXPECT_THAT(mesh.triangle_sets.at(gmsh ? "base" : "material:3"), ElementsAre(0, 1));
  if (!gmsh) {
    EXPECT_THAT(mesh.node_sets.at("fixed"), ElementsAre(0, 1, 2, 3));
    EXPECT_EQ(mesh.node_sets.count("temperature"), 0u) << "a field of floats is no set";
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Cube, testing::ValuesIn(fixtures("cube_")), test_name);

TEST(Fixtures, CoverEveryEncoding) {
  EXPECT_EQ(fixtures("cube_").size(), 25u);
  EXPECT_EQ(fixtures("boxes_").size(), 6u);
  EXPECT_EQ(fixtures("bricks_").size(), 6u);
}

class Boxes : public testing::TestWithParam<std::string> {};

TEST_P(Boxes, HaveGmshsGroups) {
  const Mesh mesh = read_mesh(data_folder() / GetParam(), {.unit = 1e-3});
  EXPECT_EQ(mesh.node_count(), 78);
  EXPECT_EQ(mesh.tetrahedra.size(), 200u);
  EXPECT_NEAR(volume(mesh), 0.02 * 0.02 * 0.04, 1e-15);
  EXPECT_EQ(mesh.notes.unit, 1e-3);
  if (GetParam().find("vtk") != std::string::npos) return;  // Gmsh's VTK files have no names
  EXPECT_EQ(mesh.tetrahedron_sets.at("all").size(), 200u);
  EXPECT_EQ(mesh.tetrahedron_sets.at("soft rubber").size(), 100u);
  EXPECT_EQ(mesh.tetrahedron_sets.at("physical:42"), mesh.tetrahedron_sets.at("stiff"));
  double soft = 0.0;
  for (const NodeId e : mesh.tetrahedron_sets.at("soft rubber")) {
    soft += signed_volume(corners_of(mesh, e));
  }
  EXPECT_NEAR(soft, 0.02 * 0.02 * 0.02, 1e-15);
  for (const NodeId node : select_nodes(mesh, NamedRegion{"base"}, "test")) {
    EXPECT_NEAR(mesh.nodes(node, 2), 0.0, 1e-12);
  }
  const NodeId corner = mesh.node_sets.at("corner").at(0);
  EXPECT_NEAR((mesh.nodes.row(corner) - Vector3(0, 0, 0.04).transpose()).norm(), 0.0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Formats, Boxes, testing::ValuesIn(fixtures("boxes_")), test_name);

class Bricks : public testing::TestWithParam<std::string> {};

TEST_P(Bricks, AreHexahedra) {
  const Mesh mesh = read_mesh(data_folder() / GetParam(), {.unit = 1e-3});
  EXPECT_EQ(mesh.node_count(), 27);
  EXPECT_EQ(mesh.hexahedra.size(), 8u);
  EXPECT_TRUE(mesh.tetrahedra.empty());
  EXPECT_NEAR(volume(mesh), 0.02 * 0.02 * 0.04, 1e-15);
  EXPECT_EQ(boundary_surface(mesh).triangles.size(), 48u);
  EXPECT_EQ(mesh.hexahedron_sets.begin()->second.size(), 8u);
}

INSTANTIATE_TEST_SUITE_P(Formats, Bricks, testing::ValuesIn(fixtures("bricks_")), test_name);

TEST(ReadMesh, SaysWhatIsWrongWithThePath) {
  const test::ScratchFolder scratch;
  test::error_text(ErrorKind::file_not_found, [&] { read_mesh(scratch / "none.vtk"); });
  test::error_text(ErrorKind::file_unreadable, [&] { read_mesh(scratch.path()); });
  test::write_text(scratch / "text.vtk", "hello");
  test::error_text(ErrorKind::unknown_format, [&] { read_mesh(scratch / "text.vtk"); });
  test::write_text(scratch / "empty.vtk", "");
  test::error_text(ErrorKind::truncated_file, [&] { read_mesh(scratch / "empty.vtk"); });
  test::error_text(ErrorKind::out_of_range,
                   [&] { read_mesh(data_folder() / "cube_vtk42_ascii.vtk", {.unit = -1.0}); });
}

TEST(ReadMesh, KeepsFileOrderWithGapsInGmshTags) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n70 0 0 0\n9 1 0 0\n800 0 1 0\n1 0 0 1\n"
      "3 5 5 5\n$EndNodes\n$Elements\n1\n12 4 0 70 9 800 1\n$EndElements\n";
  const Mesh mesh = parse_mesh(text, "gaps.msh");
  EXPECT_THAT(mesh.tetrahedra.at(0), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(mesh.nodes(4, 2), 5.0) << "unused nodes keep their place";
}

TEST(ReadMesh, PutsPiecesOneAfterTheOther) {
  const std::string piece =
      "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points><DataArray type=\"Float32\" "
      "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>"
      "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells>";
  const std::string mask =
      "<PointData><DataArray type=\"UInt8\" Name=\"held\" format=\"ascii\">0 1 0 1</DataArray>"
      "</PointData>";
  const std::string text = "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid>" +
                           piece + "</Piece>" + piece + mask +
                           "</Piece></UnstructuredGrid></VTKFile>";
  const Mesh mesh = parse_mesh(text, "pieces.vtu");
  EXPECT_EQ(mesh.node_count(), 8);
  EXPECT_THAT(mesh.tetrahedra.at(1), ElementsAre(4, 5, 6, 7));
  ASSERT_EQ(mesh.node_sets.size(), 1U) << "what a piece lacks is no set of its own";
  EXPECT_THAT(mesh.node_sets.at("held"), ElementsAre(5, 7));
}

TEST(ReadMesh, UnderstandsOddLegacySections) {
  const std::string text =
      "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\n"
      "TIME 1 1 double\n0.5\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1e-400\nMETADATA\nINFORMATION 0"
      "\n\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nCELL_DATA 1\nSCALARS part%20id int 1\n"
      "LOOKUP_TABLE default\n7\nPOINT_DATA 4\nVECTORS v float\n1 2 3 1 2 3 1 2 3 1 2 3\n"
      "SCALARS no_table unsigned_char\n1 0 0 1\nFIELD more 2\nlabels 1 4 int\n5 5 6 6\n"
      "rgb 3 4 float\n0 0 0 0 0 0 0 0 0 0 0 0\n";
  const Mesh mesh = parse_mesh(text, "odd.vtk");
  EXPECT_THAT(mesh.tetrahedron_sets.at("part id:7"), ElementsAre(0));
  EXPECT_THAT(mesh.node_sets.at("no_table"), ElementsAre(0, 3));
  EXPECT_THAT(mesh.node_sets.at("labels:6"), ElementsAre(2, 3));
  EXPECT_EQ(mesh.node_sets.size(), 3u);
}

TEST(ReadMesh, MakesNoSetsOfCounters) {
  std::string text =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 300 double\n";
  for (int i = 0; i < 300; ++i) text += "0 0 " + std::to_string(i) + "\n";
  text += "CELLS 0 0\nCELL_TYPES 0\nPOINT_DATA 300\nSCALARS id int\n";
  for (int i = 0; i < 300; ++i) text += std::to_string(i) + " ";
  EXPECT_TRUE(parse_mesh(text, "ids.vtk").node_sets.empty());
}

// Meshes of published examples; tested only if a checkout of them lies next to the repository.
struct Published {
  std::string file;
  int nodes;
  std::size_t tetrahedra;
};

std::vector<Published> published() {
  const char* given = std::getenv("SINEW_SHARED_DATA");
  const std::filesystem::path folder =
      given != nullptr ? std::filesystem::path(given)
                       : std::filesystem::path(SINEW_SOURCE_DIR) / "../shared/data";
  std::vector<Published> present;
  for (const Published& mesh :
       {Published{"trunk/trunk.vtk", 709, 1972}, Published{"grasp/cup.vtk", 1255, 3800},
        Published{"multigait/multigait.vtk", 15787, 59296},
        Published{"pneunet/pneunet.vtk", 2316, 9560}}) {
    const auto path = folder / mesh.file;
    if (std::filesystem::exists(path)) present.push_back({path, mesh.nodes, mesh.tetrahedra});
  }
  return present;
}

class PublishedMesh : public testing::TestWithParam<Published> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PublishedMesh);

TEST_P(PublishedMesh, IsSoundInMillimetresAndSuspiciousWithoutUnit) {
  const Mesh mesh = read_mesh(GetParam().file, {.unit = 1e-3});
  EXPECT_EQ(mesh.node_count(), GetParam().nodes);
  EXPECT_EQ(mesh.tetrahedra.size(), GetParam().tetrahedra);
  const std::string text =
      test::error_text(ErrorKind::suspicious_unit, [] { read_mesh(GetParam().file); });
  EXPECT_THAT(text, testing::HasSubstr("unit: mm"));
}

INSTANTIATE_TEST_SUITE_P(Beside, PublishedMesh, testing::ValuesIn(published()),
                         [](const testing::TestParamInfo<Published>& mesh) {
                           return std::filesystem::path(mesh.param.file).stem().string();
                         });

}  // namespace
}  // namespace sinew::mesh
