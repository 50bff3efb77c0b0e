#include "sinew/mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "sinew/mesh/duplicates.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

using MaybeDefect = std::optional<Defect>;

std::string and_others(int count) {
  return count > 1 ? fmt::format(" ({} such in all)", count) : std::string();
}

template <std::size_t N>
std::string text_of(const std::array<NodeId, N>& nodes) {
  return fmt::format("{}", fmt::join(nodes, ", "));
}

std::string text_of(const Vector3& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x(), x.y(), x.z());
}

/// The 2x2x2 corner Jacobians of a hexahedron: x_xi . (x_eta x x_zeta) from the edges at a corner.
std::array<double, 8> corner_jacobians(const Mesh& mesh, const Hexahedron& h) {
  // Each corner with its neighbours in a right-handed order.
  constexpr std::array<std::array<std::size_t, 3>, 8> kNeighbours = {
      {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
  std::array<double, 8> jacobians;
  for (std::size_t k = 0; k < 8; ++k) {
    const Corners corners{mesh.nodes.row(h[k]), mesh.nodes.row(h[kNeighbours[k][0]]),
                          mesh.nodes.row(h[kNeighbours[k][1]]),
                          mesh.nodes.row(h[kNeighbours[k][2]])};
    jacobians[k] = 6.0 * signed_volume(corners);
  }
  return jacobians;
}

double longest_diagonal(const Mesh& mesh, const Hexahedron& h) {
  double longest = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t opposite = k < 2 ? k + 6 : k + 2;
    longest = std::max(longest, (mesh.nodes.row(h[k]) - mesh.nodes.row(h[opposite])).norm());
  }
  return longest;
}

MaybeDefect no_elements(const Mesh& mesh) {
  if (!mesh.tetrahedra.empty() || !mesh.hexahedra.empty()) return {};
  return Defect{
      ErrorKind::no_volume_elements,
      fmt::format("the mesh has {} nodes and {} triangles, but no tetrahedra or hexahedra",
                  mesh.node_count(), mesh.triangles.size()),
      "fill the surface with tetrahedra: sinew mesh FILE.stl -o FILE.vtu --size 5mm"};
}

template <typename List>
MaybeDefect bad_index(const Mesh& mesh, const List& elements, const char* what) {
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (const NodeId node : elements[e]) {
      if (node >= 0 && node < mesh.node_count()) continue;
      return Defect{ErrorKind::index_out_of_range,
                    fmt::format("{} {} uses node {}, but the mesh has {} nodes, numbered from 0",
                                what, e, node, mesh.node_count()),
                    "correct the node number"};
    }
  }
  return {};
}

MaybeDefect bad_set(const std::map<std::string, std::vector<NodeId>>& sets, std::size_t size,
                    const char* what) {
  for (const auto& [name, members] : sets) {
    for (const NodeId member : members) {
      if (member >= 0 && std::cmp_less(member, size)) continue;
      return Defect{
          ErrorKind::index_out_of_range,
          fmt::format("set `{}` holds {} {}, but there are only {}", name, what, member, size),
          "correct the set"};
    }
  }
  return {};
}

MaybeDefect bad_indices(const Mesh& mesh) {
  if (auto defect = bad_index(mesh, mesh.tetrahedra, "tetrahedron")) return defect;
  if (auto defect = bad_index(mesh, mesh.hexahedra, "hexahedron")) return defect;
  if (auto defect = bad_index(mesh, mesh.triangles, "triangle")) return defect;
  const auto nodes = static_cast<std::size_t>(mesh.node_count());
  if (auto defect = bad_set(mesh.node_sets, nodes, "node")) return defect;
  if (auto defect = bad_set(mesh.tetrahedron_sets, mesh.tetrahedra.size(), "tetrahedron")) {
    return defect;
  }
  if (auto defect = bad_set(mesh.hexahedron_sets, mesh.hexahedra.size(), "hexahedron")) {
    return defect;
  }
  return bad_set(mesh.triangle_sets, mesh.triangles.size(), "triangle");
}

MaybeDefect not_finite(const Mesh& mesh) {
  int count = 0;
  NodeId first = -1;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    if ((mesh.nodes.row(node).array().abs() <= kFarthestNode).all()) continue;
    if (count++ == 0) first = node;
  }
  if (count == 0) return {};
  const Vector3 place = mesh.nodes.row(first);
  return Defect{
      ErrorKind::non_finite_node,
      fmt::format("node {} is at {} m{}", first, text_of(place), and_others(count)),
      place.allFinite()
          ? fmt::format("coordinates are at most {:g} m; check its unit, or write the mesh again",
                        kFarthestNode)
          : "every coordinate must be a finite number; write the mesh again"};
}

