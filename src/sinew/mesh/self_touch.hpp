/// @file
/// Whether a deformed mesh reaches into itself.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Finds where the surface of a mesh enters the mesh elsewhere. Made once for a mesh.
class SelfTouch {
 public:
  struct Touch {
    NodeId node = -1;  ///< of the surface
    int element = -1;  ///< that it lies in: tetrahedra, then hexahedra
  };

  /// @param mesh must outlive this. Elements count as their flat corner tetrahedra.
  explicit SelfTouch(const Mesh& mesh);

  /// @param positions (n, 3) m, of all nodes.
  /// @param apart m: what is nearer than this at rest is not looked at, such as the dent round a
  ///   point load.
  /// @return the first node of the surface, by number, that lies inside an element that it does not
  ///   belong to; none while nothing overlaps. Touching without overlap is not seen, an edge that
  ///   crosses an edge neither until a node is inside.
  std::optional<Touch> find(const Points& positions, double apart = 0.0) const;

 private:
  struct Part {
    Tetrahedron corners;
    int element;
  };
  const Mesh& mesh_;
  std::vector<Part> parts_;
  std::vector<NodeId> surface_;                // ascending
  std::vector<std::vector<int>> elements_of_;  // of each node
};

}  // namespace sinew::mesh
