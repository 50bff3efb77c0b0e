/// @file
/// Shapes of rigid bodies, and their mass.
#pragma once

#include <memory>
#include <variant>

#include "sinew/collision/shape.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::rigid {

// All but a solid are centred on the origin.
struct Box {
  Vector3 edges;  ///< (3,) m, whole
};
struct Sphere {
  double radius = 0.0;  ///< m
};
/// A cylinder along z with half spheres at its ends.
struct Capsule {
  double radius = 0.0, length = 0.0;  ///< m; of the cylinder, ends not counted
};
struct Cylinder {
  double radius = 0.0, height = 0.0;  ///< m, along z
};

/// What a closed triangle surface encloses.
struct Solid {
  std::shared_ptr<const mesh::Surface> surface;       ///< m
  std::shared_ptr<const collision::Polyhedron> hull;  ///< what touches; null: the surface does
};

using Shape = std::variant<Box, Sphere, Capsule, Cylinder, Solid>;
const char* shape_name(const Shape& shape);

struct MassProperties {
  double mass = 0.0;                          ///< kg
  Vector3 centre = Vector3::Zero();           ///< m, of mass
  Matrix3 inertia = Matrix3::Identity() * 0;  ///< kg m^2, about the centre
};

/// Of a homogeneous solid. @param shape m, in its own frame. @param density kg/m^3. Throws what
/// mesh::require_solid() does.
MassProperties mass_properties(const Shape& shape, double density);

/// The same as a shape of collision, in its own frame; of a Solid its hull. Throws
/// Error(zero-volume) where that has none.
collision::Shape solid(const Shape& shape);
/// That shape elsewhere. @param shape see solid(). @param position (3,) m, of its origin.
/// @param rotation (3, 3), of its axes.
collision::Shape placed(const Shape& shape, const Vector3& position, const Matrix3& rotation);

/// The triangles that bound it, a Solid's hull's where it touches with that; in its own frame.
/// Round shapes have their corners on the surface, and triangles up to 0.2 % of the radius below.
mesh::Surface bounding_triangles(const Shape& shape);
/// m, of a ball or a capsule; others, which have edges, 0.
double smooth_radius(const Shape& shape);

/// A mesh that shows the shape: of volume elements, but of triangles for a Solid.
mesh::Mesh skin(const Shape& shape);

}  // namespace sinew::rigid
