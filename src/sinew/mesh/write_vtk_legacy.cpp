#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "sinew/mesh/raw_mesh.hpp"
#include "sinew/mesh/set_masks.hpp"
#include "sinew/mesh/write_mesh.hpp"

namespace sinew::mesh {

namespace {

// Binary legacy files are big-endian on every machine.
template <typename Value>
void append(std::string& bytes, Value value) {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Value));
  if (std::endian::native == std::endian::little) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

/// Cells in the layout of the file (number of nodes, then the nodes), and their types.
class CellTable {
 public:
  template <typename Elements>
  void add(const Elements& elements, CellType type) {
    for (const auto& element : elements) {
      append(nodes_, static_cast<std::int32_t>(element.size()));
      for (const NodeId node : element) append(nodes_, static_cast<std::int32_t>(node));
      append(types_, static_cast<std::int32_t>(type));
      numbers_ += 1 + element.size();
      ++count_;
    }
  }

  std::string text() const {
    return fmt::format("CELLS {} {}\n", count_, numbers_) + nodes_ +
           fmt::format("\nCELL_TYPES {}\n", count_) + types_ + "\n";
  }
  std::size_t count() const { return count_; }

 private:
  std::string nodes_, types_;
  std::size_t count_ = 0, numbers_ = 0;
};

CellTable cells_of(const Mesh& mesh) {
  CellTable table;
  if (mesh.quadratic.empty()) {
    table.add(mesh.tetrahedra, kTetrahedron);
  } else {
    table.add(mesh.quadratic, kQuadraticTetrahedron);
  }
  table.add(mesh.hexahedra, kHexahedron);
  table.add(mesh.triangles, kTriangle);
  return table;
}

/// Percent-encodes white space, quotes and non-ASCII bytes in a name; VTK decodes them.
std::string percent_encoded(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    const bool plain = code > ' ' && code < 127 && c != '%' && c != '"';
    result += plain ? std::string(1, c) : fmt::format("%{:02X}", code);
  }
  return result;
}

std::string mask_fields(const char* heading, std::size_t count, const SetMasks& masks) {
  if (masks.empty()) return {};
  std::string text = fmt::format("{} {}\nFIELD FieldData {}\n", heading, count, masks.size());
  for (const auto& [name, mask] : masks) {
    text += fmt::format("{} 1 {} unsigned_char\n", percent_encoded(name), mask.size());
    text.append(mask.begin(), mask.end());
    text += '\n';
  }
  return text;
}

}  // namespace

std::string format_vtk_legacy(const Mesh& mesh) {
  const auto nodes = static_cast<std::size_t>(mesh.node_count());
  std::string text = "# vtk DataFile Version 4.2\nSinew, lengths in m\nBINARY\n";
  text += fmt::format("DATASET UNSTRUCTURED_GRID\nPOINTS {} double\n", nodes);
  for (const double coordinate : mesh.nodes.reshaped<Eigen::RowMajor>()) append(text, coordinate);
  const CellTable cells = cells_of(mesh);
  text += "\n" + cells.text();
  text += mask_fields("POINT_DATA", nodes, node_masks(mesh));
  text += mask_fields("CELL_DATA", cells.count(), cell_masks(mesh, true));
  return text;
}

}  // namespace sinew::mesh
