/// @file
/// Pairs of triangles whose bounding boxes are near each other.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/collision/normal_cones.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// Numbers of two triangles.
struct TrianglePair {
  int first, second;
  bool operator==(const TrianglePair&) const = default;
};

/// Finds pairs of triangles; keeps the memory of the largest call. The order of the pairs depends
/// on the trees only, not on the number of threads.
class TrianglePairs {
 public:
  /// @param pool must outlive this object.
  explicit TrianglePairs(ThreadPool& pool);

  /// All pairs whose boxes are at most `distance` apart along every axis, or at most as far as both
  /// triangles together are expected to move (SurfaceTree::expect()).
  /// @param first,second may be swept. @param distance m, >= 0.
  std::span<const TrianglePair> between(const SurfaceTree& first, const SurfaceTree& second,
                                        double distance);
  /// The same within one surface: each pair of two triangles once, including neighbours.
  /// @param surface may be swept. @param distance m, >= 0. @param cones of the surface at its last
  ///   positions; pairs that they exclude are left out. None: all pairs.
  std::span<const TrianglePair> within(const SurfaceTree& surface, double distance,
                                       const NormalCones* cones = nullptr);

 private:
  struct BranchPair {
    int first, second;
  };
  struct Search {
    const SurfaceTree& first;
    const SurfaceTree& second;
    double distance;
    bool same;
    const NormalCones* cones;  // none: excludes nothing
  };
  std::span<const TrianglePair> find(const Search& search);
  static bool is_leaf(const Search& search, const BranchPair& pair);
  template <typename Keep>
  static void descend(const Search& search, const BranchPair& pair, const Keep& keep);
  static void compare(const Search& search, const BranchPair& leaf, std::vector<TrianglePair>& to);

  void spread(const Search& search);

  std::vector<BranchPair> front_, next_;
  ThreadLists<TrianglePair> pairs_;
};

}  // namespace sinew::collision
