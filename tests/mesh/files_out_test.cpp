// Writers, surfaces, and the meshing program.
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "sinew/core/file.hpp"
#include "sinew/core/process.hpp"
#include "sinew/mesh/check.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/mesh/tetrahedralise.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/mesh/write_mesh.hpp"

#include "support.hpp"

namespace sinew::mesh {
namespace {

using test::error_text;
using test::ScratchFolder;
using testing::HasSubstr;

std::filesystem::path surfaces() {
  return std::filesystem::path(SINEW_SOURCE_DIR) / "tests/mesh/data_surface";
}

Mesh decorated_trunk() {
  Mesh mesh = trunk();
  mesh.triangles = boundary_surface(mesh).triangles;
  mesh.triangle_sets["skin & <bone>"] = {0, 5, 7};
  mesh.tetrahedron_sets["material:3"] = {1, 2, 2000};
  return mesh;
}

TEST(WriteVtu, RoundTripsBitForBit) {
  const ScratchFolder scratch;
  const Mesh mesh = decorated_trunk();
  write_vtu(scratch / "trunk.vtu", mesh);
  const Mesh back = read_mesh(scratch / "trunk.vtu");
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.node_sets, mesh.node_sets);
  EXPECT_EQ(back.triangle_sets, mesh.triangle_sets);
  EXPECT_EQ(back.tetrahedron_sets, mesh.tetrahedron_sets);
  EXPECT_EQ(format_vtu(back), format_vtu(mesh));
}

TEST(WriteVtu, RawArraysHoldTheSameMesh) {
  const Mesh mesh = decorated_trunk();
  VtuFields fields;
  fields.compressed = false;
  const Mesh back = parse_mesh(format_vtu(mesh, fields), "trunk.vtu");
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.node_sets, mesh.node_sets);
  EXPECT_EQ(format_vtu(back), format_vtu(mesh));
}

TEST(WriteMesh, LegacyFilesRoundTripBitForBit) {
  const ScratchFolder scratch;
  const Mesh mesh = decorated_trunk();
  write_mesh(scratch / "trunk.VTK", mesh);
  EXPECT_THAT(read_file(scratch / "trunk.VTK"), testing::StartsWith("# vtk DataFile Version 4.2"));
  const Mesh back = read_mesh(scratch / "trunk.VTK");
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.node_sets, mesh.node_sets);
  EXPECT_EQ(back.triangle_sets, mesh.triangle_sets);
  EXPECT_EQ(back.tetrahedron_sets, mesh.tetrahedron_sets);
}

TEST(WriteMesh, LegacyFilesHoldHexahedraAndQuadraticTetrahedra) {
  Mesh cubes = block({.cells = {2, 2, 2}}, Cells::hexahedra);
  cubes.hexahedron_sets["core"] = {3};
  const Mesh same = parse_mesh(format_vtk_legacy(cubes), "cubes.vtk");
  EXPECT_EQ(same.hexahedra, cubes.hexahedra);
  EXPECT_EQ(same.hexahedron_sets, cubes.hexahedron_sets);
  const Mesh curved = with_middle_nodes(block({.cells = {2, 1, 1}}));
  EXPECT_EQ(parse_mesh(format_vtk_legacy(curved), "curved.vtk").quadratic, curved.quadratic);
}

TEST(WriteMesh, AnStlHoldsTheOutside) {
  const ScratchFolder scratch;
  const Mesh mesh = block({.size = {0.1, 0.02, 0.02}, .cells = {5, 1, 1}});
  write_mesh(scratch / "block.stl", mesh);
  const Surface surface = read_surface(scratch / "block.stl");
  require_closed(surface);
  EXPECT_EQ(surface.triangles.size(), boundary_surface(mesh).triangles.size());
  EXPECT_NEAR(solid_moments(surface).volume, 4e-5, 1e-11);
}

TEST(WriteMesh, OtherEndingsAreRefusedAndNothingIsWritten) {
  const ScratchFolder scratch;
  for (const char* name : {"a.msh", "a.vtx", "a"}) {
    const std::string text =
        error_text(ErrorKind::unknown_format, [&] { write_mesh(scratch / name, block({})); });
    for (const char* word : {"unknown-format", ".vtu", ".vtk", ".stl", name}) {
      EXPECT_THAT(text, HasSubstr(word));
    }
    EXPECT_FALSE(std::filesystem::exists(scratch / name));
  }
}

