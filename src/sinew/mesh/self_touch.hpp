/// @file
/// Detection of self-penetration of a deformed mesh.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Finds where the surface of a mesh penetrates the mesh elsewhere. Made once per mesh.
class SelfTouch {
 public:
  struct Touch {
    NodeId node = -1;  ///< node of the surface
    int element = -1;  ///< element that contains it: tetrahedra, then hexahedra
  };

  /// @param mesh must outlive this. Elements count as their flat corner tetrahedra.
  explicit SelfTouch(const Mesh& mesh);

  /// @param positions (n, 3) m, of all nodes.
  /// @param apart m: pairs that are nearer than this at rest are ignored, for instance in the dent
  ///   around a point load.
  /// @return the lowest-numbered surface node that lies inside an element to which it does not
  ///   belong;
  ///   none without overlap. Touching without overlap is not detected, nor are crossing edges as
  ///   long
  ///   as no node is inside.
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
