#include "sinew/mesh/gmsh_input.hpp"

#include <cstdlib>
#include <optional>

#include <fmt/format.h>

namespace sinew::mesh {

namespace {

/// One of Gmsh's element types: nodes, dimension, and the VTK type that it is read as.
struct ElementType {
  int nodes = 0;
  int dimension = 0;
  int cell = 0;
};

constexpr int kPassedOver = 0;  // a cell type that is counted and otherwise ignored

std::optional<ElementType> element_type(std::int64_t type) {
  switch (type) {
    case 1:
      return ElementType{2, 1, kLine};
    case 2:
      return ElementType{3, 2, kTriangle};
    case 3:
      return ElementType{4, 2, kQuadrilateral};
    case 4:
      return ElementType{4, 3, kTetrahedron};
    case 5:
      return ElementType{8, 3, kHexahedron};
    case 6:
      return ElementType{6, 3, kWedge};
    case 7:
      return ElementType{5, 3, kPyramid};
    case 8:
      return ElementType{3, 1, kPassedOver};
    case 9:
      return ElementType{6, 2, kPassedOver};
    case 10:
      return ElementType{9, 2, kPassedOver};
    case 11:
      return ElementType{10, 3, kQuadraticTetrahedron};
    case 12:
      return ElementType{27, 3, kQuadraticHexahedron};
    case 13:
      return ElementType{18, 3, kWedge};
    case 14:
      return ElementType{14, 3, kPyramid};
    case 15:
      return ElementType{1, 0, kVertex};
    case 16:
      return ElementType{8, 2, kPassedOver};
    case 17:
      return ElementType{20, 3, kQuadraticHexahedron};
    case 18:
      return ElementType{15, 3, kWedge};
    case 19:
      return ElementType{13, 3, kPyramid};
    default:
      return std::nullopt;
  }
}

}  // namespace

GmshInput::GmshInput(std::string_view bytes, const std::string& name) : reader_(bytes, name) {
  raw_.name = name;
}

void GmshInput::set_binary(ByteOrder order) {
  binary_ = true;
  order_ = order;
  reader_.mark_binary();
}

std::int64_t GmshInput::integer(std::string_view what) {
  if (!binary_) return reader_.integer(what);
  return decode_integers(reader_.block(4, what), ScalarType::int32, order_)[0];
}

std::int64_t GmshInput::size(std::string_view what) {
  if (!binary_) return reader_.integer(what);
  return decode_integers(reader_.block(8, what), ScalarType::uint64, order_)[0];
}

double GmshInput::real(std::string_view what) {
  if (!binary_) return reader_.number(what);
  return decode_doubles(reader_.block(8, what), ScalarType::float64, order_)[0];
}

std::size_t GmshInput::count(std::int64_t given, std::size_t binary_bytes, std::size_t words,
                             std::string_view what) {
  return reader_.checked_count(given, binary_ ? binary_bytes : 2 * words, what);
}

void GmshInput::add_node_tag(std::int64_t tag) {
  const auto number = static_cast<std::int64_t>(node_of_tag_.size());
  if (!node_of_tag_.emplace(tag, number).second) {
    reader_.fail(ErrorKind::duplicate_node, fmt::format("node {} is given twice", tag),
                 "give every node its own number");
  }
}

void GmshInput::add_coordinates(double x, double y, double z) {
  raw_.coordinates.insert(raw_.coordinates.end(), {x, y, z});
}

std::size_t GmshInput::nodes_of_type(std::int64_t type) {
  const auto known = element_type(type);
  if (!known) {
    reader_.fail(ErrorKind::unsupported_element,
                 fmt::format("elements of Gmsh's type {} are not read", type),
                 "mesh with linear tetrahedra (Mesh.ElementOrder = 1)");
  }
  return static_cast<std::size_t>(known->nodes);
}

void GmshInput::add_element(std::int64_t element_tag, std::int64_t type,
                            const std::vector<std::int64_t>& node_tags,
                            const std::vector<std::int64_t>& physical_tags) {
  const ElementType known = element_type(type).value_or(ElementType{});
  std::vector<std::int64_t> nodes;
  for (const std::int64_t tag : node_tags) {
    const auto found = node_of_tag_.find(tag);
    if (found == node_of_tag_.end()) {
      reader_.fail(
          ErrorKind::index_out_of_range,
          fmt::format("element {} uses node {}, which the file does not have", element_tag, tag),
          "write the mesh again from Gmsh");
    }
    nodes.push_back(found->second);
  }
  // The last two middle nodes have the opposite order in Gmsh and VTK.
  if (known.cell == kQuadraticTetrahedron) std::swap(nodes[8], nodes[9]);
  const bool repeated = elements_repeat_ && nodes == last_nodes_ && physical_tags != last_groups_;
  const std::size_t cell = repeated ? raw_.cell_count() - 1 : raw_.cell_count();
  for (const std::int64_t tag : physical_tags) {
    // The sign of a tag is an orientation.
    if (tag != 0) members_[{known.dimension, std::abs(tag)}].push_back(cell);
  }
  if (!repeated) raw_.add_cell(known.cell, nodes.data(), nodes.size());
  last_groups_ = physical_tags;
  last_nodes_ = std::move(nodes);
}

RawMesh GmshInput::take() {
  for (auto& [group, cells] : members_) {
    const auto named = names_.find(group);
    raw_.groups.push_back(
        {.name = named != names_.end() ? named->second : fmt::format("physical:{}", group.second),
         .cells = std::move(cells)});
  }
  return std::move(raw_);
}

}  // namespace sinew::mesh
