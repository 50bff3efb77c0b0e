#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/mesh/codec.hpp"
#include "sinew/mesh/raw_mesh.hpp"
#include "sinew/mesh/set_masks.hpp"
#include "sinew/mesh/write.hpp"

namespace sinew::mesh {

namespace {

constexpr std::size_t kBlockSize = 1u << 16;

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

template <typename Value>
void append_bytes(std::string& bytes, const Value* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

/// Builds the XML and the appended data together.
class VtuBuilder {
 public:
  explicit VtuBuilder(bool compressed) : compressed_(compressed) {}

  template <typename Value>
  void array(const std::string& name, const char* type, int components,
             const std::vector<Value>& values) {
    // Without the attribute, readers give scalars; with it, rows of one component.
    const std::string width =
        components == 1 ? "" : fmt::format(" NumberOfComponents=\"{}\"", components);
    xml_ += fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n", type,
        escaped(name), width, data_.size());
    append({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
  }

  void field(const std::string& name, int components, const std::vector<double>& values) {
    if (compressed_) return array(name, "Float64", components, values);
    array(name, "Float32", components, std::vector<float>(values.begin(), values.end()));
  }

  void line(std::string_view text) {
    xml_ += text;
    xml_ += '\n';
  }

  std::string finish() const {
    return xml_ + "  <AppendedData encoding=\"raw\">\n_" + data_ +
           "\n  </AppendedData>\n</VTKFile>\n";
  }

 private:
  void append(std::string_view bytes) {
    if (compressed_) return append_compressed(bytes);
    const std::uint64_t size = bytes.size();
    append_bytes(data_, &size, 1);
    data_ += bytes;
  }

  /// Header (blocks, block size, size of a partial last block, packed sizes), then the blocks.
  void append_compressed(std::string_view bytes) {
    std::vector<std::uint64_t> header = {(bytes.size() + kBlockSize - 1) / kBlockSize, kBlockSize,
                                         bytes.size() % kBlockSize};
    std::string packed;
    for (std::size_t at = 0; at < bytes.size(); at += kBlockSize) {
      const std::string block = deflate(bytes.substr(at, kBlockSize));
      header.push_back(block.size());
      packed += block;
    }
    append_bytes(data_, header.data(), header.size());
    data_ += packed;
  }

  bool compressed_;
  std::string xml_;
  std::string data_;
};

std::size_t written_triangles(const Mesh& mesh, const VtuFields& fields) {
  return fields.triangles ? mesh.triangles.size() : 0;
}

void check_field(const VtuField& field, std::size_t rows, const char* what) {
  const std::size_t wanted = rows * static_cast<std::size_t>(std::max(field.components, 0));
  if (field.components > 0 && field.values.size() == wanted) return;
  throw Error(ErrorKind::wrong_length, {.item = fmt::format("field `{}`", field.name)},
              fmt::format("{} values for {} {} with {} components", field.values.size(), rows, what,
                          field.components));
}

void write_points(const Mesh& mesh, const VtuFields& fields, VtuBuilder& out) {
  const Points& positions = fields.positions != nullptr ? *fields.positions : mesh.nodes;
  if (positions.rows() != mesh.nodes.rows()) {
    throw Error(ErrorKind::wrong_length, {.item = "positions"},
                fmt::format("{} positions for {} nodes", positions.rows(), mesh.node_count()));
  }
  out.line("      <Points>");
  out.array("Points", "Float64", 3,
            std::vector<double>(positions.data(), positions.data() + positions.size()));
  out.line("      </Points>");
}

void write_cells(const Mesh& mesh, const VtuFields& fields, VtuBuilder& out) {
  std::vector<std::int32_t> connectivity;
  std::vector<std::int64_t> offsets;
  std::vector<std::uint8_t> types;
  const auto add = [&](const auto& elements, CellType type, std::size_t count) {
    for (std::size_t e = 0; e < count; ++e) {
      connectivity.insert(connectivity.end(), elements[e].begin(), elements[e].end());
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      types.push_back(static_cast<std::uint8_t>(type));
    }
  };
  if (mesh.quadratic.empty()) {
    add(mesh.tetrahedra, kTetrahedron, mesh.tetrahedra.size());
  } else {
    add(mesh.quadratic, kQuadraticTetrahedron, mesh.quadratic.size());
  }
  add(mesh.hexahedra, kHexahedron, mesh.hexahedra.size());
  add(mesh.triangles, kTriangle, written_triangles(mesh, fields));
  out.line("      <Cells>");
  out.array("connectivity", "Int32", 1, connectivity);
  out.array("offsets", "Int64", 1, offsets);
  out.array("types", "UInt8", 1, types);
  out.line("      </Cells>");
}

void write_point_data(const Mesh& mesh, const VtuFields& fields, VtuBuilder& out) {
  const auto count = static_cast<std::size_t>(mesh.node_count());
  out.line("      <PointData>");
  for (const VtuField& field : fields.points) {
    check_field(field, count, "nodes");
    out.field(field.name, field.components, field.values);
  }
  const SetMasks masks = fields.sets ? node_masks(mesh) : SetMasks{};
  for (const auto& [name, mask] : masks) out.array(name, "UInt8", 1, mask);
  out.line("      </PointData>");
}

void write_cell_data(const Mesh& mesh, const VtuFields& fields, VtuBuilder& out) {
  const std::size_t volumes = mesh.tetrahedra.size() + mesh.hexahedra.size();
  const std::size_t triangles = written_triangles(mesh, fields);
  out.line("      <CellData>");
  for (const VtuField& field : fields.cells) {
    check_field(field, volumes, "elements");
    std::vector<double> values = field.values;
    values.resize((volumes + triangles) * static_cast<std::size_t>(field.components),
                  std::numeric_limits<double>::quiet_NaN());
    out.field(field.name, field.components, values);
  }
  const SetMasks masks = fields.sets ? cell_masks(mesh, fields.triangles) : SetMasks{};
  for (const auto& [name, mask] : masks) out.array(name, "UInt8", 1, mask);
  out.line("      </CellData>");
}

}  // namespace

std::string format_vtu(const Mesh& mesh, const VtuFields& fields) {
  VtuBuilder out(fields.compressed);
  constexpr bool kLittle = std::endian::native == std::endian::little;
  out.line("<?xml version=\"1.0\"?>");
  out.line(
      fmt::format("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
                  "header_type=\"UInt64\"{}>",
                  kLittle ? "LittleEndian" : "BigEndian",
                  fields.compressed ? " compressor=\"vtkZLibDataCompressor\"" : ""));
  out.line("  <UnstructuredGrid>");
  out.line(fmt::format(
      "    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", mesh.node_count(),
      mesh.tetrahedra.size() + mesh.hexahedra.size() + written_triangles(mesh, fields)));
  write_points(mesh, fields, out);
  write_cells(mesh, fields, out);
  write_point_data(mesh, fields, out);
  write_cell_data(mesh, fields, out);
  out.line("    </Piece>");
  out.line("  </UnstructuredGrid>");
  return out.finish();
}

void write_vtu(const std::filesystem::path& path, const Mesh& mesh, const VtuFields& fields) {
  write_file(path, format_vtu(mesh, fields));
}

}  // namespace sinew::mesh
