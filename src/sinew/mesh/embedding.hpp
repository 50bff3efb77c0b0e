/// @file
/// Material points: where a point of space sits inside a mesh of tetrahedra and hexahedra.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Points nearer to the outside than this share of the mesh's size (its box's diagonal) lie on it.
/// Files round coordinates: single precision by 2^-24 = 6e-8 of their value, six decimal digits
/// ("%g", as Gmsh writes STL) by up to 5e-6, which moves a point by sqrt(3) 5e-6 = 8.7e-6 of the
/// largest coordinate.
constexpr double kOnSurface = 1e-5;

/// What to do with a point that lies in no element and not on the surface either (kOnSurface).
enum class Outside {
  error,    ///< throw Error(point-outside-mesh) naming the point, its distance and the nearest
            ///< element
  nearest,  ///< extrapolate linearly from the nearest element (some weights negative)
};

/// x = sum_k weights[k] * nodes[k]; weights sum to 1.
struct EmbeddedPoint {
  std::vector<NodeId> nodes;    ///< of the element, or its corners, or four of a hexahedron's
  std::vector<double> weights;  ///< as many
  int element = -1;             ///< that carries the point: tetrahedra, then hexahedra
  double distance = 0.0;        ///< m, from the nearest element; 0 inside and on the surface
};

/// Finds the element that holds a point (bounding-volume tree; O(log n) a query). Ties on faces go
/// to the lowest element number, so that results do not depend on the tree. Hexahedra are searched
/// as six tetrahedra round the diagonal 0-6; points inside get trilinear weights. Quadratic
/// tetrahedra are searched as their corners, and points inside get quadratic weights.
class Embedder {
 public:
  explicit Embedder(const Mesh& mesh);
  ~Embedder();
  Embedder(Embedder&&) noexcept;
  Embedder& operator=(Embedder&&) noexcept;

  /// @param point,outside (3,) m in the mesh's rest frame, and what to do when no element holds it.
  /// @param what names the point in the error message ("via point 3 of cable long_0").
  EmbeddedPoint locate(const Vector3& point, Outside outside, const std::string& what) const;

  /// The mean of the part of a ball that lies inside, with weights changed linearly over the ball
  /// so that its centre stays the mean (moving least squares, Lancaster and Salkauskas 1981). In a
  /// mesh coarser than the ball this is locate(); in a finer one a force on it does not dent the
  /// material the more the finer the mesh is, as it does at a bare point.
  /// @param centre,outside,what as locate()'s. @param radius m; zero: locate().
  EmbeddedPoint spread(const Vector3& centre, double radius, Outside outside,
                       const std::string& what) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sinew::mesh
