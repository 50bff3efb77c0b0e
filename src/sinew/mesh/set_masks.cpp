#include "sinew/mesh/set_masks.hpp"

namespace sinew::mesh {

namespace {

void mark(SetMasks& masks, const std::map<std::string, std::vector<NodeId>>& sets,
          std::size_t first, std::size_t count) {
  for (const auto& [name, members] : sets) {
    auto& mask = masks.try_emplace(name, count, std::uint8_t{0}).first->second;
    for (const NodeId member : members) mask[first + static_cast<std::size_t>(member)] = 1;
  }
}

}  // namespace

SetMasks node_masks(const Mesh& mesh) {
  SetMasks masks;
  mark(masks, mesh.node_sets, 0, static_cast<std::size_t>(mesh.node_count()));
  return masks;
}

SetMasks cell_masks(const Mesh& mesh, bool triangles) {
  const std::size_t volumes = mesh.tetrahedra.size() + mesh.hexahedra.size();
  const std::size_t count = volumes + (triangles ? mesh.triangles.size() : 0);
  SetMasks masks;
  mark(masks, mesh.tetrahedron_sets, 0, count);
  mark(masks, mesh.hexahedron_sets, mesh.tetrahedra.size(), count);
  if (triangles) mark(masks, mesh.triangle_sets, volumes, count);
  return masks;
}

}  // namespace sinew::mesh
