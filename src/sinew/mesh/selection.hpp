/// @file
/// Parts of a mesh picked by place or by name, for fixing nodes and the like.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Nodes between two opposite corners, bounds included.
struct BoxRegion {
  Vector3 low = Vector3::Zero();   ///< m
  Vector3 high = Vector3::Zero();  ///< m
};

/// Nodes in a ball, surface included.
struct SphereRegion {
  Vector3 centre = Vector3::Zero();  ///< m
  double radius = 0.0;               ///< m
};

/// Nodes x with low <= (x - point) . normal / |normal| <= high: a half-space when one bound is
/// infinite, a slab otherwise.
struct PlaneRegion {
  Vector3 point = Vector3::Zero();    ///< m
  Vector3 normal = Vector3::UnitZ();  ///< any length but zero
  double low = 0.0;                   ///< m
  double high = 0.0;                  ///< m
};

/// Nodes of a set of the file: a node set, or the nodes of the triangles, tetrahedra or hexahedra
/// of an element set; of all of them when several have the name.
struct NamedRegion {
  std::string name;
};

/// Any of them.
using Region = std::variant<BoxRegion, SphereRegion, PlaneRegion, NamedRegion>;

/// The nodes of the region that volume elements use, ascending. Bounds hold to within 1e-9 of the
/// mesh's diagonal, so that a unit conversion does not lose a face.
/// Throws Error: empty-region naming the region and the mesh's bounding box, unknown-set with the
/// names that there are, out-of-range for a box with low above high, a radius that is not positive
/// or a zero normal, not-finite.
/// @param mesh to pick from.
/// @param region what to pick.
/// @param what names the use in messages: "bodies.trunk.fixed[0]".
std::vector<NodeId> select_nodes(const Mesh& mesh, const Region& region, const std::string& what);

/// The tetrahedra of a set of the file. Throws Error(unknown-set).
/// @param mesh to pick from.
/// @param name of the set.
/// @param what names the use in messages.
std::vector<NodeId> select_tetrahedra(const Mesh& mesh, const std::string& name,
                                      const std::string& what);

/// Names of all sets, each once, in order.
std::vector<std::string> set_names(const Mesh& mesh);

}  // namespace sinew::mesh
