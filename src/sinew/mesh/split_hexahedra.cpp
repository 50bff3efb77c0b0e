#include "sinew/mesh/split_hexahedra.hpp"

#include <algorithm>

#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

Mesh split_hexahedra(const Mesh& mesh) {
  Mesh result = mesh;
  result.hexahedra.clear();
  result.tetrahedron_sets.clear();
  result.hexahedron_sets.clear();
  for (const Hexahedron& hexahedron : mesh.hexahedra) {
    const NodeId apex = *std::ranges::min_element(hexahedron);
    for (std::array<NodeId, 4> face : faces_of(hexahedron)) {
      if (std::ranges::find(face, apex) != face.end()) continue;
      std::ranges::rotate(face, std::ranges::min_element(face));
      result.tetrahedra.push_back({apex, face[0], face[1], face[2]});
      result.tetrahedra.push_back({apex, face[0], face[2], face[3]});
    }
  }
  return result;
}

}  // namespace sinew::mesh
