/// @file
/// Meshes that Sinew makes itself: structured, conforming, of good quality. Lengths in m. Circles
/// of cylinders, cones and tubes become polygons of the same area, whose corners lie a little
/// outside.
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

/// Sets: nodes `bottom`, `top`, `side`.
/// @param shape its measures. Throws Error(out-of-range).
/// @param cells what it is made of.
Mesh trunk(const TrunkShape& shape = {}, Cells cells = Cells::tetrahedra);

}  // namespace sinew::mesh
