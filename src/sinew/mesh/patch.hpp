/// @file
/// Parts of a mesh's surface picked by place, by name, by angle or by the void that they enclose:
/// where pressure acts.
#pragma once

#include <string>
#include <vector>

#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

/// Boundary faces all of whose nodes lie in the region; of a set of triangles, those triangles that
/// are boundary faces.
/// @param mesh,region,what as for select_nodes().
/// Throws what select_nodes() does, and Error(empty-region) when no face has all its nodes there.
std::vector<Face> select_faces(const Mesh& mesh, const Region& region, const std::string& what);

/// The boundary face nearest to a point, and all that can be reached from it over edges at which
/// the surface turns by less than `angle`.
/// @param mesh to pick from.
/// @param point (3,) m.
/// @param angle rad, > 0; pi takes the whole connected surface.
/// @param what names the use in messages. Throws Error(out-of-range, not-finite).
std::vector<Face> grow_patch(const Mesh& mesh, const Vector3& point, double angle,
                             const std::string& what);

/// The connected surface that encloses a void of the body round a point.
/// @param mesh to pick from.
/// @param point (3,) m in the void.
/// @param what names the use in messages. Throws Error(empty-region) when the point lies in the
///   material, outside the body, or in a bore that is open to the outside.
std::vector<Face> enclosing_surface(const Mesh& mesh, const Vector3& point,
                                    const std::string& what);

/// The closed loops of edges at which faces end, each in the direction in which a cap over it would
/// run: empty for a closed surface.
/// @param faces of one orientation. Throws Error(surface-not-closed) where an edge has more than
///   two faces or loops touch each other.
std::vector<std::vector<NodeId>> open_loops(const std::vector<Face>& faces);

}  // namespace sinew::mesh
