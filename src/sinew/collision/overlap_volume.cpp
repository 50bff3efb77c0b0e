#include "sinew/collision/overlap_volume.hpp"

#include <utility>

#include <Eigen/Geometry>

#include "sinew/collision/penetration.hpp"
#include "sinew/collision/point_query.hpp"
#include "sinew/collision/triangle_cut.hpp"

namespace sinew::collision {

namespace {

constexpr int kWindingGrain = 32;
constexpr int kCutGrain = 32;
/// Shift of the second surface, relative to the coordinates: above their rounding, below any
/// relevant length.
constexpr double kShift = 1e-12;
/// Its direction, which no line or plane of a mesh is likely to have.
const Vector3 kAside(0.7548776662466927, 0.5698402909980532, 0.3287651092867413);

// Integrals of 1 - u - v, u and v over the signed triangle (0, 0), p, q: the contribution of the
// piece of border from p to q.
Vector3 below(const Place2& p, const Place2& q) {
  const double area = 0.5 * (p[0] * q[1] - p[1] * q[0]);
  const Place2 mean = (p + q) / 3.0;
  return area * Vector3(1.0 - mean.sum(), mean[0], mean[1]);
}

Vector3 of_cut(const CutSide& side) {
  Vector3 along_cut = below(side.from, side.to);
  if (side.pass.sign == 0) return along_cut;
  return along_cut + side.pass.sign * below(side.pass.place, {0.0, 1.0});
}

SurfaceTriangle triangle_of(const SurfaceTree& tree, int number) {
  return {tree.corners(number), tree.topology().triangles()[static_cast<std::size_t>(number)]};
}

}  // namespace

OverlapVolume::OverlapVolume(std::shared_ptr<const SurfaceTopology> first,
                             std::shared_ptr<const SurfaceTopology> second, ThreadPool& pool)
    : pool_(pool), near_(pool), parts_(pool) {
  require_closed(*first, "first");
  require_closed(*second, "second");
  for (auto& topology : {std::move(first), std::move(second)}) {
    const auto nodes = static_cast<std::size_t>(topology->node_count());
    sides_.push_back({SurfaceTree(topology), Points::Zero(topology->node_count(), 3),
                      std::vector<int>(nodes, 0)});
  }
}

void OverlapVolume::compute(const Points& first, const Points& second) {
  sides_[0].tree.move(first, pool_);
  const Box& box = sides_[0].tree.branches().front().box;
  shifted_ = second;
  const double size = box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).maxCoeff();
  shifted_.rowwise() += (kShift * size * kAside).transpose();
  sides_[1].tree.move(shifted_, pool_);
  const auto near = near_.between(sides_[0].tree, sides_[1].tree, 0.0);
  const auto parts = parts_.collect(
      static_cast<int>(near.size()), kCutGrain, [&](int begin, int end, std::vector<Part>& found) {
        for (int k = begin; k < end; ++k) {
          const TrianglePair& pair = near[static_cast<std::size_t>(k)];
          const auto own = cut(triangle_of(sides_[0].tree, pair.first),
                               triangle_of(sides_[1].tree, pair.second));
          if (!own) continue;
          found.push_back({0, pair.first, of_cut(own->sides[0])});
          found.push_back({1, pair.second, of_cut(own->sides[1])});
        }
      });
  for (std::size_t s = 0; s < 2; ++s) {
    wind(sides_[s], sides_[1 - s]);
    sides_[s].gradient.setZero();
    add_whole_edges(sides_[s]);
  }
  for (const Part& part : parts) {
    add(sides_[static_cast<std::size_t>(part.side)], part.triangle, part.moments);
  }
  // Relative to a nearby point, so that large coordinates lose no digits.
  const Eigen::RowVector3d middle = 0.5 * (box.low + box.high).transpose();
  volume_ = 0.0;
  for (const Side& side : sides_) {
    const Points& x = side.tree.positions();
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      volume_ += side.gradient.row(i).dot(x.row(i) - middle) / 3.0;
    }
  }
}

void OverlapVolume::wind(Side& side, const Side& other) {
  const Box& whole = other.tree.branches().front().box;
  pool_.for_range(side.tree.topology().node_count(), kWindingGrain, [&](int begin, int end, int) {
    for (NodeId node = begin; node < end; ++node) {
      const Vector3 x = side.tree.at(node);
      Box point;
      point.extend(x);
      side.winding[static_cast<std::size_t>(node)] =
          point.is_apart(whole, 0.0) ? 0 : winding_number(other.tree, x);
    }
  });
}

// Adds the edge from corner 1 to corner 2, weighted by the winding number of the other surface at
// its start; of_cut() corrects the rest of it where it passes that surface. The other edges go
// through (0, 0) and contribute nothing.
void OverlapVolume::add_whole_edges(Side& side) const {
  const auto& triangles = side.tree.topology().triangles();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int winding = side.winding[static_cast<std::size_t>(triangles[t][1])];
    if (winding != 0) add(side, static_cast<int>(t), winding * below({1.0, 0.0}, {0.0, 1.0}));
  }
}

void OverlapVolume::add(Side& side, int triangle, const Vector3& moments) const {
  const Corners x = side.tree.corners(triangle);
  const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  if (!(normal.squaredNorm() > 0.0)) return;
  const Triangle& nodes = side.tree.topology().triangles()[static_cast<std::size_t>(triangle)];
  for (std::size_t k = 0; k < 3; ++k) {
    side.gradient.row(nodes[k]) += moments[static_cast<Eigen::Index>(k)] * normal.transpose();
  }
}

}  // namespace sinew::collision
