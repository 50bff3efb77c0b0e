/// @file
/// Cones of normals, which tell that parts of a smooth surface cannot touch each other.
#pragma once

#include <vector>

#include "sinew/collision/surface_tree.hpp"
#include "sinew/core/types.hpp"

namespace sinew {
class ThreadPool;
}

namespace sinew::collision {

/// For each triangle of a closed surface, a cone that contains its normal and the normals of all
/// triangles with which it shares a node; for each branch of the surface's tree, a cone that
/// contains those of its triangles. Where a body touches itself, its surfaces face each other;
/// where the normals in two cones differ by less than 90 degrees, none of their features do.
/// Testing normals before distances follows P. Volino and N. Magnenat-Thalmann, Efficient
/// self-collision detection on smoothly discretized surface animations using geometrical shape
/// regularity, Computer Graphics Forum 13 (1994) 155-166.
class NormalCones {
 public:
  /// Computes the cones. Allocates nothing if the surface has as many triangles as the last one.
  /// @param surface at its last moved positions. @param pool shares the work.
  void update(const SurfaceTree& surface, ThreadPool& pool);
  /// Whether no feature of one triangle can face a feature of the other. Always false on an open
  /// surface. @param first,second numbers of triangles.
  bool are_averse(int first, int second) const { return are_averse(cones_, first, second); }
  /// The same for all triangles of two branches. @param first,second numbers of branches of the
  /// tree, which may be equal.
  bool branches_are_averse(int first, int second) const {
    return are_averse(branches_, first, second);
  }

 private:
  struct Cone {
    Vector3 axis = Vector3::UnitZ();
    double cosine = -1.0, sine = 1.0;  // of the half angle; these: excludes nothing
    bool has_ridge = true;             // whether a triangle's own cone is wide
  };
  static constexpr double kRounding = 1e-9;

  static bool are_averse(const std::vector<Cone>& cones, int first, int second) {
    if (cones.empty()) return false;
    const Cone& a = cones[static_cast<std::size_t>(first)];
    const Cone& b = cones[static_cast<std::size_t>(second)];
    if (a.has_ridge && b.has_ridge) return false;
    // angle(axes) + angle(a) + angle(b) < 90 degrees, if the sum of the last two is below 90.
    if (!(a.cosine * b.cosine > a.sine * b.sine)) return false;
    return a.axis.dot(b.axis) > a.sine * b.cosine + a.cosine * b.sine + kRounding;
  }
  Cone cone_of(const SurfaceTopology& topology, int triangle) const;
  static Cone merged(const Cone& a, const Cone& b);
  void join(const SurfaceTree& surface);

  std::vector<Vector3> normals_;  // (triangles,) unit length; 0: degenerate
  std::vector<Cone> cones_;       // (triangles,); empty for an open surface
  std::vector<Cone> branches_;    // (branches of the tree,); empty for an open surface
};

}  // namespace sinew::collision
