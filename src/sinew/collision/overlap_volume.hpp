/// @file
/// The volume of the overlap of two closed surfaces, and its derivative by their nodes.
#pragma once

#include <memory>
#include <vector>

#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/collision/triangle_pairs.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// The overlap volume V = integral of w_A w_B over space, w the winding numbers: the volume of the
/// intersection of two bodies A and B that do not overlap themselves. When a node moves, the
/// surface around it sweeps volume of the other body (Reynolds' transport theorem):
///   dV/dx_i = integral over A's surface of w_B phi_i n dA,   phi_i the node's linear hat function,
/// likewise for B. Since V is homogeneous of degree 3 in all nodes, V = 1/3 sum x_i.dV/dx_i.
///
/// On each triangle the integrals of w_B times its three weights are integrals of linear functions
/// over the part inside B. By the divergence theorem they are sums over the border of that part:
/// pieces of the triangle's edges, and the directed segments in which it meets triangles of B, in
/// any order. No polygons need be assembled.
///
/// Exact signs (orientation.hpp) decide which edges pierce which triangles, so that borders close.
/// B is first shifted by 1e-12 of the largest coordinate, which separates all features that touch.
/// V is that of the shifted body, an error of at most that shift times the area of the overlap.
class OverlapVolume {
 public:
  /// @param first,second closed. @param pool must outlive this object. Throws Error:
  ///   surface-not-closed.
  OverlapVolume(std::shared_ptr<const SurfaceTopology> first,
                std::shared_ptr<const SurfaceTopology> second, ThreadPool& pool);

  /// Computes volume and gradients. @param first,second (n, 3) m, positions of each surface's
  /// nodes.
  void compute(const Points& first, const Points& second);

  /// The volume, m^3.
  double volume() const { return volume_; }
  /// Derivative by the nodes of each surface, (n, 3) m^2.
  const Points& first_gradient() const { return sides_[0].gradient; }
  const Points& second_gradient() const { return sides_[1].gradient; }

 private:
  /// Integrals of a triangle's weights over part of it, in its own coordinates.
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
