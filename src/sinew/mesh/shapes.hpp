/// @file
/// Generated meshes: structured, conforming, of good quality. Lengths in m. Circles of cylinders,
/// cones and tubes become polygons of the same area; balls and capsules become polyhedra of the
/// same volume. Their corners therefore lie slightly outside of the round shape.
#pragma once

#include <array>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Kind of cells of a shape. With quadratic tetrahedra, corners and middle nodes lie on the circles
/// of round shapes; for other cells, see the top of this file.
enum class Cells { tetrahedra, quadratic, hexahedra };

/// A box. With tetrahedra, each cell is split into six (Kuhn), and neighbours are mirror images in
/// their common face. The mesh is symmetric about the middle of every axis with an even number of
/// cells.
struct BlockShape {
  Vector3 corner = Vector3::Zero();    ///< m, the lower corner
  Vector3 size{0.1, 0.02, 0.02};       ///< m
  std::array<int, 3> cells{10, 2, 2};  ///< along x, y, z
};

/// A solid cylinder along +z, with its bottom at z = 0.
struct CylinderShape {
  double radius = 0.01;  ///< m
  double height = 0.1;   ///< m
  /// Rings of cells around the axis. With tetrahedra, ring r has 6 r nodes; hexahedra need at least
  /// two rings.
  int rings = 2;
  int layers = 10;  ///< along the axis
};

/// A frustum along +z, with its bottom at z = 0.
struct ConeShape {
  double bottom_radius = 0.02;  ///< m
  double top_radius = 0.01;     ///< m, > 0
  double height = 0.1;          ///< m
  int rings = 2;
  int layers = 10;
};

/// A tube along +z, with its bottom at z = 0.
struct HollowCylinderShape {
  double inner_radius = 0.008;  ///< m
  double outer_radius = 0.012;  ///< m
  double height = 0.05;         ///< m
  int through = 2;              ///< cells through the wall
  int around = 24;              ///< cells around the axis
  int layers = 12;              ///< cells along the axis
};

/// An elephant-trunk robot: a tapered solid along +z with a corrugated outside, like bellows. The
/// defaults give 703 nodes and 2592 tetrahedra. Cables fit inside the groove radius.
struct TrunkShape {
  double height = 0.195;         ///< m
  double bottom_radius = 0.020;  ///< m, of the crests at z = 0
  double top_radius = 0.0085;    ///< m, of the crests at the tip
  double groove_depth = 0.25;    ///< depth of a groove relative to the local crest radius, 0 to 0.6
  int bellows = 9;               ///< crests along the height
  int layers_per_bellow = 4;     ///< even, >= 2
  int rings = 2;
};

/// A cylinder along +z, with its bottom at z = 0 and a cylindrical chamber beside its axis.
struct ChamberedCylinderShape {
  double radius = 0.0125;          ///< m
  double height = 0.065;           ///< m
  double chamber_radius = 0.0037;  ///< m
  double chamber_offset = 0.0073;  ///< m, of the axis of the chamber along +x
  double chamber_bottom = 0.0;     ///< m; 0: the chamber is open at the bottom
  double chamber_top = 0.06;       ///< m, at most the height
  int core = 3;     ///< rings of cells in the circle of the chamber, where it is solid
  int through = 4;  ///< cells from the chamber wall to the outside
  int layers = 26;  ///< approximate number along the axis
};

/// A ball about the origin.
struct SphereShape {
  double radius = 0.015;  ///< m
  int rings = 3;          ///< of cells around the centre; at least two with hexahedra
};

/// A cylinder along z between two half balls, with its centre at the origin.
struct CapsuleShape {
  double radius = 0.01;  ///< m
  double length = 0.04;  ///< m, of the cylinder without the half balls
  int rings = 2;         ///< as for a cylinder
  int layers = 4;        ///< of the cylinder
};

/// A finger for a cable: a spine along +x with ribs in +z. There is a rib at each end, the first at
/// x = 0. All ribs have the same length, with equal gaps between them.
struct RibbedFingerShape {
  Vector3 size{0.1, 0.02, 0.02};  ///< m, along x, y, z
  double spine = 0.006;           ///< m, thickness of the spine, from z = 0
  double gap = 0.005;             ///< m, between two ribs
  int ribs = 7;                   ///< >= 2
  int rib_cells = 2;              ///< along a rib
  int gap_cells = 1;              ///< along a gap
  int width_cells = 3;
  int spine_cells = 1;     ///< through the spine
  int rib_rise_cells = 2;  ///< from the spine to the top of the ribs
};

/// Makes a box. Node sets: `x_min`, `x_max`, `y_min`, `y_max`, `z_min`, `z_max`.
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive.
/// @param cells kind of cells.
Mesh block(const BlockShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a cylinder. Node sets: `bottom`, `top`, `side`.
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive.
/// @param cells kind of cells.
Mesh cylinder(const CylinderShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a frustum. Node sets: `bottom`, `top`, `side`.
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive.
/// @param cells kind of cells.
Mesh cone(const ConeShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a tube. Node sets: `bottom`, `top`, `inner`, `outer`.
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive or the inner radius
///   is not less than the outer one.
/// @param cells kind of cells.
Mesh hollow_cylinder(const HollowCylinderShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a cylinder with a chamber. Node sets: `bottom`, `top`, `side`, and `chamber`, the whole
/// wall of the chamber.
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive or the chamber is not
///   inside.
/// @param cells kind of cells.
Mesh chambered_cylinder(const ChamberedCylinderShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a ball. Node sets: `surface`, and its parts `top` (z >= 0) and `bottom` (z <= 0).
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive.
/// @param cells kind of cells.
Mesh sphere(const SphereShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a capsule. Node sets: `surface`, and its parts `side` (cylinder), `top` and `bottom` (half
/// balls).
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive.
/// @param cells kind of cells.
Mesh capsule(const CapsuleShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a ribbed finger. Node sets: `x_min`, `x_max`, `y_min`, `y_max`, `z_min`, and `z_max`, the
/// tops of the ribs.
/// @param shape dimensions. Throws Error(out-of-range) if one is not positive, the gaps leave no
///   room for ribs, or the spine fills the height.
/// @param cells kind of cells.
Mesh ribbed_finger(const RibbedFingerShape& shape, Cells cells = Cells::tetrahedra);

/// Makes a trunk. Node sets: `bottom`, `top`, `side`.
/// @param shape dimensions. Throws Error(out-of-range).
/// @param cells kind of cells.
Mesh trunk(const TrunkShape& shape = {}, Cells cells = Cells::tetrahedra);

}  // namespace sinew::mesh
