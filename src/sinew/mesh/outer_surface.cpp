#include "sinew/mesh/outer_surface.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

/// The elements of faces. A face is given by its sorted corners, with -1 as the fourth of a
/// triangle.
class FaceOwners {
 public:
  explicit FaceOwners(const Mesh& mesh) {
    std::int32_t element = 0;
    for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
      for (const auto& [a, b, c] : faces_of(tetrahedron)) add({a, b, c, -1}, element);
      ++element;
    }
    for (const Hexahedron& hexahedron : mesh.hexahedra) {
      for (const Key& face : faces_of(hexahedron)) add(face, element);
      ++element;
    }
    std::ranges::sort(faces_);
  }
  /// The first element with this face; -1 if there is none.
  std::int32_t of(const Face& face) const {
    const auto found = std::ranges::lower_bound(faces_, std::pair{sorted(face.node), 0});
    return found == faces_.end() || found->first != sorted(face.node) ? -1 : found->second;
  }

 private:
  using Key = std::array<NodeId, 4>;
  static Key sorted(Key key) {
    std::ranges::sort(key);
    return key;
  }
  void add(const Key& face, std::int32_t element) { faces_.emplace_back(sorted(face), element); }

  std::vector<std::pair<Key, std::int32_t>> faces_;
};

/// Numbers nodes in the order of their first use.
class Numbering {
 public:
  Numbering(const Mesh& mesh, std::vector<NodeId>& nodes)
      : vertex_(static_cast<std::size_t>(mesh.node_count()), -1), nodes_(nodes) {}
  void take(std::span<const NodeId> nodes) {
    for (const NodeId node : nodes) vertex_[static_cast<std::size_t>(node)] = next_++;
  }
  std::uint32_t operator()(NodeId node) {
    int& number = vertex_[static_cast<std::size_t>(node)];
    if (number < 0) {
      number = next_++;
      nodes_.push_back(node);
    }
    return static_cast<std::uint32_t>(number);
  }

 private:
  std::vector<int> vertex_;
  std::vector<NodeId>& nodes_;
  int next_ = 0;
};

// Local nodes of the eight tetrahedra of a quadratic one: four at its corners, and four in the
// octahedron of its middle nodes, around the diagonal from the middle of edge 01 to that of 23.
constexpr std::array<std::array<std::size_t, 4>, 8> kEighths = {{{0, 4, 6, 7},
                                                                 {4, 1, 5, 8},
                                                                 {6, 5, 2, 9},
                                                                 {7, 8, 9, 3},
                                                                 {4, 9, 5, 6},
                                                                 {4, 9, 6, 7},
                                                                 {4, 9, 7, 8},
                                                                 {4, 9, 8, 5}}};

}  // namespace

OuterSurface outer_surface(const Mesh& mesh) {
  OuterSurface result;
  const FaceOwners owners(mesh);
  Numbering number(mesh, result.nodes);
  for (const Face& face : boundary_faces(mesh)) {
    const std::int32_t element = owners.of(face);
    for (const Triangle& triangle : triangles_of(mesh, {&face, 1})) {
      for (const NodeId node : triangle) result.triangles.push_back(number(node));
      result.elements.push_back(element);
    }
  }
  return result;
}

Interior interior(const Mesh& mesh, const OuterSurface& surface) {
  Interior result;
  Numbering number(mesh, result.nodes);
  number.take(surface.nodes);
  const auto add = [&](std::int32_t element, const auto& nodes) {
    for (const NodeId node : nodes) result.tetrahedra.push_back(number(node));
    result.elements.push_back(element);
  };
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const auto element = static_cast<std::int32_t>(e);
    if (mesh.quadratic.empty()) {
      add(element, mesh.tetrahedra[e]);
      continue;
    }
    const QuadraticTetrahedron& whole = mesh.quadratic[e];
    for (const auto& [a, b, c, d] : kEighths) {
      add(element, Tetrahedron{whole[a], whole[b], whole[c], whole[d]});
    }
  }
  // Nodes first, so that the middles come after all of them.
  for (const Hexahedron& hexahedron : mesh.hexahedra) {
    for (const NodeId node : hexahedron) static_cast<void>(number(node));
  }
  const std::size_t middles = surface.nodes.size() + result.nodes.size();
  result.hexahedra = mesh.hexahedra;
  for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h) {
    for (const auto& face : faces_of(mesh.hexahedra[h])) {
      const Face outward{.node = face};
      for (const Triangle& triangle : triangles_of(mesh, {&outward, 1})) {
        result.tetrahedra.push_back(static_cast<std::uint32_t>(middles + h));
        for (const NodeId node : triangle) result.tetrahedra.push_back(number(node));
        result.elements.push_back(static_cast<std::int32_t>(mesh.tetrahedra.size() + h));
      }
    }
  }
  return result;
}

}  // namespace sinew::mesh
