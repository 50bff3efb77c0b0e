/// @file
/// Shapes of rigid bodies, and their mass properties.
#pragma once

#include <memory>
#include <variant>

#include "sinew/collision/shape.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::rigid {

// All shapes but Solid are centred on the origin.

/// A box.
struct Box {
  Vector3 edges;  ///< (3,) m, full edge lengths
};
/// A ball.
struct Sphere {
  double radius = 0.0;  ///< m
};
/// A cylinder along z with hemispheres at its ends.
struct Capsule {
  double radius = 0.0, length = 0.0;  ///< m; length of the cylinder without its ends
};
/// A cylinder along z.
struct Cylinder {
  double radius = 0.0, height = 0.0;  ///< m, along z
};

/// The solid enclosed by a closed triangle surface.
struct Solid {
  std::shared_ptr<const mesh::Surface> surface;       ///< m
  std::shared_ptr<const collision::Polyhedron> hull;  ///< touches; null: the surface does
};

using Shape = std::variant<Box, Sphere, Capsule, Cylinder, Solid>;
/// "box", "sphere", "capsule", "cylinder" or "mesh" (a Solid).
const char* shape_name(const Shape& shape);

/// Mass, centre of mass and inertia.
struct MassProperties {
  double mass = 0.0;                          ///< kg
  Vector3 centre = Vector3::Zero();           ///< m, centre of mass
  Matrix3 inertia = Matrix3::Identity() * 0;  ///< kg m^2, about the centre
};

/// Mass properties of a homogeneous solid. @param shape m, in its own frame. @param density kg/m^3.
/// Throws what mesh::require_solid() throws.
MassProperties mass_properties(const Shape& shape, double density);

/// The shape as a collision shape, in its own frame; for a Solid, its hull. Throws Error:
/// zero-volume if a Solid has no hull.
collision::Shape solid(const Shape& shape);
/// The collision shape in a pose. @param shape see solid(). @param position (3,) m, of its origin.
/// @param rotation (3, 3), columns: its axes.
collision::Shape placed(const Shape& shape, const Vector3& position, const Matrix3& rotation);

/// The triangles that bound a shape, in its own frame; those of the hull for a Solid that touches
/// with it. The corners on round shapes lie on the surface, and the triangles up to 0.2 % of the
/// radius below it.
mesh::Surface bounding_triangles(const Shape& shape);
/// The triangles on which pressure and water act, in the shape's own frame. Polygons
/// with 24 sides stand for circles, widened so that the exact volume is enclosed: buoyancy is
/// exact.
mesh::Surface loaded_triangles(const Shape& shape);
/// Radius of a ball or capsule, m; 0 for shapes with edges.
double smooth_radius(const Shape& shape);

/// A mesh for display: of volume elements, or of triangles for a Solid.
mesh::Mesh skin(const Shape& shape);

}  // namespace sinew::rigid