MaybeDefect suspicious_size(const Mesh& mesh, const CheckOptions& options) {
  if (options.unit_given || mesh.node_count() == 0) return {};
  const double size =
      (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).maxCoeff();
  if (size <= options.largest_size) return {};
  return Defect{
      ErrorKind::suspicious_unit,
      fmt::format("the mesh is {:.4g} m large, since no unit is given", size),
      fmt::format("if the file is in millimetres (the mesh is then {:.4g} mm large), write "
                  "`unit: mm` in a scene, --unit mm on the command line; else `unit: m`",
                  size)};
}

template <typename List>
MaybeDefect repeated_node(const List& elements, const char* what) {
  int count = 0;
  std::size_t first = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    auto sorted = elements[e];
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) continue;
    if (count++ == 0) first = e;
  }
  if (count == 0) return {};
  return Defect{ErrorKind::repeated_node_in_element,
                fmt::format("{} {} names a node twice: {}{}", what, first, text_of(elements[first]),
                            and_others(count)),
                "remove the element or correct its nodes"};
}

MaybeDefect duplicate_nodes(const Mesh& mesh) {
  const auto pairs = find_duplicate_nodes(mesh.nodes, used_nodes(mesh), 1e-9);
  if (pairs.empty()) return {};
  const auto [first, second] = pairs.front();
  return Defect{ErrorKind::duplicate_node,
                fmt::format("nodes {} and {} are at the same place {} m{}", first, second,
                            text_of(Vector3(mesh.nodes.row(first))),
                            and_others(static_cast<int>(pairs.size()))),
                "merge them, or the elements on either side come apart (in Gmsh: Coherence Mesh)"};
}

MaybeDefect zero_volume(const Mesh& mesh, double smallest) {
  int count = 0;
  std::string first;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const Corners corners = corners_of(mesh, e);
    const double volume = signed_volume(corners);
    const double edge = longest_edge(corners);
    if (volume > smallest * edge * edge * edge) continue;
    if (count++ > 0) continue;
    first =
        fmt::format("tetrahedron {} (nodes {}) is flat: volume {:.3g} m^3 with an edge of {:.3g} m",
                    e, text_of(mesh.tetrahedra[static_cast<std::size_t>(e)]), volume, edge);
  }
  for (std::size_t e = 0; e < mesh.hexahedra.size(); ++e) {
    const double volume = signed_volume(mesh, mesh.hexahedra[e]);
    const double edge = longest_diagonal(mesh, mesh.hexahedra[e]);
    if (volume > smallest * edge * edge * edge) continue;
    if (count++ > 0) continue;
    first = fmt::format("hexahedron {} (nodes {}) is flat: volume {:.3g} m^3", e,
                        text_of(mesh.hexahedra[e]), volume);
  }
  if (count == 0) return {};
  return Defect{ErrorKind::zero_volume, first + and_others(count),
                "remesh; mesh optimisation removes such slivers (in Gmsh: Mesh.Optimize = 1)"};
}

/// Finds overlaps: a face may have only two uses, from opposite sides.
MaybeDefect overlap(const Mesh& mesh) {
  const std::vector<FaceUse> uses = face_uses(mesh);
  std::vector<int> faults(mesh.tetrahedra.size(), 0);
  int count = 0;
  const FaceUse* first = nullptr;
  for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
    if (uses[i].key != uses[i + 1].key) continue;
    const bool third = i + 2 < uses.size() && uses[i + 2].key == uses[i].key;
    if (uses[i].even != uses[i + 1].even && !third) continue;
    ++faults[static_cast<std::size_t>(uses[i].tetrahedron)];
    ++faults[static_cast<std::size_t>(uses[i + 1].tetrahedron)];
    if (count++ == 0) first = &uses[i];
  }
  if (count == 0) return {};
  const auto worst = std::max_element(faults.begin(), faults.end()) - faults.begin();
  return Defect{
      ErrorKind::inverted_element,
      fmt::format("tetrahedra {} and {} lie on the same side of their common face (nodes {}): the "
                  "mesh folds over itself there; {} such faces in all, most at tetrahedron {} "
                  "(nodes {})",
                  first[0].tetrahedron, first[1].tetrahedron, text_of(first->key), count, worst,
                  text_of(mesh.tetrahedra[static_cast<std::size_t>(worst)])),
      "an element is inverted or there twice: move its nodes back or remesh"};
}

MaybeDefect inverted_hexahedron(const Mesh& mesh) {
  int count = 0;
  std::string first;
  for (std::size_t e = 0; e < mesh.hexahedra.size(); ++e) {
    const auto jacobians = corner_jacobians(mesh, mesh.hexahedra[e]);
    const auto worst = std::min_element(jacobians.begin(), jacobians.end());
    if (*worst > 0.0 || count++ > 0) continue;
    const auto corner = static_cast<std::size_t>(worst - jacobians.begin());
    first = fmt::format("hexahedron {} is turned inside out at node {} (Jacobian {:.3g} m^3)", e,
                        mesh.hexahedra[e][corner], *worst);
  }
  if (count == 0) return {};
  return Defect{ErrorKind::inverted_element, first + and_others(count),
                "check the node order (bottom face, then top face) or remesh"};
}

