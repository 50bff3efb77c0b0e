/// @file
/// Parts of a mesh that can move against each other without deforming any element.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// A part of a mesh: volume elements that cannot move against each other, since they share faces,
/// or three nodes that are not on one line.
struct RigidPart {
  int elements = 0;
  std::vector<NodeId> nodes;  ///< ascending
};

/// Decomposes a mesh into its rigid parts, largest first. Parts that are joined only at nodes or
/// along straight edges are separate; so are those that share nothing. A single part cannot move
/// without deforming, unless as a whole.
std::vector<RigidPart> rigid_parts(const Mesh& mesh);

/// (nodes of the mesh,) parts of each node, ascending; empty for unused nodes.
std::vector<std::vector<int>> parts_of_nodes(const Mesh& mesh, std::span<const RigidPart> parts);

/// A coordinate of a node that does not move.
struct HeldAxis {
  NodeId node = 0;
  int axis = 0;  ///< 0, 1, 2: x, y, z
};

/// A part that can move without deforming any element.
struct LooseJoint {
  int elements = 0;            ///< of the part
  Vector3 centre;              ///< m, mean of its nodes
  std::vector<NodeId> shared;  ///< nodes that it shares with other parts, ascending; empty: none
  int motions = 0;             ///< independent rigid motions of the part against the rest, 1 to 6
};

/// Finds the parts that can move without deforming any element, by the rank of what joins and holds
/// them: u(x) = t + w x x is rigid in each part, equal at shared nodes, and zero where held.
/// Without held nodes, rigid motions of the whole mesh do not count. Rings of parts may hold each
/// other although each pair shares an edge only; they are not loose.
/// @param mesh checked. @param held node directions that do not move.
/// @return loose parts, largest first; for a mesh that holds nothing, without its largest part.
std::vector<LooseJoint> loose_joints(const Mesh& mesh, std::span<const HeldAxis> held = {});

/// "6 elements around (0.015, 0.005, 0.015) m hang on the others along the edge from node 3 at
/// (0.01, 0, 0.01) to node 7 at (0.01, 0.01, 0.01) m", or "at node 3 at ...", or "are connected to
/// nothing".
std::string describe(const LooseJoint& loose, const Mesh& mesh);

}  // namespace sinew::mesh