TEST(WriteVtu, RoundTripsHexahedra) {
  Mesh mesh = block({.cells = {2, 2, 2}}, Cells::hexahedra);
  mesh.hexahedron_sets["core"] = {3};
  const Mesh back = parse_mesh(format_vtu(mesh), "block.vtu");
  EXPECT_EQ(back.hexahedra, mesh.hexahedra);
  EXPECT_EQ(back.hexahedron_sets, mesh.hexahedron_sets);
}

TEST(WriteVtu, RoundTripsQuadraticTetrahedra) {
  Mesh mesh = with_middle_nodes(block({.size = {0.02, 0.01, 0.01}, .cells = {2, 1, 1}}));
  mesh.node_sets.clear();
  const Mesh back = parse_mesh(format_vtu(mesh), "block.vtu");
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(back.quadratic, mesh.quadratic);
  // Elements with the other node order are reordered, together with their middle nodes.
  for (auto& t : mesh.quadratic) {
    std::swap(t[2], t[3]);
    std::swap(t[5], t[8]);
    std::swap(t[6], t[7]);
  }
  Mesh turned = parse_mesh(format_vtu(mesh), "turned.vtu");
  EXPECT_EQ(reorder_elements(turned), 12);
  EXPECT_EQ(turned.quadratic, back.quadratic);
  EXPECT_EQ(boundary_surface(back).triangles.size(), 4U * 2U * 10U);
  EXPECT_NEAR(solid_moments(boundary_surface(back)).volume, 2e-6, 1e-18);
}

TEST(WriteVtu, ChecksFieldsAndPaths) {
  const ScratchFolder scratch;
  const Mesh mesh = test::one_tetrahedron();
  VtuFields fields;
  fields.points.push_back({.name = "u", .components = 3, .values = std::vector<double>(11)});
  EXPECT_THAT(error_text(ErrorKind::wrong_length, [&] { format_vtu(mesh, fields); }),
              HasSubstr("11 values for 4 nodes"));
  const Points few = Points::Zero(3, 3);
  VtuFields moved;
  moved.positions = &few;
  error_text(ErrorKind::wrong_length, [&] { format_vtu(mesh, moved); });
  error_text(ErrorKind::file_unwritable, [&] { write_vtu(scratch / "no/such/folder.vtu", mesh); });
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path())) << "nothing is left behind";
}

TEST(WriteVtu, IsReadByMeshio) {
  const ScratchFolder scratch;
  Mesh mesh = decorated_trunk();
  VtuFields fields;
  std::vector<double> heights;
  for (NodeId node = 0; node < mesh.node_count(); ++node) heights.push_back(mesh.nodes(node, 2));
  fields.points.push_back({.name = "height", .components = 1, .values = heights});
  fields.cells.push_back({.name = "stress",
                          .components = 1,
                          .values = std::vector<double>(mesh.tetrahedra.size(), 2.5)});
  write_vtu(scratch / "trunk.vtu", mesh, fields);
  test::write_text(
      scratch / "check.py",
      "import sys\ntry:\n import meshio, numpy as np\nexcept ImportError: sys.exit(77)\n"
      "m = meshio.read(sys.argv[1])\nassert len(m.points) == 703\n"
      "assert [(c.type, len(c.data)) for c in m.cells][0] == ('tetra', 2592)\n"
      "assert np.array_equal(m.point_data['height'], m.points[:, 2])\n"
      "assert (m.cell_data['stress'][0] == 2.5).all()\n"
      "assert np.isnan(m.cell_data['stress'][1]).all()\n"
      "assert m.cell_data['material:3'][0].sum() == 3\n");
  if (!program_exists("/usr/bin/python3")) return;
  const ProcessResult result = run_program(
      {"/usr/bin/python3", (scratch / "check.py").string(), (scratch / "trunk.vtu").string()});
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 77) << result.output;
}

TEST(PvdWriter, IsWholeAfterEveryStep) {
  const ScratchFolder scratch;
  const Mesh mesh = test::one_tetrahedron();
  PvdWriter series(scratch / "out/run.pvd");
  for (int step = 0; step < 12; ++step) {
    const std::string before = read_file(scratch / "out/run.pvd");
    EXPECT_TRUE(before.ends_with("  </Collection>\n</VTKFile>\n")) << before;
    series.write(0.01 * step, mesh);
  }
  EXPECT_EQ(series.count(), 12);
  const std::string list = read_file(scratch / "out/run.pvd");
  EXPECT_THAT(list, HasSubstr("timestep=\"0.11\" part=\"0\" file=\"run/run_000011.vtu\""));
  EXPECT_EQ(read_mesh(scratch / "out/run/run_000011.vtu").tetrahedra, mesh.tetrahedra);
  error_text(ErrorKind::not_finite,
             [&] { series.write(std::numeric_limits<double>::quiet_NaN(), mesh); });
  EXPECT_EQ(read_file(scratch / "out/run.pvd"), list);
  test::write_text(scratch / "file", "x");
  error_text(ErrorKind::file_unwritable, [&] { PvdWriter(scratch / "file/run.pvd"); });
}

