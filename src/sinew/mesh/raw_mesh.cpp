#include "sinew/mesh/raw_mesh.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::mesh {

namespace {

constexpr std::size_t kMaxLabels = 256;

/// Destination of a cell of the file: a list of the mesh, and the position in it.
struct Destination {
  enum class List { none, triangles, tetrahedra, hexahedra } list = List::none;
  NodeId position = -1;
};

[[noreturn]] void fail(const RawMesh& raw, ErrorKind kind, const std::string& message,
                       const std::string& remedy = {}) {
  throw Error(kind, {.file = raw.name}, message, remedy);
}

/// Number of points of a cell of this type; 0 if any number is allowed.
std::size_t points_of(std::int64_t type) {
  switch (type) {
    case kVertex:
      return 1;
    case kLine:
      return 2;
    case kTriangle:
      return 3;
    case kQuadrilateral:
    case kTetrahedron:
      return 4;
    case kVoxel:
    case kHexahedron:
      return 8;
    case kQuadraticTetrahedron:
      return 10;
    default:
      return 0;
  }
}

/// Whether a cell is a volume that Sinew cannot simulate, which must not be ignored silently.
bool is_unsupported_volume(std::int64_t type) {
  const bool linear = type == kWedge || type == kPyramid || type == 15 || type == 16;
  const bool quadratic = (type >= 25 && type <= 29) || type == 32 || type == 33 || type == 37;
  const bool arbitrary = type == 42 || (type >= 71 && type <= 74) || (type >= 78 && type <= 81);
  return linear || quadratic || arbitrary;
}

void check_structure(const RawMesh& raw) {
  if (raw.coordinates.size() % 3 != 0) {
    fail(raw, ErrorKind::malformed_file,
         fmt::format("{} coordinates are not a multiple of three", raw.coordinates.size()));
  }
  constexpr std::size_t kMaxNumber = std::numeric_limits<NodeId>::max();
  if (raw.point_count() > kMaxNumber || raw.cell_count() > kMaxNumber) {
    fail(raw, ErrorKind::size_limit, "more than 2^31 - 1 points or cells");
  }
  if (raw.offsets.size() != raw.cell_count() + 1) {
    fail(raw, ErrorKind::malformed_file,
         fmt::format("{} cells have a type, but {} have points", raw.cell_count(),
                     raw.offsets.empty() ? 0 : raw.offsets.size() - 1));
  }
  for (std::size_t c = 0; c < raw.cell_count(); ++c) {
    const bool in_order = raw.offsets[c] >= 0 && raw.offsets[c] <= raw.offsets[c + 1] &&
                          std::cmp_less_equal(raw.offsets[c + 1], raw.connectivity.size());
    if (!in_order) {
      fail(raw, ErrorKind::malformed_file,
           fmt::format("cell {} has the offsets {} to {}, but the list of points of all cells has "
                       "{} entries",
                       c, raw.offsets[c], raw.offsets[c + 1], raw.connectivity.size()));
    }
  }
}

void check_cell(const RawMesh& raw, std::size_t c) {
  const std::int64_t type = raw.types[c];
  if (is_unsupported_volume(type)) {
    fail(raw, ErrorKind::unsupported_element,
         fmt::format("cell {} is a {}; only tetrahedra and linear hexahedra are simulated", c,
                     cell_type_name(type)),
         "mesh with tetrahedra (in Gmsh: Mesh.ElementOrder = 1 or 2)");
  }
  const auto count = static_cast<std::size_t>(raw.offsets[c + 1] - raw.offsets[c]);
  if (points_of(type) != 0 && points_of(type) != count) {
    fail(raw, ErrorKind::malformed_file,
         fmt::format("cell {} is a {} with {} points instead of {}", c, cell_type_name(type), count,
                     points_of(type)));
  }
  for (auto k = raw.offsets[c]; k < raw.offsets[c + 1]; ++k) {
    const std::int64_t node = raw.connectivity[static_cast<std::size_t>(k)];
    if (node < 0 || std::cmp_greater_equal(node, raw.point_count())) {
      fail(raw, ErrorKind::index_out_of_range,
           fmt::format("cell {} ({}) uses node {}, but the file has {} nodes, numbered from 0", c,
                       cell_type_name(type), node, raw.point_count()),
           "write the mesh again from the program that made it");
    }
  }
}

template <std::size_t N>
std::array<NodeId, N> nodes_of(const RawMesh& raw, std::size_t cell) {
  std::array<NodeId, N> nodes;
  for (std::size_t k = 0; k < N; ++k) {
    nodes[k] =
        static_cast<NodeId>(raw.connectivity[static_cast<std::size_t>(raw.offsets[cell]) + k]);
  }
  return nodes;
}

template <typename List, typename Cell>
NodeId append(List& list, const Cell& cell) {
  list.push_back(cell);
  return static_cast<NodeId>(list.size() - 1);
}

Destination place_cell(const RawMesh& raw, std::size_t c, Mesh& mesh) {
  using List = Destination::List;
  switch (raw.types[c]) {
    case kTriangle:
      return {List::triangles, append(mesh.triangles, nodes_of<3>(raw, c))};
    case kTetrahedron:
      return {List::tetrahedra, append(mesh.tetrahedra, nodes_of<4>(raw, c))};
    case kQuadraticTetrahedron: {
      const auto nodes = nodes_of<10>(raw, c);
      mesh.quadratic.push_back(nodes);
      return {List::tetrahedra,
              append(mesh.tetrahedra, Tetrahedron{nodes[0], nodes[1], nodes[2], nodes[3]})};
    }
    case kHexahedron:
      return {List::hexahedra, append(mesh.hexahedra, nodes_of<8>(raw, c))};
    case kVoxel: {
      auto nodes = nodes_of<8>(raw, c);  // a voxel is numbered along the axes, a hexahedron around
      std::swap(nodes[2], nodes[3]);
      std::swap(nodes[6], nodes[7]);
      return {List::hexahedra, append(mesh.hexahedra, nodes)};
    }
    default:
      ++mesh.notes.passed_over_cells;
      return {};
  }
}

/// Adds a cell of the file to the sets called `name`: triangles and volumes by position; vertices,
/// lines and quadrilaterals by their nodes.
void add_to_set(const RawMesh& raw, const std::vector<Destination>& where, std::size_t cell,
                const std::string& name, Mesh& mesh) {
  const auto [list, position] = where[cell];
  switch (list) {
    case Destination::List::triangles:
      mesh.triangle_sets[name].push_back(position);
      break;
    case Destination::List::tetrahedra:
      mesh.tetrahedron_sets[name].push_back(position);
      break;
    case Destination::List::hexahedra:
      mesh.hexahedron_sets[name].push_back(position);
      break;
    case Destination::List::none:
      for (auto k = raw.offsets[cell]; k < raw.offsets[cell + 1]; ++k) {
        mesh.node_sets[name].push_back(
            static_cast<NodeId>(raw.connectivity[static_cast<std::size_t>(k)]));
      }
  }
}

/// Calls add(set name, position) for every entry of an integer field that belongs to a set.
template <typename Add>
void for_each_label(const IntegerField& field, const Add& add) {
  const std::set<std::int64_t> labels = [&] {
    std::set<std::int64_t> distinct;
    for (const std::int64_t value : field.values) {
      if (value != kNoLabel) distinct.insert(value);
      if (distinct.size() > kMaxLabels) break;
    }
    return distinct;
  }();
  if (labels.size() > kMaxLabels) return;
  const bool mask = field.mask && !labels.empty() && *labels.begin() >= 0 && *labels.rbegin() <= 1;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    if (field.values[i] == kNoLabel) continue;
    if (mask) {
      if (field.values[i] == 1) add(field.name, i);
    } else {
      add(fmt::format("{}:{}", field.name, field.values[i]), i);
    }
  }
}

