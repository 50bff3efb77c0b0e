// Truncated or corrupt files, and files with false sizes: always an Error, never a crash or a huge
// allocation.
#include <algorithm>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "sinew/core/file.hpp"
#include "sinew/mesh/byte_reader.hpp"
#include "sinew/mesh/check.hpp"
#include "sinew/mesh/codec.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/surface.hpp"

#include "support.hpp"

namespace sinew::mesh {
namespace {

using test::data_folder;
using test::error_text;
using testing::HasSubstr;

std::vector<std::filesystem::path> all_fixtures() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder())) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Parses and checks a file. An Error is a valid outcome; any other exception fails the test.
bool survives(const std::string& bytes, const std::string& name) {
  try {
    Mesh mesh = parse_mesh(bytes, name);
    check(mesh);
    return true;
  } catch (const Error& error) {
    EXPECT_NE(error.kind(), ErrorKind::internal) << error.what();
    return false;
  }
}

TEST(BrokenFiles, CutAnywhereNeverPassForWholeMeshesWithFewerElements) {
  for (const auto& path : all_fixtures()) {
    const std::string bytes = read_file(path);
    const std::string name = path.filename().string();
    const Mesh whole = parse_mesh(bytes, name);
    for (std::size_t length = 0; length<bytes.size(); length += bytes.size()> 4000 ? 7 : 1) {
      try {
        const Mesh cut = parse_mesh(bytes.substr(0, length), name);
        EXPECT_EQ(cut.nodes.rows(), whole.nodes.rows()) << name << " cut at " << length;
        EXPECT_EQ(cut.tetrahedra.size(), whole.tetrahedra.size()) << name << " cut at " << length;
      } catch (const Error& error) {
        EXPECT_NE(error.kind(), ErrorKind::internal) << error.what();
      }
    }
  }
}

TEST(BrokenFiles, RandomDamageNeverCrashes) {
  std::mt19937 random(12345);
  int refused = 0, tried = 0;
  for (const auto& path : all_fixtures()) {
    const std::string bytes = read_file(path);
    for (int trial = 0; trial < 60; ++trial) {
      std::string damaged = bytes;
      const int wounds = 1 + static_cast<int>(random() % 4);
      for (int k = 0; k < wounds; ++k) {
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      }
      refused += survives(damaged, path.filename().string()) ? 0 : 1;
      ++tried;
    }
  }
  EXPECT_GT(refused, tried / 4);
}

const std::string kLegacyHead =
    "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
    "0 0 0 1 0 0 0 1 0 0 0 1\n";

struct Broken {
  std::string name, text;
  ErrorKind kind;
  std::string part;  // that the message must contain
};

class BrokenText : public testing::TestWithParam<Broken> {};

TEST_P(BrokenText, IsRefusedWithPlaceAndReason) {
  const Broken& broken = GetParam();
  const std::string text = error_text(broken.kind, [&] { parse_mesh(broken.text, "file.any"); });
  EXPECT_THAT(text, HasSubstr(broken.part));
  EXPECT_THAT(text, HasSubstr("file.any"));
}

std::string legacy_points(const std::string& rest) {
  return "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n" + rest;
}

std::string gmsh(const std::string& version, const std::string& rest) {
  return "$MeshFormat\n" + version + " 0 8\n$EndMeshFormat\n" + rest;
}

