/// @file
/// What only some bodies can do, as interfaces that are asked for: as<HasBase>(body) is null where
/// a body has none.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include "sinew/collision/shape.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/affine_field.hpp"

namespace sinew::collision {
class SurfaceTopology;
}
namespace sinew::mesh {
enum class Outside;
}

namespace sinew::mechanics {

class SurfaceTrace;

/// A capability of a Body or BodyModel; null where it has not got it.
template <class Capability, class Owner>
Capability* as(Owner& owner) {
  return dynamic_cast<Capability*>(&owner);
}

/// A spring from a point of a body to a place in the world, a hand that pulls at the robot: the
/// force stiffness (anchor - x) on x = sum weights x_node, taken implicitly. Every step's matrix
/// holds the spring, so that no stiffness is too large for it.
struct Tether {
  std::array<NodeId, 3> nodes{};                 ///< mesh nodes of one face of an element, distinct
  std::array<double, 3> weights{1.0, 0.0, 0.0};  ///< sum 1; 0 at nodes that do not count
  Vector3 anchor = Vector3::Zero();              ///< m
  double stiffness = 0.0;                        ///< N/m, >= 0
};

/// A body whose nodes can be pulled at. All of it are inputs, not state.
class TakesForces {
 public:
  virtual ~TakesForces() = default;
  /// (n, 3) N, dead loads added to gravity; zero unless set. Forces on fixed nodes do nothing.
  virtual Points& external_forces() = 0;
  virtual const Points& external_forces() const = 0;
  /// From the next step on; none lets go.
  /// @param tether see there. Throws Error: index-out-of-range (node), out-of-range (weights,
  /// stiffness), not-finite, bad-argument when the nodes are no face of an element.
  virtual void set_tether(const std::optional<Tether>& tether) = 0;
  virtual const std::optional<Tether>& tether() const = 0;
  /// Where the tether holds the body now, (3,) m. Only while there is one.
  virtual Vector3 tether_point() const = 0;
};

/// A body that stands on a base: nodes whose motion is given.
class HasBase {
 public:
  virtual ~HasBase() = default;
  /// Whether something is fixed that can be moved: nodes, or all of a rigid body.
  virtual bool base_can_move() const = 0;
  /// Where the base goes when the next step begins: a displacement from rest. None: it stays. An
  /// input.
  virtual void move_base(const std::optional<AffineField>& displacement) = 0;
  virtual const std::optional<AffineField>& base_input() const = 0;
};

/// A body model that may have a base.
class MayHaveBase {
 public:
  virtual ~MayHaveBase() = default;
  /// Whether something of it is fixed, and stands where a base motion puts it.
  virtual bool has_base() const = 0;
};

/// A body that carries loads declared with it.
class TakesLoads {
 public:
  virtual ~TakesLoads() = default;
  /// 1 unless set. An input. @param load number of the body's own.
  /// @param factor times the load as declared, of either sign.
  virtual void set_load_factor(int load, double factor) = 0;
  /// (n, 3) N: what the loads put on all nodes, as of the last linearisation.
  virtual Points load_forces() const = 0;
};

/// A body model with parts that stay rigid, such as the sections of an arm.
class AttachesOrientations {
 public:
  virtual ~AttachesOrientations() = default;
  /// Attaches the rotation of the part that a point lies in. Building only.
  /// @param rest_position,outside,what as BodyModel::attach()'s.
  /// @return the site's number. Throws Error(point-outside-mesh).
  virtual int attach_orientation(const Vector3& rest_position, mesh::Outside outside,
                                 const std::string& what) = 0;
};

/// A body of such a model.
class HasOrientations {
 public:
  virtual ~HasOrientations() = default;
  /// Rotation of an attached orientation since rest.
  virtual Matrix3 rotation(int orientation) const = 0;
};

/// A body model with a surface of triangles. Their nodes need not be those of its mesh.
class HasSurface {
 public:
  virtual ~HasSurface() = default;
  /// Attaches the whole surface as one site (SurfaceSite). Building only. @return its number.
  virtual int attach_surface() = 0;
  /// Its triangles, outwards; those of quadratic faces are split at the middles of their edges.
  /// After attach_surface().
  virtual std::shared_ptr<const collision::SurfaceTopology> surface() const = 0;
  /// How its nodes move the points of these triangles. After attach_surface().
  virtual std::shared_ptr<const SurfaceTrace> surface_trace() const = 0;
  /// (n, 3) m, of its nodes at rest. After attach_surface().
  virtual const Points& rest_surface_nodes() const = 0;
  /// Whether no force moves a node: its motion is given.
  virtual bool holds(NodeId node) const = 0;
};

/// A body of such a model.
class HasSurfaceNodes {
 public:
  virtual ~HasSurfaceNodes() = default;
  virtual const Points& surface_nodes() const = 0;            ///< (n, 3) m
  virtual const Points& surface_node_velocities() const = 0;  ///< (n, 3) m/s
};

/// What of a rigid body touches others.
enum class TouchingPart { shape, hull, surface };

/// A body model that is rigid as a whole.
class HasShape {
 public:
  virtual ~HasShape() = default;
  virtual Vector3 rest_origin() const = 0;  ///< (3,) m, of its own frame at rest
  /// m, of a point (3,) m to its surface at rest: negative inside.
  virtual double rest_distance(const Vector3& point) const = 0;
  virtual double mass() const = 0;         ///< kg
  virtual Vector3 own_centre() const = 0;  ///< (3,) m, of mass, in its own frame
  /// kg m^2, (3, 3) about the centre of mass, in its own axes.
  virtual Matrix3 own_inertia() const = 0;
  virtual const char* shape_name() const = 0;  ///< "box", "sphere", ..., "mesh"
  virtual TouchingPart touching_part() const = 0;
  /// m, of a ball or a capsule. 0 for shapes with edges or corners, and for meshes.
  virtual double touching_radius() const = 0;
  /// The shape or the hull, which touches, where it is at rest, in the world. Of a surface its
  /// hull, which touches planes as it does.
  virtual collision::Shape rest_shape() const = 0;
};

/// A body of such a model.
class HasPose {
 public:
  virtual ~HasPose() = default;
  virtual Vector3 origin() const = 0;            ///< (3,) m, of its own frame
  virtual Vector3 centre_of_mass() const = 0;    ///< (3,) m
  virtual Matrix3 axes() const = 0;              ///< columns: of its own frame, in the world
  virtual Vector3 linear_velocity() const = 0;   ///< (3,) m/s, of the centre of mass
  virtual Vector3 angular_velocity() const = 0;  ///< (3,) rad/s, about the world's axes
  /// The state of the body at rest in a pose. @param origin (3,) m. @param axes unit quaternion.
  /// @param state (state_size(),) see Body::save_state().
  virtual void put_pose(const Vector3& origin, const Eigen::Quaterniond& axes,
                        std::span<double> state) const = 0;
};

/// A body of few coordinates, which users know.
class HasCoordinates {
 public:
  virtual ~HasCoordinates() = default;
  /// An attached coordinate, rad or m. @param site its number as a site.
  virtual double coordinate(int site) const = 0;
  virtual const VectorX& coordinates() const = 0;  ///< (coordinates,) rad; extensions: m
  virtual const VectorX& rates() const = 0;        ///< (coordinates,) rad/s; m/s
  /// A new state. @param q,rate (coordinates,). Throws Error(wrong-shape).
  virtual void set_coordinates(const VectorX& q, const VectorX& rate) = 0;
};

}  // namespace sinew::mechanics
