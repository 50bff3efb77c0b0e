#include "sinew/collision/surface_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::collision {

namespace {

constexpr int kLeafSize = 4;
constexpr int kTriangleGrain = 256;
/// Range of relative changes of cost() within which a tree is kept. A tree that was built on a
/// crumpled surface is no good for the smooth one, though its cost falls there.
constexpr double kGrown = 1.5, kFallen = 0.8;

void check_positions(const Points& positions, int nodes) {
  if (positions.rows() != nodes) {
    throw Error(ErrorKind::wrong_shape, {.item = "positions"},
                fmt::format("there are {} rows for {} nodes", positions.rows(), nodes));
  }
  if (!positions.allFinite()) {
    throw Error(ErrorKind::not_finite, {.item = "positions"}, "a position is not finite");
  }
}

}  // namespace

SurfaceTree::SurfaceTree(std::shared_ptr<const SurfaceTopology> topology)
    : topology_(std::move(topology)),
      boxes_(topology_->triangles().size()),
      motion_(boxes_.size(), 0.0),
      order_(topology_->triangles().size()) {
  branches_.reserve(2 * order_.size());
}

void SurfaceTree::move(const Points& positions, ThreadPool& pool) {
  check_positions(positions, topology_->node_count());
  start_ = positions;
  swept_ = false;
  update(pool);
}

void SurfaceTree::sweep(const Points& start, const Points& end, ThreadPool& pool) {
  check_positions(start, topology_->node_count());
  check_positions(end, topology_->node_count());
  start_ = start;
  end_ = end;
  swept_ = true;
  update(pool);
}

void SurfaceTree::expect(const VectorX& motion) {
  if (motion.size() != topology_->node_count()) {
    throw Error(
        ErrorKind::wrong_shape, {.item = "motion"},
        fmt::format("there are {} entries for {} nodes", motion.size(), topology_->node_count()));
  }
  for (std::size_t t = 0; t < motion_.size(); ++t) {
    const Triangle& nodes = topology_->triangles()[t];
    motion_[t] = std::max({motion[nodes[0]], motion[nodes[1]], motion[nodes[2]]});
  }
  for (std::size_t k = branches_.size(); k-- > 0;) {
    Branch& branch = branches_[k];
    branch.motion = 0.0;
    if (branch.right < 0) {
      for (int i = branch.begin; i < branch.end; ++i) {
        branch.motion = std::max(branch.motion, this->motion(order_[static_cast<std::size_t>(i)]));
      }
    } else {
      branch.motion = std::max(branches_[k + 1].motion,
                               branches_[static_cast<std::size_t>(branch.right)].motion);
    }
  }
  expects_ = true;
}

void SurfaceTree::forget_motion() {
  if (!expects_) return;
  std::ranges::fill(motion_, 0.0);
  for (Branch& branch : branches_) branch.motion = 0.0;
  expects_ = false;
}

void SurfaceTree::update(ThreadPool& pool) {
  forget_motion();
  fit_triangles(pool);
  if (!branches_.empty()) refit();
  const bool is_kept = cost_ <= kGrown * cost_when_built_ && cost_ >= kFallen * cost_when_built_;
  if (branches_.empty() || !is_kept) build();
}

void SurfaceTree::fit_triangles(ThreadPool& pool) {
  pool.for_range(static_cast<int>(boxes_.size()), kTriangleGrain, [&](int begin, int end, int) {
    for (int t = begin; t < end; ++t) {
      Box box;
      for (const NodeId node : topology_->triangles()[static_cast<std::size_t>(t)]) {
        box.extend(at(node));
        if (swept_) box.extend(at_end(node));
      }
      boxes_[static_cast<std::size_t>(t)] = box;
    }
  });
}

void SurfaceTree::refit() {
  double areas = 0.0;
  for (std::size_t k = branches_.size(); k-- > 0;) {
    Branch& branch = branches_[k];
    branch.box = Box();
    if (branch.right < 0) {
      for (int i = branch.begin; i < branch.end; ++i) {
        branch.box.extend(box(order_[static_cast<std::size_t>(i)]));
      }
    } else {
      branch.box.extend(branches_[k + 1].box);
      branch.box.extend(branches_[static_cast<std::size_t>(branch.right)].box);
    }
    areas += branch.box.half_area();
  }
  const double whole = branches_.front().box.half_area();
  cost_ = whole > 0.0 ? areas / whole : 1.0;
}

void SurfaceTree::build() {
  std::iota(order_.begin(), order_.end(), 0);
  branches_.clear();
  split(0, static_cast<int>(order_.size()));
  refit();
  cost_when_built_ = cost_;
  ++builds_;
}

int SurfaceTree::split(int begin, int end) {
  const auto number = branches_.size();
  branches_.push_back({.box = {}, .right = -1, .begin = begin, .end = end});
  if (end - begin <= kLeafSize) return static_cast<int>(number);
  Box centres;  // doubled
  const auto centre = [&](int triangle) -> Vector3 {
    return box(triangle).low + box(triangle).high;
  };
  for (int i = begin; i < end; ++i) centres.extend(centre(order_[static_cast<std::size_t>(i)]));
  Eigen::Index axis = 0;
  (centres.high - centres.low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(
      order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
      [&](int a, int b) { return std::pair(centre(a)[axis], a) < std::pair(centre(b)[axis], b); });
  split(begin, middle);
  branches_[number].right = split(middle, end);
  return static_cast<int>(number);
}

}  // namespace sinew::collision
