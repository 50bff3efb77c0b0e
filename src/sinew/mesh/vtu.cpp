#include "sinew/mesh/vtu.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/mesh/raw_mesh.hpp"
#include "sinew/mesh/vtu_array.hpp"

namespace sinew::mesh {

namespace {

class VtuReader {
 public:
  VtuReader(std::string_view bytes, const std::string& name) : file_(bytes, name) {
    raw_.name = name;
  }

  RawMesh read() {
    const pugi::xml_node root = file_.root();
    const std::string_view type = root.attribute("type").as_string();
    const pugi::xml_node grid = root.child("UnstructuredGrid");
    if (type != "UnstructuredGrid" || !grid) {
      file_.fail(ErrorKind::unknown_format, root,
                 fmt::format("VTKFile type=\"{}\" holds no volume mesh", type),
                 "save the mesh as UnstructuredGrid (.vtu)");
    }
    raw_.format = fmt::format("VTU {}", root.attribute("version").as_string("?"));
    for (const pugi::xml_node piece : grid.children("Piece")) read_piece(piece);
    return std::move(raw_);
  }

 private:
  void read_piece(pugi::xml_node piece) {
    const std::size_t points = file_.count(piece, "NumberOfPoints");
    const std::size_t cells = file_.count(piece, "NumberOfCells");
    const auto first_point = static_cast<std::int64_t>(raw_.point_count());
    const std::size_t first_cell = raw_.cell_count();
    if (points > 0) {
      const pugi::xml_node array = piece.child("Points").child("DataArray");
      if (!array) file_.fail(ErrorKind::malformed_file, piece, "the piece has no <Points>");
      const auto coordinates = file_.doubles(array, 3 * points);
      raw_.coordinates.insert(raw_.coordinates.end(), coordinates.begin(), coordinates.end());
    }
    if (cells > 0) read_cells(piece.child("Cells"), cells, first_point);
    read_fields(piece.child("PointData"), points, static_cast<std::size_t>(first_point),
                raw_.point_fields);
    read_fields(piece.child("CellData"), cells, first_cell, raw_.cell_fields);
  }

  pugi::xml_node cell_array(pugi::xml_node node, const char* name) const {
    const pugi::xml_node array = node.find_child_by_attribute("DataArray", "Name", name);
    if (!array) {
      file_.fail(ErrorKind::malformed_file, node, fmt::format("<Cells> has no array `{}`", name));
    }
    return array;
  }

  void read_cells(pugi::xml_node node, std::size_t count, std::int64_t first_point) {
    const auto types = file_.integers(cell_array(node, "types"), count);
    const auto ends = file_.integers(cell_array(node, "offsets"), count);
    const auto connectivity = file_.all_integers(cell_array(node, "connectivity"));
    const auto base = static_cast<std::int64_t>(raw_.connectivity.size());
    for (const std::int64_t point : connectivity) {
      // A negative number must stay negative, so that the range check finds it.
      raw_.connectivity.push_back(point < 0 ? point : point + first_point);
    }
    std::int64_t begin = 0;
    for (std::size_t c = 0; c < count; ++c) {
      if (ends[c] < begin || std::cmp_greater(ends[c], connectivity.size())) {
        file_.fail(ErrorKind::malformed_file, node,
                   fmt::format("cell {} ends at offset {}, but the one before ends at {} and there "
                               "are {} entries",
                               c, ends[c], begin, connectivity.size()));
      }
      begin = ends[c];
      raw_.offsets.push_back(base + ends[c]);
    }
    // Entries after the last cell belong to no cell, and would shift the cells of the next piece.
    raw_.connectivity.resize(static_cast<std::size_t>(base + begin));
    raw_.types.insert(raw_.types.end(), types.begin(), types.end());
  }

  /// Keeps integer arrays with one component; an array that is missing in a piece has no label
  /// there.
  void read_fields(pugi::xml_node node, std::size_t count, std::size_t before,
                   std::vector<IntegerField>& fields) {
    for (const pugi::xml_node array : node.children("DataArray")) {
      const std::string name = array.attribute("Name").as_string();
      if (name.empty() || array.attribute("NumberOfComponents").as_int(1) > 1) continue;
      const ScalarType type = file_.type_of(array);
      if (!is_integer(type)) continue;
      auto values = file_.integers(array, count);
      auto field = std::find_if(fields.begin(), fields.end(),
                                [&](const IntegerField& f) { return f.name == name; });
      if (field == fields.end()) {
        fields.push_back({.name = name, .mask = bytes_of(type) == 1, .values = {}});
        field = fields.end() - 1;
      }
      field->values.resize(before, kNoLabel);
      field->values.insert(field->values.end(), values.begin(), values.end());
    }
    for (IntegerField& field : fields) field.values.resize(before + count, kNoLabel);
  }

  VtuFile file_;
  RawMesh raw_;
};

}  // namespace

Mesh read_vtu(std::string_view bytes, const std::string& name) {
  return assemble(VtuReader(bytes, name).read());
}

}  // namespace sinew::mesh
