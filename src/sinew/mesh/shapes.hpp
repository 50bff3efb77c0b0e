/// @file
/// Meshes that Sinew makes itself: structured, conforming, of good quality. Lengths in m. Circles
/// of cylinders, cones and tubes become polygons of the same area, balls and capsules polyhedra of
/// the same volume, whose corners lie a little outside.
#pragma once

#include <array>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// What shapes are made of. Quadratic tetrahedra have their middle nodes on the circles of round
/// shapes, and their corners, too; of other cells see the file.
enum class Cells { tetrahedra, quadratic, hexahedra };

/// A box of Kuhn-split cubes: six tetrahedra a cell, all of one shape class when cells are cubes.
struct BlockShape {
  Vector3 corner = Vector3::Zero();    ///< m, the least corner
  Vector3 size{0.1, 0.02, 0.02};       ///< m
  std::array<int, 3> cells{10, 2, 2};  ///< along x, y, z
};

/// A circular solid along +z, its bottom at z = 0.
struct CylinderShape {
  double radius = 0.01;  ///< m
  double height = 0.1;   ///< m
  /// Rings of cells round the axis; of tetrahedra ring r has 6 r nodes, of hexahedra there are at
  /// least two.
  int rings = 2;
  int layers = 10;  ///< along the axis
};

/// A frustum along +z, its bottom at z = 0.
struct ConeShape {
  double bottom_radius = 0.02;  ///< m
  double top_radius = 0.01;     ///< m, > 0
  double height = 0.1;          ///< m
  int rings = 2;
  int layers = 10;
};

/// A tube along +z, its bottom at z = 0.
struct HollowCylinderShape {
  double inner_radius = 0.008;  ///< m
  double outer_radius = 0.012;  ///< m
  double height = 0.05;         ///< m
  int through = 2;              ///< cells through the wall
  int around = 24;              ///< cells round the axis
  int layers = 12;              ///< cells along the axis
};

/// An elephant-trunk robot: a tapered solid along +z whose outside is corrugated like bellows. The
/// defaults give 703 nodes and 2592 tetrahedra; cables run inside up to the groove radius.
struct TrunkShape {
  double height = 0.195;         ///< m
  double bottom_radius = 0.020;  ///< m, of the crests at z = 0
  double top_radius = 0.0085;    ///< m, of the crests at the tip
  double groove_depth = 0.25;    ///< depth of a groove over the local crest radius, 0 to 0.6
  int bellows = 9;               ///< crests along the height
  int layers_per_bellow = 4;     ///< even, >= 2
  int rings = 2;
};

/// A solid cylinder along +z, its bottom at z = 0, with a cylindrical chamber beside its axis.
struct ChamberedCylinderShape {
  double radius = 0.0125;          ///< m
  double height = 0.065;           ///< m
  double chamber_radius = 0.0037;  ///< m
  double chamber_offset = 0.0073;  ///< m, of the chamber's axis along +x
  double chamber_bottom = 0.0;     ///< m; 0: the chamber opens at the bottom
  double chamber_top = 0.06;       ///< m, at most the height
  int core = 3;                    ///< rings of cells in the chamber's circle, where it is solid
  int through = 4;                 ///< cells from the chamber's wall to the outside
  int layers = 26;                 ///< about, along the axis
};

/// A ball about the origin.
struct SphereShape {
  double radius = 0.015;  ///< m
  int rings = 3;          ///< of cells round the centre; of hexahedra at least two
};

/// A cylinder along z between two half balls, its centre at the origin.
struct CapsuleShape {
  double radius = 0.01;  ///< m
  double length = 0.04;  ///< m, of the cylinder alone
  int rings = 2;         ///< as for a cylinder
  int layers = 4;        ///< of the cylinder
};

/// A finger for a cable: a spine along +x with ribs on it, upwards. A rib at either end, the first
/// from x = 0; all of the same length, with equal gaps between them.
struct RibbedFingerShape {
  Vector3 size{0.1, 0.02, 0.02};  ///< m, along x, y, z
  double spine = 0.006;           ///< m, its thickness, from z = 0
  double gap = 0.005;             ///< m, between two ribs
  int ribs = 7;                   ///< >= 2
  int rib_cells = 2;              ///< along a rib
  int gap_cells = 1;              ///< along a gap
  int width_cells = 3;
  int spine_cells = 1;     ///< through the spine
  int rib_rise_cells = 2;  ///< from the spine to the top of the ribs
};

/// Sets: nodes `x_min`, `x_max`, `y_min`, `y_max`, `z_min`, `z_max`.
/// @param shape its measures. Throws Error(out-of-range) when one is not positive.
/// @param cells what it is made of; nodes and sets are the same.
Mesh block(const BlockShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `bottom`, `top`, `side`.
/// @param shape its measures. Throws Error(out-of-range) when one is not positive.
/// @param cells what it is made of.
Mesh cylinder(const CylinderShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `bottom`, `top`, `side`.
/// @param shape its measures. Throws Error(out-of-range) when one is not positive.
/// @param cells what it is made of.
Mesh cone(const ConeShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `bottom`, `top`, `inner`, `outer`.
/// @param shape its measures. Throws Error(out-of-range) when one is not positive or the inner
/// radius is not the smaller one.
/// @param cells what it is made of.
Mesh hollow_cylinder(const HollowCylinderShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `bottom`, `top`, `side`, and `chamber`, those of the chamber's whole wall.
/// @param shape its measures. Throws Error(out-of-range) when one is not positive or the chamber
///   does not lie inside.
/// @param cells what it is made of.
Mesh chambered_cylinder(const ChamberedCylinderShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `surface`, and of it `top` (z >= 0) and `bottom` (z <= 0).
/// @param shape its measures. Throws Error(out-of-range) when one is not positive.
/// @param cells what it is made of.
Mesh sphere(const SphereShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `surface`, and of it `side` (the cylinder), `top` and `bottom` (the half balls).
/// @param shape its measures. Throws Error(out-of-range) when one is not positive.
/// @param cells what it is made of.
Mesh capsule(const CapsuleShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `x_min`, `x_max`, `y_min`, `y_max`, `z_min` and `z_max`, the tops of the ribs.
/// @param shape its measures. Throws Error(out-of-range) when one is not positive, or the gaps
///   leave no ribs, or the spine fills the height.
/// @param cells what it is made of.
Mesh ribbed_finger(const RibbedFingerShape& shape, Cells cells = Cells::tetrahedra);

/// Sets: nodes `bottom`, `top`, `side`.
/// @param shape its measures. Throws Error(out-of-range).
/// @param cells what it is made of.
Mesh trunk(const TrunkShape& shape = {}, Cells cells = Cells::tetrahedra);

}  // namespace sinew::mesh