std::string vtu(const std::string& points, const std::string& connectivity,
                const std::string& offsets = "4", const std::string& attributes = "") {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" " + attributes +
         ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<Points>\n" +
         points + "</Points>\n<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\">" +
         connectivity + "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\">" + offsets +
         "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\">10</DataArray>\n</Cells>\n"
         "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

const std::string kVtuPoints =
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>\n";
const std::string kGmshNodes = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n";

INSTANTIATE_TEST_SUITE_P(
    Legacy, BrokenText,
    testing::Values(Broken{"huge_point_count", legacy_points("POINTS 2000000000 double\n0 0 0\n"),
                           ErrorKind::truncated_file, "file.any:5: 2000000000 points"},
                    Broken{"too_many_points", legacy_points("POINTS 99999999999 double\n"),
                           ErrorKind::size_limit, "99999999999"},
                    Broken{"negative_count", legacy_points("POINTS -3 double\n"),
                           ErrorKind::malformed_file, "-3 points"},
                    Broken{"word_for_count", legacy_points("POINTS many double\n"),
                           ErrorKind::malformed_file, "`many`"},
                    Broken{"word_for_coordinate", legacy_points("POINTS 1 double\n0 zero 0\n"),
                           ErrorKind::malformed_file, "file.any:6: expected a coordinate"},
                    Broken{"unknown_type", legacy_points("POINTS 1 quadruple\n0 0 0\n"),
                           ErrorKind::malformed_file, "quadruple"},
                    Broken{"no_points", legacy_points(""), ErrorKind::malformed_file, "no POINTS"},
                    Broken{"unknown_section", legacy_points("POTATOES 3\n"),
                           ErrorKind::malformed_file, "potatoes"},
                    Broken{"polydata", "# vtk DataFile Version 2.0\nt\nASCII\nDATASET POLYDATA\n",
                           ErrorKind::unknown_format, "polydata"},
                    Broken{"version", "# vtk DataFile Version 9.0\nt\nASCII\n",
                           ErrorKind::unsupported_version, "9.0"},
                    Broken{"encoding", "# vtk DataFile Version 2.0\nt\nEBCDIC\n",
                           ErrorKind::malformed_file, "ebcdic"},
                    Broken{"index", kLegacyHead + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n",
                           ErrorKind::index_out_of_range, "cell 0 (tetrahedron) uses node 4"},
                    Broken{"negative_index",
                           kLegacyHead + "CELLS 1 5\n4 0 1 2 -1\nCELL_TYPES 1\n10\n",
                           ErrorKind::index_out_of_range, "node -1"},
                    Broken{"line_index", kLegacyHead + "CELLS 1 3\n2 0 9\nCELL_TYPES 1\n3\n",
                           ErrorKind::index_out_of_range, "(line) uses node 9"},
                    Broken{"cell_size", kLegacyHead + "CELLS 1 5\n9 0 1 2 3\nCELL_TYPES 1\n10\n",
                           ErrorKind::malformed_file, "does not fit"},
                    Broken{"cell_sum", kLegacyHead + "CELLS 1 6\n4 0 1 2 3 0\nCELL_TYPES 1\n10\n",
                           ErrorKind::malformed_file, "announces 6"},
                    Broken{"missing_types", kLegacyHead + "CELLS 1 5\n4 0 1 2 3\n",
                           ErrorKind::truncated_file, "no CELL_TYPES"},
                    Broken{"few_types", kLegacyHead + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 0\n",
                           ErrorKind::malformed_file, "0 cells have a type"},
                    Broken{"wrong_points_for_type",
                           kLegacyHead + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n10\n",
                           ErrorKind::malformed_file, "3 points instead of 4"},
                    Broken{"quadratic", kLegacyHead + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n24\n",
                           ErrorKind::malformed_file, "quadratic tetrahedron with 4 points"},
                    Broken{"offsets",
                           kLegacyHead + "CELLS 2 4\nOFFSETS vtktypeint64\n0 9\nCONNECTIVITY "
                                         "vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\n",
                           ErrorKind::malformed_file, "offsets 0 to 9"},
                    Broken{"float_connectivity", kLegacyHead + "CELLS 2 4\nOFFSETS float\n0 4\n",
                           ErrorKind::malformed_file, "integer type"},
                    Broken{"huge_array",
                           kLegacyHead + "CELLS 0 0\nCELL_TYPES 0\nPOINT_DATA 4\nFIELD f 1\n"
                                         "x 2147483647 2147483647 int\n1\n",
                           ErrorKind::truncated_file, "tuples"},
                    Broken{"wrong_field_size",
                           kLegacyHead + "CELLS 0 0\nCELL_TYPES 0\nPOINT_DATA 3\n"
                                         "SCALARS x int\nLOOKUP_TABLE default\n1 2 3\n",
                           ErrorKind::malformed_file, "3 values for 4 points"}),
    [](const auto& broken) { return broken.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Gmsh, BrokenText,
    testing::Values(
        Broken{"version", gmsh("4.0", ""), ErrorKind::unsupported_version, "4.0"},
        Broken{"data_size", "$MeshFormat\n2.2 0 4\n$EndMeshFormat\n",
               ErrorKind::unsupported_version, "4 bytes"},
        Broken{"byte_order", "$MeshFormat\n2.2 1 8\nabcd\n$EndMeshFormat\n",
               ErrorKind::malformed_file, "byte order mark"},
        Broken{"no_elements", gmsh("2.2", kGmshNodes), ErrorKind::truncated_file, "no $Elements"},
        Broken{"no_end", gmsh("2.2", "$Comments\nhello"), ErrorKind::truncated_file, "has no end"},
        Broken{"stray_text", gmsh("2.2", "hello"), ErrorKind::malformed_file, "start of a section"},
        Broken{"huge_nodes", gmsh("2.2", "$Nodes\n2000000000\n1 0 0 0\n"),
               ErrorKind::truncated_file, "file.any:5"},
        Broken{"node_count", gmsh("2.2", "$Nodes\n1\n1 0 0 0\n2 0 0 0\n$EndNodes\n"),
               ErrorKind::malformed_file, "$EndNodes"},
        Broken{"node_twice", gmsh("2.2", "$Nodes\n2\n1 0 0 0\n1 0 0 1\n$EndNodes\n"),
               ErrorKind::duplicate_node, "node 1 is given twice"},
        Broken{"unknown_node",
               gmsh("2.2", kGmshNodes + "$Elements\n1\n7 4 2 1 1 1 2 3 9\n$EndElements\n"),
               ErrorKind::index_out_of_range, "element 7 uses node 9"},
        Broken{"unknown_type",
               gmsh("2.2", kGmshNodes + "$Elements\n1\n7 77 0 1 2 3 4\n$EndElements\n"),
               ErrorKind::unsupported_element, "type 77"},
        Broken{"prism", gmsh("2.2", kGmshNodes + "$Elements\n1\n7 6 0 1 2 3 4 1 2\n$EndElements\n"),
               ErrorKind::unsupported_element, "wedge"},
        Broken{"unquoted_name", gmsh("2.2", "$PhysicalNames\n1\n2 1 base\n$EndPhysicalNames\n"),
               ErrorKind::malformed_file, "quotes"},
        Broken{"huge_blocks", gmsh("4.1", "$Nodes\n1000000000 4 1 4\n"), ErrorKind::truncated_file,
               "node blocks"},
        Broken{"huge_entities", gmsh("4.1", "$Entities\n1000000000 0 0 0\n"),
               ErrorKind::truncated_file, "entities"},
        Broken{"huge_groups", gmsh("4.1", "$Entities\n1 0 0 0\n1 0 0 0 1000000000 1\n"),
               ErrorKind::truncated_file, "groups"}),
    [](const auto& broken) { return broken.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Vtu, BrokenText,
    testing::Values(
        Broken{"broken_xml", "<VTKFile type=\"UnstructuredGrid\"><Unstr", ErrorKind::malformed_file,
               "XML is broken"},
        Broken{"wrong_type", "<VTKFile type=\"PolyData\"></VTKFile>", ErrorKind::unknown_format,
               "PolyData"},
        Broken{"byte_order", vtu(kVtuPoints, "0 1 2 3", "4", "byte_order=\"Middle\""),
               ErrorKind::malformed_file, "Middle"},
        Broken{"header_type", vtu(kVtuPoints, "0 1 2 3", "4", "header_type=\"UInt128\""),
               ErrorKind::malformed_file, "UInt128"},
        Broken{"compressor", vtu(kVtuPoints, "0 1 2 3", "4", "compressor=\"vtkLZ4DataCompressor\""),
               ErrorKind::unknown_format, "LZ4"},
        Broken{"index", vtu(kVtuPoints, "0 1 2 7"), ErrorKind::index_out_of_range, "node 7"},
        Broken{"offset", vtu(kVtuPoints, "0 1 2 3", "40"), ErrorKind::malformed_file, "offset 40"},
        Broken{"negative_offset", vtu(kVtuPoints, "0 1 2 3", "-4"), ErrorKind::malformed_file,
               "offset -4"},
        Broken{"few_points", vtu("<DataArray type=\"Float64\">0 0 0</DataArray>\n", "0 1 2 3"),
               ErrorKind::truncated_file, "3 values instead of 12"},
        Broken{"bad_number", vtu("<DataArray type=\"Float64\">0\n0 x</DataArray>\n", "0 1 2 3"),
               ErrorKind::malformed_file, "file.any:7"},
        Broken{"no_points", vtu("", "0 1 2 3"), ErrorKind::malformed_file, "no <Points>"},
        Broken{"array_type", vtu("<DataArray type=\"Float16\">0</DataArray>\n", "0 1 2 3"),
               ErrorKind::malformed_file, "Float16"},
        Broken{"array_format",
               vtu("<DataArray type=\"Float64\" format=\"morse\">0</DataArray>\n", "0 1 2 3"),
               ErrorKind::malformed_file, "morse"},
        Broken{"bad_base64",
               vtu("<DataArray type=\"Float64\" format=\"binary\">@@@@</DataArray>\n", "0 1 2 3"),
               ErrorKind::bad_encoding, "base64"},
        Broken{"short_base64",
               vtu("<DataArray type=\"Float64\" format=\"binary\">/////w==AAAA</DataArray>\n",
                   "0 1 2 3"),
               ErrorKind::truncated_file, "4294967295 bytes"},
        Broken{"no_appended",
               vtu("<DataArray type=\"Float64\" format=\"appended\" offset=\"9\"/>\n", "0 1 2 3"),
               ErrorKind::truncated_file, "offset 9"},
        Broken{"many_blocks",
               vtu("<DataArray type=\"Float64\" format=\"binary\">/////w==</DataArray>\n",
                   "0 1 2 3", "4", "compressor=\"vtkZLibDataCompressor\""),
               ErrorKind::truncated_file, "4294967295 compressed blocks"}),
    [](const auto& broken) { return broken.param.name; });

TEST(BrokenFiles, BinaryMessagesNameTheByte) {
  const std::string bytes = read_file(data_folder() / "cube_vtk42_binary.vtk").substr(0, 200);
  const std::string text =
      error_text(ErrorKind::truncated_file, [&] { parse_mesh(bytes, "f.vtk"); });
  EXPECT_THAT(text, HasSubstr("byte "));
}

TEST(Codec, InflatesOnlyWhatWasPackedAndRefusesBombs) {
  const std::string data(1000, 'x');
  const std::string packed = deflate(data);
  EXPECT_EQ(inflate(packed, data.size()), data);
  EXPECT_FALSE(inflate(packed, data.size() - 1));
  EXPECT_FALSE(inflate(packed, data.size() + 1));
  EXPECT_FALSE(inflate(packed, std::size_t{1} << 40));
  EXPECT_FALSE(inflate("not zlib at all", 100));
}

TEST(Codec, Base64RoundTripsAndJoinsRuns) {
  std::mt19937 random(7);
  for (std::size_t length = 0; length < 40; ++length) {
    std::string bytes(length, ' ');
    for (char& c : bytes) c = static_cast<char>(random() % 256);
    EXPECT_EQ(decode_base64(encode_base64(bytes), 1000), bytes);
    EXPECT_EQ(decode_base64(encode_base64("head") + " \n" + encode_base64(bytes), 1000),
              "head" + bytes);
  }
  EXPECT_EQ(decode_base64("TWFu", 1000), "Man");  // in the style of RFC 4648, section 10
  EXPECT_FALSE(decode_base64("TWF", 1000));
  EXPECT_FALSE(decode_base64("T=Fu", 1000));
  EXPECT_FALSE(decode_base64("====", 1000));
}

TEST(ByteReader, DecodesBothOrdersAndRefusesFractionsAsIntegers) {
  const std::string two("\x02\x00\x00\x00", 4);
  EXPECT_EQ(decode_integers(two, ScalarType::int32, ByteOrder::little).at(0), 2);
  EXPECT_EQ(decode_integers(two, ScalarType::int32, ByteOrder::big).at(0), 0x02000000);
  EXPECT_EQ(decode_integers(std::string(8, '\xff'), ScalarType::uint64, ByteOrder::big).at(0), -1);
  const double half = 0.5;
  const std::string_view bytes(reinterpret_cast<const char*>(&half), 8);
  EXPECT_EQ(decode_integers(bytes, ScalarType::float64, ByteOrder::little).at(0), -1);
  EXPECT_EQ(decode_integers("\xa0", ScalarType::bit, ByteOrder::big),
            (std::vector<std::int64_t>{1, 0, 1, 0, 0, 0, 0, 0}));
}

TEST(BrokenFiles, SurfacesAreRefusedToo) {
  error_text(ErrorKind::unknown_format, [] { parse_surface("x", "fbx", "a.fbx"); });
  error_text(ErrorKind::malformed_file, [] { parse_surface("", "stl", "a.stl"); });
  error_text(ErrorKind::truncated_file, [] { parse_surface("solid a\n", "stl", "a.stl"); });
  error_text(ErrorKind::empty_list, [] { parse_surface("solid a\nendsolid a\n", "stl", "a.stl"); });
  error_text(ErrorKind::truncated_file, [] { parse_surface("ply\nformat ascii", "ply", "a.ply"); });
  error_text(ErrorKind::malformed_file,
             [] { parse_surface("ply\nformat morse 1.0\n", "ply", "a.ply"); });
}

}  // namespace
}  // namespace sinew::mesh
