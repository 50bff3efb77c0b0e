/// @file
/// The volume that two closed surfaces have in common, and how it changes with their nodes.
#pragma once

#include <memory>
#include <vector>

#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/collision/triangle_pairs.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// V = integral of w_A w_B over space, w the winding numbers: the volume of the intersection of
/// two bodies A and B that do not overlap themselves. When a node moves, the surface around it
/// sweeps volume where the other body is (Reynolds' transport theorem):
///   dV/dx_i = integral over A's surface of w_B phi_i n dA,   phi_i the node's linear hat function,
/// likewise for B, and since V is homogeneous of degree 3 in all nodes, V = 1/3 sum x_i.dV/dx_i.
///
/// On each triangle the integrals of w_B times its three weights are integrals of linear functions
/// over the part inside B. By the divergence theorem they are sums over that part's border: pieces
/// of the triangle's edges and the segments in which it meets triangles of B, each with its
/// direction, in any order; nothing is joined to polygons.
///
/// Which edges pierce which triangles is decided by exact signs (orientation.hpp), so that borders
/// close. B is shifted by 1e-12 of the largest coordinate first, which parts all features that
/// touch; V is that of the shifted body, an error of at most that shift times the overlap's area.
class OverlapVolume {
 public:
  /// @param first,second closed. Throws Error(surface-not-closed). @param pool outlives this.
  OverlapVolume(std::shared_ptr<const SurfaceTopology> first,
                std::shared_ptr<const SurfaceTopology> second, ThreadPool& pool);

  /// Sets all that follows. @param first,second (n, 3) m, positions of each surface's nodes.
  void compute(const Points& first, const Points& second);

  /// m^3.
  double volume() const { return volume_; }
  /// (n, 3) m^2: derivative by the nodes of each surface.
  const Points& first_gradient() const { return sides_[0].gradient; }
  const Points& second_gradient() const { return sides_[1].gradient; }

 private:
  /// Integrals of a triangle's weights over a part of it, in its own coordinates.
  struct Part {
    int side, triangle;
    Vector3 moments;
  };
  struct Side {
    SurfaceTree tree;
    Points gradient;
    std::vector<int> winding;  // of the other surface, at each node
  };

  void wind(Side& side, const Side& other);
  void add_whole_edges(Side& side) const;
  void add(Side& side, int triangle, const Vector3& moments) const;

  ThreadPool& pool_;
  std::vector<Side> sides_;
  Points shifted_;
  TrianglePairs near_;
  ThreadLists<Part> parts_;
  double volume_ = 0.0;
};

}  // namespace sinew::collision
