#include "sinew/mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "sinew/mesh/quadratic.hpp"

namespace sinew::mesh {

namespace {

/// Sorts the three numbers; returns whether the permutation is even.
bool sort_triangle(Triangle& t) {
  bool even = true;
  const auto order = [&](std::size_t i, std::size_t j) {
    if (t[i] > t[j]) {
      std::swap(t[i], t[j]);
      even = !even;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return even;
}

/// Disjoint sets of nodes, with the lowest node as representative.
class UnionFind {
 public:
  explicit UnionFind(int count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  NodeId find(NodeId node) {
    while (parent(node) != node) {
      parent(node) = parent(parent(node));
      node = parent(node);
    }
    return node;
  }
  void join(NodeId a, NodeId b) {
    a = find(a);
    b = find(b);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  NodeId& parent(NodeId node) { return parent_[static_cast<std::size_t>(node)]; }
  std::vector<NodeId> parent_;
};

template <typename Visit>
void for_each_element(const Mesh& mesh, const Visit& visit) {
  for (const QuadraticTetrahedron& element : mesh.quadratic) visit(element);
  if (mesh.quadratic.empty()) {
    for (const Tetrahedron& element : mesh.tetrahedra) visit(element);
  }
  for (const Hexahedron& element : mesh.hexahedra) visit(element);
}

/// Appends the faces of hexahedra that occur once.
void append_hexahedron_faces(const Mesh& mesh, std::vector<Face>& result) {
  using Quad = std::array<NodeId, 4>;
  std::vector<std::pair<Quad, Quad>> faces;  // sorted nodes, outward nodes
  for (const Hexahedron& hexahedron : mesh.hexahedra) {
    for (const Quad& face : faces_of(hexahedron)) {
      Quad key = face;
      std::sort(key.begin(), key.end());
      faces.emplace_back(key, face);
    }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].first == faces[i].first) ++end;
    if (end == i + 1) result.push_back({.node = faces[i].second});
    i = end;
  }
}

}  // namespace

std::array<Triangle, 4> faces_of(const Tetrahedron& t) {
  return {{{t[1], t[2], t[3]}, {t[0], t[3], t[2]}, {t[0], t[1], t[3]}, {t[0], t[2], t[1]}}};
}

std::array<std::array<NodeId, 4>, 6> faces_of(const Hexahedron& h) {
  return {{{h[0], h[3], h[2], h[1]},
           {h[4], h[5], h[6], h[7]},
           {h[0], h[1], h[5], h[4]},
           {h[1], h[2], h[6], h[5]},
           {h[2], h[3], h[7], h[6]},
           {h[3], h[0], h[4], h[7]}}};
}

std::vector<FaceUse> face_uses(const Mesh& mesh) {
  std::vector<FaceUse> uses;
  uses.reserve(4 * mesh.tetrahedra.size());
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    for (Triangle face : faces_of(mesh.tetrahedra[e])) {
      const bool even = sort_triangle(face);
      uses.push_back({face, even, static_cast<int>(e)});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const FaceUse& a, const FaceUse& b) {
    return std::tie(a.key, a.tetrahedron) < std::tie(b.key, b.tetrahedron);
  });
  return uses;
}

std::vector<Face> boundary_faces(const Mesh& mesh) {
  std::vector<Face> result;
  if (mesh.tetrahedra.empty() && mesh.hexahedra.empty()) {
    for (const auto& [a, b, c] : mesh.triangles) result.push_back({.node = {a, b, c, -1}});
    return result;
  }
  const std::vector<FaceUse> uses = face_uses(mesh);
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i + 1;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    if (end == i + 1) {
      Triangle face = uses[i].key;
      if (!uses[i].even) std::swap(face[1], face[2]);
      Face& outside = result.emplace_back();
      std::copy(face.begin(), face.end(), outside.node.begin());
      if (!mesh.quadratic.empty()) {
        const auto& element = mesh.quadratic[static_cast<std::size_t>(uses[i].tetrahedron)];
        for (std::size_t k = 0; k < 3; ++k) {
          outside.middle[k] = middle_node(element, face[k], face[(k + 1) % 3]);
        }
      }
    }
    i = end;
  }
  append_hexahedron_faces(mesh, result);
  return result;
}

std::vector<NodeId> outer_nodes(const Mesh& mesh) {
  std::vector<NodeId> nodes;
  for (const Face& face : boundary_faces(mesh)) {
    nodes.insert(nodes.end(), face.nodes().begin(), face.nodes().end());
    if (face.is_quadratic()) nodes.insert(nodes.end(), face.middle.begin(), face.middle.end());
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::array<Triangle, 4> quarters(const Face& face) {
  const auto& n = face.node;
  const auto& m = face.middle;
  return {{{n[0], m[0], m[2]}, {m[0], n[1], m[1]}, {m[2], m[1], n[2]}, {m[0], m[1], m[2]}}};
}

namespace {

// Lengths and coordinates that differ by less than this fraction of a face count as equal.
constexpr double kAlike = 1e-9;

// Whether a corner comes first. @param from the other one to this one, along the mesh's axes.
bool lies_before(const Vector3& from, double alike) {
  for (const double difference : from) {
    if (std::abs(difference) > alike) return difference < 0.0;
  }
  return false;
}

// One end of the diagonal along which a quadrilateral is split, see triangles_of().
std::size_t first_corner(const Points& nodes, const Matrix3& axes, const Face& face) {
  const auto at = [&](std::size_t k) -> Vector3 { return nodes.row(face.node[k]).transpose(); };
  const double even = (at(2) - at(0)).norm(), odd = (at(3) - at(1)).norm();
  const double alike = kAlike * std::max(even, odd);
  if (std::abs(even - odd) > alike) return even < odd ? 0 : 1;
  std::size_t first = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    if (lies_before(axes.transpose() * (at(k) - at(first)), alike)) first = k;
  }
  return first;
}

}  // namespace

std::vector<Triangle> triangles_of(const Points& nodes, const Matrix3& axes,
                                   std::span<const Face> faces) {
  std::vector<Triangle> triangles;
  for (const Face& face : faces) {
    if (face.is_quadratic()) {
      std::ranges::copy(quarters(face), std::back_inserter(triangles));
      continue;
    }
    auto n = face.node;
    if (face.corners() == 4) {
      const auto first = static_cast<std::ptrdiff_t>(first_corner(nodes, axes, face));
      std::rotate(n.begin(), n.begin() + first, n.end());
      triangles.push_back({n[0], n[2], n[3]});
    }
    triangles.push_back({n[0], n[1], n[2]});
  }
  return triangles;
}

std::vector<Triangle> triangles_of(const Mesh& mesh, std::span<const Face> faces) {
  return triangles_of(mesh.nodes, mesh.axes, faces);
}

Surface boundary_surface(const Mesh& mesh) {
  return {.name = mesh.name,
          .nodes = mesh.nodes,
          .triangles = triangles_of(mesh, boundary_faces(mesh))};
}

double longest_edge(const Surface& surface) {
  double longest = 0.0;
  for (const Triangle& triangle : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = surface.nodes.row(triangle[k]) - surface.nodes.row(triangle[(k + 1) % 3]);
      longest = std::max(longest, edge.norm());
    }
  }
  return longest;
}

std::vector<char> used_nodes(const Mesh& mesh) {
  std::vector<char> used(static_cast<std::size_t>(mesh.node_count()), 0);
  for_each_element(mesh, [&](const auto& element) {
    for (const NodeId node : element) used[static_cast<std::size_t>(node)] = 1;
  });
  return used;
}

Components components(const Mesh& mesh) {
  UnionFind sets(mesh.node_count());
  for_each_element(mesh, [&](const auto& element) {
    for (const NodeId node : element) sets.join(element[0], node);
  });
  struct Part {
    NodeId first;
    int nodes = 0, elements = 0;
  };
  std::vector<Part> parts;
  std::vector<int> part_of(static_cast<std::size_t>(mesh.node_count()), -1);
  const std::vector<char> used = used_nodes(mesh);
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    const auto n = static_cast<std::size_t>(node);
    if (used[n] == 0) continue;
    const NodeId root = sets.find(node);  // the lowest node, which comes first
    if (root == node) {
      part_of[n] = static_cast<int>(parts.size());
      parts.push_back({.first = node});
    }
    part_of[n] = part_of[static_cast<std::size_t>(root)];
    ++parts[static_cast<std::size_t>(part_of[n])].nodes;
  }
  for_each_element(mesh, [&](const auto& element) {
    const int part = part_of[static_cast<std::size_t>(element[0])];
    ++parts[static_cast<std::size_t>(part)].elements;
  });

  std::vector<int> order(parts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return parts[static_cast<std::size_t>(a)].elements >
           parts[static_cast<std::size_t>(b)].elements;
  });
  Components result;
  std::vector<int> rank(parts.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto part = static_cast<std::size_t>(order[k]);
    rank[part] = static_cast<int>(k);
    result.element_count.push_back(parts[part].elements);
    result.node_count.push_back(parts[part].nodes);
    result.first_node.push_back(parts[part].first);
  }
  for (int& part : part_of) part = part < 0 ? -1 : rank[static_cast<std::size_t>(part)];
  result.of_node = std::move(part_of);
  return result;
}

}  // namespace sinew::mesh
