/// @file
/// A volume mesh for simulation: nodes, tetrahedra, hexahedra and named sets. Lengths in m.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::mesh {

/// Four node numbers, positively oriented: (x1-x0) . ((x2-x0) x (x3-x0)) > 0, as in VTK and Gmsh.
using Tetrahedron = std::array<NodeId, 4>;
/// The corners of a tetrahedron, then the middle nodes of its edges 01, 12, 20, 03, 13, 23, as in
/// VTK.
using QuadraticTetrahedron = std::array<NodeId, 10>;
/// Eight node numbers in VTK_HEXAHEDRON order.
using Hexahedron = std::array<NodeId, 8>;
/// Three node numbers, counter-clockwise seen from outside.
using Triangle = std::array<NodeId, 3>;

/// Notes from reading and checking a mesh, for `sinew info`.
struct LoadNotes {
  std::string format;          ///< such as "VTK legacy 2.0, binary"; empty for generated meshes
  double unit = 1.0;           ///< m per file unit
  int reordered_elements = 0;  ///< elements whose opposite node order was corrected
  int passed_over_cells = 0;   ///< ignored cells of the file: vertices, lines, quadrilaterals, ...
};

/// A volume mesh, immutable after loading and checking. Nodes have the order of the file, including
/// unused ones.
struct Mesh {
  std::string name;  ///< file or generator, for messages
  Points nodes;      ///< (n, 3) m
  /// Columns: the axes of the file or generator in the frame of `nodes`, a rotation. What a mesh
  /// leaves open (the diagonal of a square face) is chosen by them, so it turns with the mesh.
  Matrix3 axes = Matrix3::Identity();
  std::vector<Tetrahedron> tetrahedra;
  /// Tetrahedra with middle nodes, in the order of `tetrahedra`, which are then their corners.
  /// Empty if the tetrahedra are linear; a mesh has only one of the two kinds.
  std::vector<QuadraticTetrahedron> quadratic;
  std::vector<Hexahedron> hexahedra;
  std::vector<Triangle> triangles;  ///< surface triangles of the file; may be empty

  /// Named sets from physical groups or integer cell/point data ("name" or "name:value").
  std::map<std::string, std::vector<NodeId>> node_sets;
  std::map<std::string, std::vector<NodeId>> tetrahedron_sets;  ///< positions in `tetrahedra`
  std::map<std::string, std::vector<NodeId>> hexahedron_sets;   ///< positions in `hexahedra`
  std::map<std::string, std::vector<NodeId>> triangle_sets;     ///< positions in `triangles`

  LoadNotes notes;

  int node_count() const { return static_cast<int>(nodes.rows()); }
};

/// A closed or open triangle surface. Lengths in m.
struct Surface {
  std::string name;
  Points nodes;  ///< (n, 3) m
  std::vector<Triangle> triangles;
};

}  // namespace sinew::mesh
