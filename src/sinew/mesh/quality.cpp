#include "sinew/mesh/quality.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sinew/mesh/quadratic.hpp"

namespace sinew::mesh {

namespace {

double triangle_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

}  // namespace

Corners corners_of(const Mesh& mesh, int element) {
  const Tetrahedron& nodes = mesh.tetrahedra[static_cast<std::size_t>(element)];
  return {mesh.nodes.row(nodes[0]), mesh.nodes.row(nodes[1]), mesh.nodes.row(nodes[2]),
          mesh.nodes.row(nodes[3])};
}

double signed_volume(const Corners& x) {
  return (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])) / 6.0;
}

double longest_edge(const Corners& x) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) longest = std::max(longest, (x[i] - x[j]).norm());
  }
  return longest;
}

double mean_edge(const Mesh& mesh, double volume) {
  const auto tetrahedra =
      static_cast<double>(std::max(mesh.tetrahedra.size(), mesh.quadratic.size()));
  const double shares =
      tetrahedra / (6.0 * std::sqrt(2.0)) + static_cast<double>(mesh.hexahedra.size());
  return std::cbrt(volume / shares);
}

double element_size(const Mesh& mesh, int element) {
  const auto mean = [&](const auto& nodes, const auto& edges) {
    double sum = 0.0;
    for (const auto& [a, b] : edges) {
      sum += (mesh.nodes.row(nodes[a]) - mesh.nodes.row(nodes[b])).norm();
    }
    return sum / static_cast<double>(edges.size());
  };
  constexpr std::array<std::array<std::size_t, 2>, 12> kBoxEdges = {{{0, 1},
                                                                     {1, 2},
                                                                     {2, 3},
                                                                     {3, 0},
                                                                     {4, 5},
                                                                     {5, 6},
                                                                     {6, 7},
                                                                     {7, 4},
                                                                     {0, 4},
                                                                     {1, 5},
                                                                     {2, 6},
                                                                     {3, 7}}};
  const auto e = static_cast<std::size_t>(element);
  return e < mesh.tetrahedra.size() ? mean(mesh.tetrahedra[e], kEdges)
                                    : mean(mesh.hexahedra[e - mesh.tetrahedra.size()], kBoxEdges);
}

double radius_ratio(const Corners& x) {
  const double volume = std::abs(signed_volume(x));
  const double area = triangle_area(x[0], x[1], x[2]) + triangle_area(x[0], x[1], x[3]) +
                      triangle_area(x[0], x[2], x[3]) + triangle_area(x[1], x[2], x[3]);
  // r = 3 V / A;  R = sqrt((p+q+s)(p+q-s)(p-q+s)(-p+q+s)) / (24 V), p, q, s products of the
  // lengths of opposite edges.
  const double p = (x[1] - x[0]).norm() * (x[3] - x[2]).norm();
  const double q = (x[2] - x[0]).norm() * (x[3] - x[1]).norm();
  const double s = (x[3] - x[0]).norm() * (x[2] - x[1]).norm();
  const double product = (p + q + s) * (p + q - s) * (p - q + s) * (q + s - p);
  if (!(product > 0.0) || !(area > 0.0)) return 0.0;
  return std::min(1.0, 3.0 * (3.0 * volume / area) * (24.0 * volume) / std::sqrt(product));
}

std::array<double, 6> dihedral_angles(const Corners& x) {
  // Each edge (i, j) with the third corners (k, l) of its two faces.
  constexpr std::array<std::array<std::size_t, 4>, 6> kHinges = {
      {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};
  std::array<double, 6> angles;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j, k, l] = kHinges[e];
    const Vector3 edge = x[j] - x[i];
    const Vector3 a = edge.cross(x[k] - x[i]);
    const Vector3 b = edge.cross(x[l] - x[i]);
    angles[e] = std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return angles;
}

double signed_volume(const Mesh& mesh, const Hexahedron& h) {
  // The ring of corners around the diagonal 0-6.
  constexpr std::array<std::size_t, 7> kRing = {1, 2, 3, 7, 4, 5, 1};
  double sum = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    sum += signed_volume(Corners{mesh.nodes.row(h[0]), mesh.nodes.row(h[kRing[k]]),
                                 mesh.nodes.row(h[kRing[k + 1]]), mesh.nodes.row(h[6])});
  }
  return sum;
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    sum += signed_volume(corners_of(mesh, e));
  }
  for (const Hexahedron& hexahedron : mesh.hexahedra) sum += signed_volume(mesh, hexahedron);
  return sum;
}

}  // namespace sinew::mesh
