#include "sinew/mesh/self_touch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Geometry>

#include "sinew/core/whole.hpp"
#include "sinew/mesh/distance.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

constexpr double kInside = 1e-9;  // minimum barycentric weight of a point inside

// The six tetrahedra around the diagonal 0-6 of a hexahedron (Kuhn's triangulation).
constexpr std::array<std::array<std::size_t, 4>, 6> kSplit{
    {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};

using Cell = std::array<std::int64_t, 3>;

constexpr std::int64_t kFarthestCell = std::int64_t{1} << 40;

std::uint64_t key_of(const Cell& cell) {
  constexpr std::uint64_t kBias = 1u << 20;
  std::uint64_t key = 0;
  for (const std::int64_t c : cell) {
    key = (key << 21) | ((static_cast<std::uint64_t>(c) + kBias) & 0x1fffff);
  }
  return key;
}

}  // namespace

SelfTouch::SelfTouch(const Mesh& mesh)
    : mesh_(mesh), elements_of_(static_cast<std::size_t>(mesh.node_count())) {
  int element = 0;
  const auto belongs = [&](NodeId node) {
    elements_of_[static_cast<std::size_t>(node)].push_back(element);
  };
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    parts_.push_back({tetrahedron, element});
    for (const NodeId node : tetrahedron) belongs(node);
    if (!mesh.quadratic.empty()) {
      const auto& all = mesh.quadratic[static_cast<std::size_t>(element)];
      std::for_each(all.begin() + 4, all.end(), belongs);
    }
    ++element;
  }
  for (const Hexahedron& hexahedron : mesh.hexahedra) {
    for (const auto& [a, b, c, d] : kSplit) {
      parts_.push_back({{hexahedron[a], hexahedron[b], hexahedron[c], hexahedron[d]}, element});
    }
    for (const NodeId node : hexahedron) belongs(node);
    ++element;
  }
  for (const Face& face : boundary_faces(mesh)) {
    surface_.insert(surface_.end(), face.nodes().begin(), face.nodes().end());
    if (face.is_quadratic()) {
      surface_.insert(surface_.end(), face.middle.begin(), face.middle.end());
    }
  }
  std::ranges::sort(surface_);
  surface_.erase(std::unique(surface_.begin(), surface_.end()), surface_.end());
}

std::optional<SelfTouch::Touch> SelfTouch::find(const Points& positions, double apart) const {
  // Surface nodes are sorted into cells of the mean element size; every element searches the cells
  // that it spans.
  double size = 0.0;
  for (const Part& part : parts_) {
    const Vector3 edge =
        (positions.row(part.corners[1]) - positions.row(part.corners[0])).transpose();
    size += edge.norm();
  }
  size = parts_.empty() ? 1.0 : size / static_cast<double>(parts_.size());
  if (!(size > 0.0) || !positions.allFinite()) return std::nullopt;
  const auto cell_of = [&](const Vector3& point) {
    const auto along = [&](double x) {
      return whole<std::int64_t>(std::floor(x / size), -kFarthestCell, kFarthestCell);
    };
    return Cell{along(point.x()), along(point.y()), along(point.z())};
  };
  std::unordered_map<std::uint64_t, std::vector<NodeId>> cells;
  for (const NodeId node : surface_) {
    cells[key_of(cell_of(positions.row(node).transpose()))].push_back(node);
  }
  Touch first;
  for (const Part& part : parts_) {
    std::array<Vector3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = positions.row(part.corners[k]).transpose();
    Vector3 low = corners[0], high = corners[0];
    for (const Vector3& corner : corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const Cell from = cell_of(low), to = cell_of(high);
    const double volume =
        (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0]));
    if (volume == 0.0) continue;
    for (std::int64_t x = from[0]; x <= to[0]; ++x) {
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {
        for (std::int64_t z = from[2]; z <= to[2]; ++z) {
          const auto found = cells.find(key_of({x, y, z}));
          if (found == cells.end()) continue;
          for (const NodeId node : found->second) {
            if (first.node >= 0 && node >= first.node) continue;
            const auto& own = elements_of_[static_cast<std::size_t>(node)];
            if (std::ranges::find(own, part.element) != own.end()) continue;
            const Vector3 away =
                (mesh_.nodes.row(node) - mesh_.nodes.row(part.corners[0])).transpose();
            if (away.norm() < apart) continue;
            const auto weights = barycentric_weights(positions.row(node).transpose(), corners);
            const bool inside = std::ranges::all_of(weights, [](double w) { return w > kInside; });
            if (inside) first = {node, part.element};
          }
        }
      }
    }
  }
  return first.node < 0 ? std::nullopt : std::optional(first);
}

}  // namespace sinew::mesh
