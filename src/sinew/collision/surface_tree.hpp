/// @file
/// A triangle surface in motion, and a tree of boxes over its triangles.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/collision/surface_topology.hpp"
#include "sinew/collision/triangle_intersection.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"

namespace sinew::collision {

/// An axis-aligned box, m.
struct Box {
  Vector3 low = Vector3::Constant(kInfinity), high = Vector3::Constant(-kInfinity);

  void extend(const Vector3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void extend(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  /// Whether the gap along some axis exceeds `distance`; rounding never creates a gap.
  bool is_apart(const Box& other, double distance) const {
    return ((low - other.high).array() > distance).any() ||
           ((other.low - high).array() > distance).any();
  }
  /// Half the area, m^2.
  double half_area() const {
    const Vector3 size = high - low;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

/// A surface with a tree of bounding boxes. Boxes are split along their longest axis into halves
/// with equally many triangles. A move refits them bottom-up. It rebuilds the tree if cost() has
/// grown by half, or fallen by a fifth, since the tree was built.
class SurfaceTree {
 public:
  /// A node of the tree. The children of an inner branch are the next one and `right`; a leaf has
  /// the triangles order()[begin, end).
  struct Branch {
    Box box;
    int right = -1;  ///< -1: a leaf
    int begin = 0, end = 0;
    double motion = 0.0;  ///< m, largest of its triangles
  };

  /// @param topology may be shared by all bodies of one kind.
  explicit SurfaceTree(std::shared_ptr<const SurfaceTopology> topology);

  /// Sets new positions and refits the boxes. @param positions (n, 3) m. @param pool shares the
  /// work. Throws Error: wrong-shape, not-finite, as does sweep().
  void move(const Points& positions, ThreadPool& pool);
  /// Sets a motion: every box encloses its triangle from start to end. @param start,end (n, 3) m.
  /// @param pool shares the work.
  void sweep(const Points& start, const Points& end, ThreadPool& pool);
  /// Sets how far each node may move before the next search. The next move() or sweep() discards
  /// it.
  /// @param motion (n,) m, >= 0. Throws Error(wrong-shape).
  void expect(const VectorX& motion);

  const SurfaceTopology& topology() const { return *topology_; }
  /// Positions of the last move(), or at the start of the last sweep(), (n, 3) m.
  const Points& positions() const { return start_; }
  /// The same, or those at the end of the last sweep(), (n, 3) m.
  const Points& end_positions() const { return swept_ ? end_ : start_; }

  Vector3 at(NodeId node) const { return start_.row(node).transpose(); }
  Vector3 at_end(NodeId node) const { return end_positions().row(node).transpose(); }
  Corners corners(int triangle) const {
    const Triangle& t = topology_->triangles()[static_cast<std::size_t>(triangle)];
    return {at(t[0]), at(t[1]), at(t[2])};
  }

  /// The branches, root first, each before its children.
  const std::vector<Branch>& branches() const { return branches_; }
  const std::vector<int>& order() const { return order_; }
  /// Box of a triangle, m.
  const Box& box(int triangle) const { return boxes_[static_cast<std::size_t>(triangle)]; }
  /// m: the largest motion that is expected of a triangle's nodes; 0 without expect().
  double motion(int triangle) const { return motion_[static_cast<std::size_t>(triangle)]; }
  /// Sum of the areas of all boxes over that of the root: the expected number of boxes that a
  /// random line through the root meets (surface area heuristic, Goldsmith & Salmon 1987).
  double cost() const { return cost_; }
  /// Number of times that the tree was built.
  int builds() const { return builds_; }

 private:
  void update(ThreadPool& pool);
  void forget_motion();
  void fit_triangles(ThreadPool& pool);
  void refit();
  void build();
  int split(int begin, int end);

  std::shared_ptr<const SurfaceTopology> topology_;
  Points start_, end_;
  bool swept_ = false, expects_ = false;
  std::vector<Box> boxes_;
  std::vector<double> motion_;  // (triangles,) m
  std::vector<int> order_;
  std::vector<Branch> branches_;
  double cost_ = 0.0, cost_when_built_ = 0.0;
  int builds_ = 0;
};

}  // namespace sinew::collision