void sort_sets(std::map<std::string, std::vector<NodeId>>& sets) {
  for (auto& [name, members] : sets) {
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
  }
}

void check_field(const RawMesh& raw, const IntegerField& field, std::size_t count,
                 std::string_view what) {
  if (field.values.size() == count) return;
  fail(raw, ErrorKind::malformed_file,
       fmt::format("the {} data `{}` have {} values for {} {}s", what, field.name,
                   field.values.size(), count, what));
}

void make_sets(const RawMesh& raw, const std::vector<Destination>& where, Mesh& mesh) {
  for (const IntegerField& field : raw.point_fields) {
    check_field(raw, field, raw.point_count(), "point");
    for_each_label(field, [&](const std::string& name, std::size_t node) {
      mesh.node_sets[name].push_back(static_cast<NodeId>(node));
    });
  }
  for (const IntegerField& field : raw.cell_fields) {
    check_field(raw, field, raw.cell_count(), "cell");
    for_each_label(field, [&](const std::string& name, std::size_t cell) {
      add_to_set(raw, where, cell, name, mesh);
    });
  }
  for (const CellGroup& group : raw.groups) {
    for (const std::size_t cell : group.cells) add_to_set(raw, where, cell, group.name, mesh);
  }
  for (auto* sets :
       {&mesh.node_sets, &mesh.triangle_sets, &mesh.tetrahedron_sets, &mesh.hexahedron_sets}) {
    sort_sets(*sets);
  }
}

}  // namespace

std::string cell_type_name(std::int64_t type) {
  switch (type) {
    case kVertex:
      return "vertex";
    case kLine:
      return "line";
    case kTriangle:
      return "triangle";
    case kQuadrilateral:
      return "quadrilateral";
    case kTetrahedron:
      return "tetrahedron";
    case kVoxel:
      return "voxel";
    case kHexahedron:
      return "hexahedron";
    case kWedge:
      return "wedge";
    case kPyramid:
      return "pyramid";
    case kQuadraticTetrahedron:
      return "quadratic tetrahedron";
    case kQuadraticHexahedron:
      return "quadratic hexahedron";
    default:
      return fmt::format("cell of type {}", type);
  }
}

Mesh assemble(const RawMesh& raw) {
  check_structure(raw);
  Mesh mesh;
  mesh.name = raw.name;
  mesh.notes.format = raw.format;
  mesh.nodes = Eigen::Map<const Points>(raw.coordinates.data(),
                                        static_cast<Eigen::Index>(raw.point_count()), 3);
  std::vector<Destination> where(raw.cell_count());
  for (std::size_t c = 0; c < raw.cell_count(); ++c) {
    check_cell(raw, c);
    where[c] = place_cell(raw, c, mesh);
  }
  const bool mixed = !mesh.quadratic.empty() &&
                     (mesh.quadratic.size() != mesh.tetrahedra.size() || !mesh.hexahedra.empty());
  if (mixed) {
    fail(raw, ErrorKind::unsupported_element,
         fmt::format("{} quadratic tetrahedra stand beside {} linear tetrahedra and {} hexahedra",
                     mesh.quadratic.size(), mesh.tetrahedra.size() - mesh.quadratic.size(),
                     mesh.hexahedra.size()),
         "mesh with one kind of element");
  }
  make_sets(raw, where, mesh);
  return mesh;
}

}  // namespace sinew::mesh
