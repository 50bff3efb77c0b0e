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
  /// Whether some axis shows a gap of more than `distance`; rounding never makes one.
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

/// Boxes are split in halves of equally many triangles along their longest axis. A move refits
/// them bottom up. It builds the tree anew when cost() has grown by half, or fallen by a fifth,
/// since it was built.
class SurfaceTree {
 public:
  /// Children of an inner branch are the next one and `right`; a leaf has the triangles
  /// order()[begin, end).
  struct Branch {
    Box box;
    int right = -1;  ///< -1: a leaf
    int begin = 0, end = 0;
  };

  /// @param topology shared by all bodies of its kind.
  explicit SurfaceTree(std::shared_ptr<const SurfaceTopology> topology);

  /// Takes new positions and refits the boxes. @param positions (n, 3) m. Throws
  /// Error(wrong-shape, not-finite), as does sweep(). @param pool shares the work.
  void move(const Points& positions, ThreadPool& pool);
  /// Takes a motion: every box holds its triangle from start to end. @param start,end (n, 3) m.
  /// @param pool shares the work.
  void sweep(const Points& start, const Points& end, ThreadPool& pool);

  const SurfaceTopology& topology() const { return *topology_; }
  /// (n, 3) m: of the last move(), or the start of the last sweep().
  const Points& positions() const { return start_; }
  /// (n, 3) m: the same, or the end of the last sweep().
  const Points& end_positions() const { return swept_ ? end_ : start_; }

  Vector3 at(NodeId node) const { return start_.row(node).transpose(); }
  Vector3 at_end(NodeId node) const { return end_positions().row(node).transpose(); }
  Corners corners(int triangle) const {
    const Triangle& t = topology_->triangles()[static_cast<std::size_t>(triangle)];
    return {at(t[0]), at(t[1]), at(t[2])};
  }

  /// The first one is the root; each stands before its children.
  const std::vector<Branch>& branches() const { return branches_; }
  const std::vector<int>& order() const { return order_; }
  /// Box of a triangle, m.
  const Box& box(int triangle) const { return boxes_[static_cast<std::size_t>(triangle)]; }
  /// Sum of the areas of all boxes over that of the root's: how many of them a random line
  /// through the root meets (the surface area heuristic, Goldsmith & Salmon 1987).
  double cost() const { return cost_; }
  /// How often the tree was built.
  int builds() const { return builds_; }

 private:
  void update(ThreadPool& pool);
  void fit_triangles(ThreadPool& pool);
  void refit();
  void build();
  int split(int begin, int end);

  std::shared_ptr<const SurfaceTopology> topology_;
  Points start_, end_;
  bool swept_ = false;
  std::vector<Box> boxes_;
  std::vector<int> order_;
  std::vector<Branch> branches_;
  double cost_ = 0.0, cost_when_built_ = 0.0;
  int builds_ = 0;
};

}  // namespace sinew::collision
