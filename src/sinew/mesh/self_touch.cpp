#include "sinew/mesh/self_touch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <unordered_map>

#include <Eigen/Geometry>

#include "sinew/core/whole.hpp"
#include "sinew/mesh/distance.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

using Box = Eigen::AlignedBox3d;
using GridCell = std::array<std::int64_t, 3>;

/// Minimum barycentric coordinate of a point inside; half the minimum distance of a local
/// coordinate of a hexahedron from -1 and 1.
constexpr double kInside = 1e-9;

constexpr std::int64_t kFarthestCell = std::int64_t{1} << 40;

std::uint64_t key_of(const GridCell& cell) {
  constexpr std::uint64_t kBias = 1u << 20;
  std::uint64_t key = 0;
  for (const std::int64_t c : cell) {
    key = (key << 21) | ((static_cast<std::uint64_t>(c) + kBias) & 0x1fffff);
  }
  return key;
}

bool all_inside(const std::array<double, 4>& barycentric) {
  return std::ranges::all_of(barycentric, [](double weight) { return weight > kInside; });
}

/// Signed solid angle of a triangle seen from the origin, positive for corners counter-clockwise
/// seen from beyond it (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983).
double solid_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Whether a point is inside the sixteen flat triangles of a quadratic tetrahedron.
bool inside_facets(const QuadraticTetrahedron& element, const Points& positions,
                   const Vector3& point) {
  double angle = 0.0;
  for (const Triangle& corners :
       faces_of(Tetrahedron{element[0], element[1], element[2], element[3]})) {
    Face face;
    for (std::size_t k = 0; k < 3; ++k) {
      face.node[k] = corners[k];
      face.middle[k] = middle_node(element, corners[k], corners[(k + 1) % 3]);
    }
    for (const auto& [a, b, c] : quarters(face)) {
      angle +=
          solid_angle(positions.row(a).transpose() - point, positions.row(b).transpose() - point,
                      positions.row(c).transpose() - point);
    }
  }
  return angle > 2.0 * std::numbers::pi;
}

/// A box that contains the element. A quadratic one lies in the hull of its Bezier points: the
/// corners, and 2 m - (a + b)/2 for each edge (a, b) with the middle m (Farin, "Curves and Surfaces
/// for CAGD", 5th ed., 2002, sections 4.3 and 17.3).
Box curved_bounds(std::span<const NodeId> nodes, const Points& positions) {
  const auto at = [&](std::size_t k) -> Vector3 { return positions.row(nodes[k]).transpose(); };
  Box box;
  const std::size_t corners = nodes.size() == 10 ? 4 : nodes.size();
  for (std::size_t k = 0; k < corners; ++k) box.extend(at(k));
  for (std::size_t e = 0; nodes.size() == 10 && e < kEdges.size(); ++e) {
    box.extend(2.0 * at(4 + e) - 0.5 * (at(kEdges[e][0]) + at(kEdges[e][1])));
  }
  return box;
}

}  // namespace

SelfTouch::SelfTouch(const Mesh& mesh)
    : mesh_(mesh), elements_of_(static_cast<std::size_t>(mesh.node_count())) {
  const auto add = [&](const auto& nodes) {
    Element element;
    element.size = nodes.size();
    std::ranges::copy(nodes, element.node.begin());
    for (const NodeId node : nodes) {
      elements_of_[static_cast<std::size_t>(node)].push_back(static_cast<int>(elements_.size()));
    }
    elements_.push_back(element);
  };
  if (mesh.quadratic.empty()) {
    for (const Tetrahedron& tetrahedron : mesh.tetrahedra) add(tetrahedron);
  } else {
    for (const QuadraticTetrahedron& tetrahedron : mesh.quadratic) add(tetrahedron);
  }
  for (const Hexahedron& hexahedron : mesh.hexahedra) add(hexahedron);
  surface_ = outer_nodes(mesh);
}

bool SelfTouch::contains(const Element& element, const Points& positions,
                         const Vector3& point) const {
  const auto rows = [&](auto& nodes) {
    for (Eigen::Index a = 0; a < nodes.rows(); ++a) {
      nodes.row(a) = positions.row(element.node[static_cast<std::size_t>(a)]);
    }
  };
  if (element.size == 4) {
    Corners corners;
    for (std::size_t a = 0; a < 4; ++a) corners[a] = positions.row(element.node[a]).transpose();
    const bool flat =
        (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0])) ==
        0.0;
    return !flat && all_inside(barycentric_weights(point, corners));
  }
  if (element.size == 8) {
    Eigen::Matrix<double, 8, 3> nodes;
    rows(nodes);
    const auto local = hexahedron_coordinates(point, nodes);
    return local && local->cwiseAbs().maxCoeff() < 1.0 - 2.0 * kInside;
  }
  Eigen::Matrix<double, 10, 3> nodes;
  rows(nodes);
  const auto barycentric = quadratic_coordinates(point, nodes);
  return barycentric && all_inside(*barycentric) && inside_facets(element.node, positions, point);
}

std::optional<SelfTouch::Touch> SelfTouch::find(const Points& positions, double apart) const {
  // Surface nodes are sorted into cells of the mean element size; every element searches the cells
  // that it spans.
  double size = 0.0;
  for (const Element& element : elements_) {
    size += (positions.row(element.node[1]) - positions.row(element.node[0])).norm();
  }
  size = elements_.empty() ? 1.0 : size / static_cast<double>(elements_.size());
  if (!(size > 0.0) || !positions.allFinite()) return std::nullopt;
  const auto cell_of = [&](const Vector3& point) {
    const auto along = [&](double x) {
      return whole<std::int64_t>(std::floor(x / size), -kFarthestCell, kFarthestCell);
    };
    return GridCell{along(point.x()), along(point.y()), along(point.z())};
  };
  std::unordered_map<std::uint64_t, std::vector<NodeId>> cells;
  for (const NodeId node : surface_) {
    cells[key_of(cell_of(positions.row(node).transpose()))].push_back(node);
  }
  Touch first;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Element& element = elements_[e];
    const Box box = curved_bounds({element.node.data(), element.size}, positions);
    const auto meets = [&](NodeId node) {
      if (first.node >= 0 && node >= first.node) return false;
      const Vector3 point = positions.row(node).transpose();
      if (!box.contains(point)) return false;
      const auto& own = elements_of_[static_cast<std::size_t>(node)];
      if (std::ranges::find(own, static_cast<int>(e)) != own.end()) return false;
      const double away = (mesh_.nodes.row(node) - mesh_.nodes.row(element.node[0])).norm();
      return away >= apart && contains(element, positions, point);
    };
    const GridCell from = cell_of(box.min()), to = cell_of(box.max());
    for (std::int64_t x = from[0]; x <= to[0]; ++x) {
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {
        for (std::int64_t z = from[2]; z <= to[2]; ++z) {
          const auto found = cells.find(key_of({x, y, z}));
          if (found == cells.end()) continue;
          for (const NodeId node : found->second) {
            if (meets(node)) first = {node, static_cast<int>(e)};
          }
        }
      }
    }
  }
  return first.node < 0 ? std::nullopt : std::optional(first);
}

}  // namespace sinew::mesh
