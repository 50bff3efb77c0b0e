#include "sinew/mesh/refine.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/quality.hpp"

namespace sinew::mesh {

namespace {

/// Numbers the middles of edges in the order of their first use.
class EdgeMiddles {
 public:
  explicit EdgeMiddles(NodeId first) : next_(first) {}

  NodeId operator()(NodeId a, NodeId b) {
    const auto low = static_cast<std::uint64_t>(std::min(a, b));
    const auto high = static_cast<std::uint64_t>(std::max(a, b));
    const auto [entry, added] = numbers_.try_emplace((high << 32) | low, next_);
    if (added) {
      ends_.emplace_back(static_cast<NodeId>(low), static_cast<NodeId>(high));
      ++next_;
    }
    return entry->second;
  }

  const std::vector<std::pair<NodeId, NodeId>>& ends() const { return ends_; }

 private:
  NodeId next_;
  std::unordered_map<std::uint64_t, NodeId> numbers_;
  std::vector<std::pair<NodeId, NodeId>> ends_;
};

/// Edge middles of a tetrahedron, named after the ends.
enum Middle : std::size_t { k01, k02, k03, k12, k13, k23 };

/// A diagonal of the inner octahedron and the ring of nodes around it.
struct Diagonal {
  Middle from, to;
  std::array<Middle, 5> ring;
};
constexpr std::array<Diagonal, 3> kDiagonals = {{
    {k02, k13, {k01, k03, k23, k12, k01}},
    {k01, k23, {k02, k03, k13, k12, k02}},
    {k03, k12, {k01, k02, k23, k13, k01}},
}};

/// Position of the middle of an edge.
Vector3 middle_of(const Mesh& mesh, const Tetrahedron& t, Middle m) {
  constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kEnds = {
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  const auto [a, b] = kEnds[m];
  return 0.5 * (mesh.nodes.row(t[a]) + mesh.nodes.row(t[b]));
}

/// The shortest diagonal; of equal ones, the first.
const Diagonal& shortest_diagonal(const Mesh& mesh, const Tetrahedron& t) {
  const Diagonal* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Diagonal& diagonal : kDiagonals) {
    const double length =
        (middle_of(mesh, t, diagonal.from) - middle_of(mesh, t, diagonal.to)).squaredNorm();
    // Rounding must not decide between equal lengths.
    if (best == nullptr || length < least * (1.0 - 1e-9)) {
      best = &diagonal;
      least = length;
    }
  }
  return *best;
}

void split_tetrahedron(const Mesh& mesh, const Tetrahedron& t, EdgeMiddles& middles, Mesh& fine) {
  const std::array<NodeId, 6> m = {middles(t[0], t[1]), middles(t[0], t[2]), middles(t[0], t[3]),
                                   middles(t[1], t[2]), middles(t[1], t[3]), middles(t[2], t[3])};
  auto& list = fine.tetrahedra;
  list.push_back({t[0], m[k01], m[k02], m[k03]});
  list.push_back({m[k01], t[1], m[k12], m[k13]});
  list.push_back({m[k02], m[k12], t[2], m[k23]});
  list.push_back({m[k03], m[k13], m[k23], t[3]});
  const Diagonal& diagonal = shortest_diagonal(mesh, t);
  for (std::size_t k = 0; k < 4; ++k) {
    const Middle a = diagonal.ring[k], b = diagonal.ring[k + 1];
    const Corners corners = {middle_of(mesh, t, diagonal.from), middle_of(mesh, t, diagonal.to),
                             middle_of(mesh, t, a), middle_of(mesh, t, b)};
    Tetrahedron inner = {m[diagonal.from], m[diagonal.to], m[a], m[b]};
    if (signed_volume(corners) < 0.0) std::swap(inner[2], inner[3]);
    list.push_back(inner);
  }
}

void split_triangle(const Triangle& t, EdgeMiddles& middles, Mesh& fine) {
  const NodeId m01 = middles(t[0], t[1]), m12 = middles(t[1], t[2]), m20 = middles(t[2], t[0]);
  fine.triangles.push_back({t[0], m01, m20});
  fine.triangles.push_back({m01, t[1], m12});
  fine.triangles.push_back({m20, m12, t[2]});
  fine.triangles.push_back({m01, m12, m20});
}

using Sets = std::map<std::string, std::vector<NodeId>>;

/// Element sets after refinement: each element became `parts` consecutive ones.
Sets split_sets(const Sets& sets, NodeId parts) {
  Sets result;
  for (const auto& [name, members] : sets) {
    auto& list = result[name];
    for (const NodeId member : members) {
      for (NodeId k = 0; k < parts; ++k) list.push_back(parts * member + k);
    }
  }
  return result;
}

Sets extend_node_sets(const Sets& sets, NodeId old_nodes,
                      const std::vector<std::pair<NodeId, NodeId>>& ends) {
  Sets result = sets;
  for (auto& [name, members] : result) {
    std::vector<char> inside(static_cast<std::size_t>(old_nodes), 0);
    for (const NodeId node : members) inside[static_cast<std::size_t>(node)] = 1;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const auto [a, b] = ends[k];
      if (inside[static_cast<std::size_t>(a)] != 0 && inside[static_cast<std::size_t>(b)] != 0) {
        members.push_back(old_nodes + static_cast<NodeId>(k));
      }
    }
  }
  return result;
}

void check_input(const Mesh& mesh) {
  if (!mesh.quadratic.empty()) {
    throw Error(ErrorKind::unsupported_element, {.file = mesh.name},
                "the mesh has quadratic tetrahedra; only linear ones are refined",
                "refine before middle nodes are added");
  }
  if (!mesh.hexahedra.empty()) {
    throw Error(ErrorKind::unsupported_element, {.file = mesh.name},
                fmt::format("the mesh has {} hexahedra; only tetrahedra are refined",
                            mesh.hexahedra.size()));
  }
  // A tetrahedron adds eight elements and at most six nodes.
  if (mesh.tetrahedra.size() > std::numeric_limits<NodeId>::max() / 8) {
    throw Error(
        ErrorKind::size_limit, {.file = mesh.name},
        fmt::format("refining {} tetrahedra gives more than 2^31 - 1", mesh.tetrahedra.size()));
  }
}

}  // namespace

Mesh refine(const Mesh& mesh) {
  check_input(mesh);
  Mesh fine;
  fine.name = mesh.name;
  fine.notes = mesh.notes;
  fine.tetrahedra.reserve(8 * mesh.tetrahedra.size());
  EdgeMiddles middles(mesh.node_count());
  for (const Tetrahedron& t : mesh.tetrahedra) split_tetrahedron(mesh, t, middles, fine);
  for (const Triangle& t : mesh.triangles) split_triangle(t, middles, fine);

  const auto& ends = middles.ends();
  fine.nodes.resize(mesh.node_count() + static_cast<Eigen::Index>(ends.size()), 3);
  fine.nodes.topRows(mesh.node_count()) = mesh.nodes;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    fine.nodes.row(mesh.node_count() + static_cast<Eigen::Index>(k)) =
        0.5 * (mesh.nodes.row(ends[k].first) + mesh.nodes.row(ends[k].second));
  }
  fine.node_sets = extend_node_sets(mesh.node_sets, mesh.node_count(), ends);
  fine.tetrahedron_sets = split_sets(mesh.tetrahedron_sets, 8);
  fine.triangle_sets = split_sets(mesh.triangle_sets, 4);
  return fine;
}

}  // namespace sinew::mesh
