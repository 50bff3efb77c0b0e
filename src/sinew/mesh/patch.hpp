/// @file
/// Selection of surface faces by place, name, angle, or the void that they enclose, for pressure.
#pragma once

#include <string>
#include <vector>

#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

/// Selects the boundary faces with all their nodes in a region; for a set of triangles, those
/// triangles that are boundary faces.
/// @param mesh,region,what as for select_nodes().
/// Throws the errors of select_nodes(), and Error(empty-region) if no face has all its nodes there.
std::vector<Face> select_faces(const Mesh& mesh, const Region& region, const std::string& what);

/// Selects the boundary face whose centre is nearest to a point, and all faces that can be reached
/// from it over edges at which the surface turns by at most `angle`.
/// @param mesh to select from.
/// @param point (3,) m.
/// @param angle rad, > 0; pi selects the whole connected surface.
/// @param what name of the use in messages. Throws Error(out-of-range, not-finite,
///   no-volume-elements).
std::vector<Face> grow_patch(const Mesh& mesh, const Vector3& point, double angle,
                             const std::string& what);

/// Selects the connected surface that encloses a void around a point: the one whose winding number
/// about the point is 1.
/// @param mesh to select from.
/// @param point (3,) m in the void.
/// @param what name of the use in messages. Throws Error(empty-region) if the point lies in the
///   material, outside of the body, or in a bore that is open to the outside.
std::vector<Face> enclosing_surface(const Mesh& mesh, const Vector3& point,
                                    const std::string& what);

/// The closed loops of edges at which faces end, in the direction of the edges of a cap; empty for
/// a closed surface.
/// @param faces of consistent orientation. Throws Error(surface-not-closed) if two faces end at the
///   same edge or loops touch each other.
std::vector<std::vector<NodeId>> open_loops(const std::vector<Face>& faces);

}  // namespace sinew::mesh
