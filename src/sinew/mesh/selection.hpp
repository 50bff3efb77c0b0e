/// @file
/// Selection of parts of a mesh by place or name, for instance to fix nodes.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Nodes in an axis-aligned box between two opposite corners, including the bounds.
struct BoxRegion {
  Vector3 low = Vector3::Zero();   ///< m
  Vector3 high = Vector3::Zero();  ///< m
};

/// Nodes in a ball, including its surface.
struct SphereRegion {
  Vector3 centre = Vector3::Zero();  ///< m
  double radius = 0.0;               ///< m
};

/// Nodes x with low <= (x - point) . normal / |normal| <= high: a slab, or a half-space if one
/// bound is infinite.
struct PlaneRegion {
  Vector3 point = Vector3::Zero();    ///< m
  Vector3 normal = Vector3::UnitZ();  ///< of any length except zero
  double low = 0.0;                   ///< m
  double high = 0.0;                  ///< m
};

/// Nodes of a named set: a node set, or the nodes of the triangles, tetrahedra or hexahedra of an
/// element set. If several sets have the name, their union.
struct NamedRegion {
  std::string name;
};

/// A region of any kind.
using Region = std::variant<BoxRegion, SphereRegion, PlaneRegion, NamedRegion>;

/// Selects the nodes of a region that volume elements use, ascending. Bounds have a tolerance of
/// 1e-9 of the diagonal of the mesh, so that no face is lost by a unit conversion.
/// Throws Error: empty-region with the region and the bounding box of the mesh, unknown-set with
/// the existing names, out-of-range for a low bound above the high one, a radius that is not
/// positive or a zero normal, not-finite.
/// @param mesh to select from.
/// @param region what to select.
/// @param what name of the use in messages, such as "bodies.trunk.fixed[0]".
std::vector<NodeId> select_nodes(const Mesh& mesh, const Region& region, const std::string& what);

/// Selects the tetrahedra of a named set. Throws Error(unknown-set).
/// @param mesh to select from.
/// @param name of the set.
/// @param what name of the use in messages.
std::vector<NodeId> select_tetrahedra(const Mesh& mesh, const std::string& name,
                                      const std::string& what);

/// Sorted names of all sets, without duplicates.
std::vector<std::string> set_names(const Mesh& mesh);

}  // namespace sinew::mesh
