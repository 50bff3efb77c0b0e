/// @file
/// Description of a mesh, for `sinew info` and logs.
#pragma once

#include <string>
#include <vector>

#include "sinew/mesh/check.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/rigid_parts.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

/// Counts of values in equal bins from `low` to `high`.
struct Histogram {
  double low = 0.0;
  double high = 1.0;
  std::vector<int> counts;
};

/// Name, kind and size of a set.
struct SetSummary {
  std::string name;
  std::string kind;  ///< "nodes", "triangles", "tetrahedra", "hexahedra"
  int size = 0;
};

/// Description of a mesh. Lengths in m, volumes in m^3, angles in degrees.
struct MeshReport {
  std::string name;
  LoadNotes notes;
  int nodes = 0, tetrahedra = 0, hexahedra = 0, triangles = 0;
  int unused_nodes = 0;
  Vector3 low = Vector3::Zero();   ///< lower corner of the bounding box of used nodes
  Vector3 high = Vector3::Zero();  ///< upper corner
  double volume = 0.0;
  double surface_area = 0.0;

  // For tetrahedra only; 0 or empty without them.
  double shortest_edge = 0.0, mean_edge = 0.0, longest_edge = 0.0;
  double min_radius_ratio = 0.0, mean_radius_ratio = 0.0;
  int worst_tetrahedron = -1;  ///< the one with the smallest radius ratio
  Histogram radius_ratio;      ///< 10 bins from 0 to 1
  double min_dihedral = 0.0, max_dihedral = 0.0;
  Histogram dihedral;  ///< 9 bins from 0 to 180 degrees, six angles per tetrahedron

  std::vector<SetSummary> sets;
  Components components;
  std::vector<LooseJoint> loose;        ///< result of loose_joints()
  std::vector<std::string> loose_text;  ///< each of them in words
  std::vector<Defect> defects;          ///< result of find_defects()
};

/// Describes a mesh with or without defects. The number of reordered elements is that in
/// `mesh.notes`.
/// @param mesh to describe, after reorder_elements().
/// @param options of find_defects().
MeshReport describe(const Mesh& mesh, const CheckOptions& options = {});

/// The report as text of a dozen lines, with lengths in a convenient unit.
/// @param report to print.
std::string format_report(const MeshReport& report);

/// A length with a convenient unit, such as "195 mm" or "1.2 m".
/// @param metres the length.
std::string format_length(double metres);

}  // namespace sinew::mesh