class SurfaceFile : public testing::TestWithParam<std::string> {};

TEST_P(SurfaceFile, IsAWeldedClosedCube) {
  const Surface cube = read_surface(surfaces() / GetParam());
  EXPECT_EQ(cube.nodes.rows(), 8);
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_NO_THROW(require_closed(cube));
  EXPECT_NEAR(solid_moments(cube).volume, 1e-3, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Formats, SurfaceFile,
                         testing::Values("cube_ascii.stl", "cube_binary.stl", "cube_ascii.ply",
                                         "cube_binary.ply", "cube.obj"),
                         [](const auto& file) {
                           std::string name = file.param;
                           name[name.find('.')] = '_';
                           return name;
                         });

TEST(Surfaces, CutPolygonsWithoutTurningTriangles) {
  const std::string arrow =  // a concave quadrilateral, and a convex one
      "v 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 1 2 3 4\nf 5 6 7 8\n";
  const Surface surface = parse_surface(arrow, "obj", "arrow.obj");
  ASSERT_EQ(surface.triangles.size(), 4u);
  for (const auto& [a, b, c] : surface.triangles) {
    const Vector3 x = surface.nodes.row(a), y = surface.nodes.row(b), z = surface.nodes.row(c);
    EXPECT_GT((y - x).cross(z - x).z(), 0.0);
  }
}

TEST(Surfaces, SayWhereTheyAreOpenAndWhenTheUnitIsSuspicious) {
  Surface cube = read_surface(surfaces() / "cube.obj");
  cube.triangles.pop_back();
  EXPECT_THAT(error_text(ErrorKind::surface_not_closed, [&] { require_closed(cube); }),
              HasSubstr("3 edges"));
  std::swap(cube.triangles[0][0], cube.triangles[0][1]);
  error_text(ErrorKind::surface_not_closed, [&] { require_closed(cube); });
  const ScratchFolder scratch;
  write_file(scratch / "large.stl", format_stl(read_surface(surfaces() / "cube.obj"), 1e3));
  error_text(ErrorKind::suspicious_unit, [&] { read_surface(scratch / "large.stl"); });
  const Surface scaled = read_surface(scratch / "large.stl", {.unit = 1e-3});
  EXPECT_NEAR(solid_moments(scaled).volume, 1e-3, 1e-9);
}

TEST(Tetrahedralise, SaysHowToInstallGmshAndWhatItComplains) {
  const ScratchFolder scratch;
  const auto cube = surfaces() / "cube_binary.stl";
  EXPECT_THAT(
      error_text(ErrorKind::tool_missing,
                 [&] { tetrahedralise_surface(cube, {}, {.size = 0.05, .program = "no-gmsh"}); }),
      HasSubstr("apt-get install gmsh"));
  test::write_text(scratch / "fails",
                   "#!/bin/sh\necho 'Error : self-intersecting facets'\nexit 1\n");
  std::filesystem::permissions(scratch / "fails", std::filesystem::perms::owner_all);
  EXPECT_THAT(error_text(ErrorKind::tool_failed,
                         [&] {
                           tetrahedralise_surface(
                               cube, {}, {.size = 0.05, .program = (scratch / "fails").string()});
                         }),
              HasSubstr("self-intersecting facets"));
  for (const double size : {0.0, -1.0, 1e-6}) {
    error_text(ErrorKind::out_of_range, [&] { tetrahedralise_surface(cube, {}, {.size = size}); });
  }
}

TEST(Tetrahedralise, FillsACubeWhenGmshIsThere) {
  if (!program_exists("gmsh")) return;
  const ScratchFolder scratch;
  const Mesh mesh =
      tetrahedralise_surface(surfaces() / "cube_binary.stl", scratch / "cube.vtu", {.size = 0.03});
  EXPECT_NEAR(volume(mesh), 1e-3, 1e-8);
  const MeshReport report = describe(mesh);
  EXPECT_GT(report.tetrahedra, 100);
  EXPECT_NEAR(report.mean_edge, 0.03, 0.01);
  EXPECT_EQ(read_mesh(scratch / "cube.vtu").tetrahedra, mesh.tetrahedra);
}

}  // namespace
}  // namespace sinew::mesh
