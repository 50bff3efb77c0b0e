#include "sinew/mesh/duplicates.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Geometry>

#include "sinew/core/whole.hpp"

namespace sinew::mesh {

namespace {

using Cell = std::array<std::int64_t, 3>;

constexpr std::int64_t kLastCell = std::int64_t{1} << 62;  // leaves room for its neighbours

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (const std::int64_t k : cell) {
      hash ^= static_cast<std::uint64_t>(k) + 0x9e3779b97f4a7c15u + (hash << 6) + (hash >> 2);
      hash *= 0xff51afd7ed558ccdu;
      hash ^= hash >> 33;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace

std::vector<NodeId> weld_map(const Points& points, const std::vector<char>& considered,
                             double relative_tolerance) {
  const auto count = static_cast<std::size_t>(points.rows());
  const auto takes_part = [&](std::size_t i) { return considered.empty() || considered[i] != 0; };
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < count; ++i) {
    if (takes_part(i)) box.extend(Vector3(points.row(static_cast<NodeId>(i))));
  }
  const double diagonal = box.isEmpty() ? 0.0 : box.diagonal().norm();
  // A tolerance of zero would divide by zero below.
  const double tolerance = std::max(relative_tolerance * diagonal, 1e-300);
  std::unordered_map<Cell, std::vector<NodeId>, CellHash> cells;
  std::vector<NodeId> lowest(count);

  for (std::size_t i = 0; i < count; ++i) {
    const auto node = static_cast<NodeId>(i);
    lowest[i] = node;
    if (!takes_part(i)) continue;
    const Vector3 x = points.row(node);
    Cell home;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      home[a] =
          whole<std::int64_t>(std::floor((x[axis] - box.min()[axis]) / tolerance), 0, kLastCell);
    }
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const Cell cell{home[0] + neighbour % 3 - 1, home[1] + neighbour / 3 % 3 - 1,
                      home[2] + neighbour / 9 - 1};
      const auto found = cells.find(cell);
      if (found == cells.end()) continue;
      for (const NodeId other : found->second) {
        const bool near = (x - Vector3(points.row(other))).norm() <= tolerance;
        if (near && other < lowest[i]) lowest[i] = other;
      }
    }
    if (lowest[i] == node) cells[home].push_back(node);
  }
  return lowest;
}

std::vector<std::pair<NodeId, NodeId>> find_duplicate_nodes(const Points& points,
                                                            const std::vector<char>& considered,
                                                            double relative_tolerance) {
  const std::vector<NodeId> lowest = weld_map(points, considered, relative_tolerance);
  std::vector<std::pair<NodeId, NodeId>> pairs;
  for (std::size_t i = 0; i < lowest.size(); ++i) {
    if (lowest[i] != static_cast<NodeId>(i)) pairs.emplace_back(lowest[i], static_cast<NodeId>(i));
  }
  return pairs;
}

}  // namespace sinew::mesh