/// Finds boundary triangles of tetrahedra whose corners are three of those of a boundary
/// quadrilateral of hexahedra. The two kinds meet there without conforming.
MaybeDefect non_conforming(const Mesh& mesh) {
  if (mesh.tetrahedra.empty() || mesh.hexahedra.empty()) return {};
  std::vector<Triangle> corners;
  const std::vector<Face> faces = boundary_faces(mesh);
  const auto sorted = [](Triangle nodes) {
    std::ranges::sort(nodes);
    return nodes;
  };
  for (const Face& face : faces) {
    const auto& n = face.node;
    if (face.corners() != 4) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      corners.push_back(sorted({n[k], n[(k + 1) % 4], n[(k + 2) % 4]}));
    }
  }
  std::ranges::sort(corners);
  int count = 0;
  std::string first;
  for (const Face& face : faces) {
    if (face.corners() != 3) continue;
    const Triangle nodes{face.node[0], face.node[1], face.node[2]};
    if (!std::ranges::binary_search(corners, sorted(nodes)) || count++ > 0) continue;
    Vector3 centre = Vector3::Zero();
    for (const NodeId node : nodes) centre += mesh.nodes.row(node).transpose() / 3.0;
    first = fmt::format(
        "a tetrahedron's face (nodes {}) meets a hexahedron's at {}: faces of three "
        "and of four nodes do not conform",
        text_of(nodes), text_of(centre));
  }
  if (count == 0) return {};
  return Defect{ErrorKind::unsupported_element, first + and_others(count),
                "mesh the body with one kind, or as two bodies"};
}

MaybeDefect several_components(const Mesh& mesh, const CheckOptions& options) {
  if (options.allow_several_components) return {};
  const Components parts = components(mesh);
  if (parts.node_count.size() < 2) return {};
  std::string sizes;
  constexpr std::size_t kShown = 5;
  for (std::size_t k = 0; k < std::min(kShown, parts.node_count.size()); ++k) {
    sizes += fmt::format("{}{} elements (with node {})", k == 0 ? "" : ", ", parts.element_count[k],
                         parts.first_node[k]);
  }
  if (parts.node_count.size() > kShown) sizes += ", ...";
  return Defect{
      ErrorKind::disconnected_mesh,
      fmt::format("the mesh is in {} parts that nothing joins: {}", parts.node_count.size(), sizes),
      "remove the loose parts, merge their nodes with the body's, or load them as bodies "
      "of their own"};
}

}  // namespace

int reorder_elements(Mesh& mesh) {
  int reordered = 0;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    if (!(signed_volume(corners_of(mesh, e)) < 0.0)) continue;
    auto& nodes = mesh.tetrahedra[static_cast<std::size_t>(e)];
    std::swap(nodes[2], nodes[3]);
    if (!mesh.quadratic.empty()) {
      const QuadraticTetrahedron before = mesh.quadratic[static_cast<std::size_t>(e)];
      QuadraticTetrahedron& after = mesh.quadratic[static_cast<std::size_t>(e)];
      std::copy(nodes.begin(), nodes.end(), after.begin());
      for (std::size_t k = 0; k < kEdges.size(); ++k) {
        after[4 + k] = middle_node(before, nodes[kEdges[k][0]], nodes[kEdges[k][1]]);
      }
    }
    ++reordered;
  }
  for (Hexahedron& nodes : mesh.hexahedra) {
    if (!(signed_volume(mesh, nodes) < 0.0)) continue;
    std::swap_ranges(nodes.begin(), nodes.begin() + 4, nodes.begin() + 4);
    ++reordered;
  }
  mesh.notes.reordered_elements += reordered;
  return reordered;
}

std::vector<Defect> find_defects(const Mesh& mesh, const CheckOptions& options) {
  std::vector<Defect> defects;
  const auto add = [&](MaybeDefect defect) {
    if (defect) defects.push_back(std::move(*defect));
    return !defects.empty();
  };
  if (add(no_elements(mesh)) || add(bad_indices(mesh)) || add(not_finite(mesh))) return defects;
  add(suspicious_size(mesh, options));
  add(repeated_node(mesh.tetrahedra, "tetrahedron"));
  add(repeated_node(mesh.hexahedra, "hexahedron"));
  add(duplicate_nodes(mesh));
  add(zero_volume(mesh, options.smallest_volume));
  add(inverted_hexahedron(mesh));
  add(overlap(mesh));
  add(non_conforming(mesh));
  add(several_components(mesh, options));
  return defects;
}

void check(Mesh& mesh, const CheckOptions& options) {
  if (!bad_indices(mesh)) reorder_elements(mesh);
  const std::vector<Defect> defects = find_defects(mesh, options);
  if (defects.empty()) return;
  throw Error(defects.front().kind, {.file = mesh.name}, defects.front().message,
              defects.front().remedy);
}

}  // namespace sinew::mesh
