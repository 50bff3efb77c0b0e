#include "sinew/mechanics/surface_trace.hpp"

#include <algorithm>

namespace sinew::mechanics {

SurfaceTrace::SurfaceTrace(std::span<const mesh::Face> faces, int node_count) {
  std::vector<int> owners, entries;
  for (const mesh::Face& face : faces) {
    if (face.corners() != 4) continue;
    for (const NodeId node : face.node) {
      owners.push_back(node);
      entries.push_back(static_cast<int>(faces_.size()));
    }
    faces_.push_back(face.node);
  }
  if (!faces_.empty()) faces_of_node_ = collision::NumberLists(node_count, owners, entries);
}

Patch SurfaceTrace::at(const collision::SurfacePoint& place) const {
  if (place.nodes[1] >= 0 && !faces_.empty()) {
    for (const int number : faces_of_node_[place.nodes[0]]) {
      const Quadrilateral& face = faces_[static_cast<std::size_t>(number)];
      const bool within = std::ranges::all_of(place.nodes, [&](NodeId node) {
        return node < 0 || std::ranges::find(face, node) != face.end();
      });
      if (within) return on(face, place);
    }
  }
  Patch patch;
  std::ranges::copy(place.nodes, patch.nodes.begin());
  std::copy_n(place.weights.data(), 3, patch.weights.begin());
  return patch;
}

// Bilinear weights in the unit square. On an edge of the face, the other two corners are left out.
Patch SurfaceTrace::on(const Quadrilateral& face, const collision::SurfacePoint& place) {
  double s = 0.0, t = 0.0;
  for (std::size_t k = 0; k < 3 && place.nodes[k] >= 0; ++k) {
    const double weight = place.weights[static_cast<Eigen::Index>(k)];
    const auto corner = std::ranges::find(face, place.nodes[k]) - face.begin();
    if (corner == 1 || corner == 2) s += weight;
    if (corner >= 2) t += weight;
  }
  const double weights[] = {(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t};
  Patch patch;
  std::size_t used = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    if (weights[k] == 0.0) continue;
    patch.nodes[used] = face[k];
    patch.weights[used++] = weights[k];
  }
  return patch;
}

}  // namespace sinew::mechanics
