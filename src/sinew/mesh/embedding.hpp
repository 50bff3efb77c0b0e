/// @file
/// Embedding of points in a mesh of tetrahedra and hexahedra.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// A point outside of the mesh that is nearer than this fraction of its size (the diagonal of the
/// bounding box) counts as on its surface. Files round coordinates: single precision by 2^-24 =
/// 6e-8 of their value, six decimal digits ("%g", as Gmsh writes STL) by up to 5e-6, which moves a
/// point by sqrt(3) 5e-6 = 8.7e-6 of the largest coordinate.
constexpr double kOnSurface = 1e-5;

/// What to do with a point that is neither in an element nor on the surface (kOnSurface).
enum class Outside {
  error,  ///< throw Error(point-outside-mesh) with the point, its distance and the nearest
  ///< element
  /// extrapolate linearly from the nearest point of the nearest element; some weights are negative
  nearest,
};

/// An embedded point x = sum_k weights[k] x(nodes[k]); the weights sum to 1.
struct EmbeddedPoint {
  std::vector<NodeId> nodes;    ///< nodes of the element, its corners, or four of a hexahedron
  std::vector<double> weights;  ///< one per node
  int element = -1;             ///< element of the point: tetrahedra, then hexahedra
  double distance = 0.0;        ///< m, from the nearest element; 0 inside and on the surface
};

/// Finds the element that contains a point by a bounding-volume tree, in O(log n) per query. On a
/// common face, the lowest element number is taken, so that results do not depend on the tree.
/// Hexahedra are searched as six tetrahedra around the diagonal 0-6, and points inside get
/// trilinear weights. Quadratic tetrahedra are searched by their corners, and points get quadratic
/// weights.
class Embedder {
 public:
  /// Throws Error(no-volume-elements). @param mesh need not outlive this.
  explicit Embedder(const Mesh& mesh);
  ~Embedder();
  Embedder(Embedder&&) noexcept;
  Embedder& operator=(Embedder&&) noexcept;

  /// Finds the element and the weights of a point. Throws Error: not-finite, point-outside-mesh.
  /// @param point,outside (3,) m in the rest frame of the mesh, and what to do if it is outside.
  /// @param what name of the point in the message, such as "via point 3 of cable long_0".
  EmbeddedPoint locate(const Vector3& point, Outside outside, const std::string& what) const;

  /// The mean of the part of a ball inside the mesh, with weights that vary linearly over the ball
  /// so that the mean is at its centre (moving least squares, Lancaster and Salkauskas 1981). A
  /// force on this mean does not dent a finer mesh more, as a force on a single point does. For a
  /// ball in one linear element, or with too little of it inside the mesh, the result is that of
  /// locate().
  /// @param centre,outside,what as for locate(). @param radius m; zero: locate().
  EmbeddedPoint spread(const Vector3& centre, double radius, Outside outside,
                       const std::string& what) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sinew::mesh
