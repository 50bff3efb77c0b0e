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

  /// @param mesh must outlive this.
  explicit SelfTouch(const Mesh& mesh);

  /// Elements are curved: a point is inside if its coordinates in the element are. Inside a
  /// quadratic element, it must also be inside the four flat triangles of each face, with which
  /// contact replaces the curved face: nodes that rest on them do not overlap.
  /// @param positions (n, 3) m, of all nodes.
  /// @param apart m: pairs that are nearer than this at rest are ignored, for instance in the dent
  ///   around a point load.
  /// @return the lowest-numbered surface node that lies inside an element to which it does not
  ///   belong; none without overlap. Touching without overlap is not detected, nor are crossing
  ///   edges as long as no node is inside.
  std::optional<Touch> find(const Points& positions, double apart = 0.0) const;

 private:
  /// All nodes of an element: 4, 10 or 8.
  struct Element {
    std::array<NodeId, 10> node{};
    std::size_t size = 0;
  };
  bool contains(const Element& element, const Points& positions, const Vector3& point) const;

  const Mesh& mesh_;
  std::vector<Element> elements_;              // tetrahedra, then hexahedra
  std::vector<NodeId> surface_;                // ascending
  std::vector<std::vector<int>> elements_of_;  // of each node
};

}  // namespace sinew::mesh
