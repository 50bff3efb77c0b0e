/// @file
/// Interfaces that only some bodies and models implement: as<HasBase>(body) is null if the body has
/// no base.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/collision/shape.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/affine_field.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/rigid_parts.hpp"

namespace sinew::collision {
class SurfaceTopology;
}
namespace sinew::mechanics {

class SurfaceTrace;
struct Patch;

/// A capability of a Body or BodyModel; null if it lacks the capability.
template <class Capability, class Owner>
Capability* as(Owner& owner) {
  return dynamic_cast<Capability*>(&owner);
}

/// A spring from a point of a body to a fixed point in the world, such as a hand in the view that
/// pulls at the robot. Its force stiffness (anchor - x) acts on x = sum weights x_node. The spring
/// is implicit, so its stiffness does not limit the step size.
struct Tether {
  std::array<NodeId, 3> nodes{};                 ///< distinct mesh nodes of one face of an element
  std::array<double, 3> weights{1.0, 0.0, 0.0};  ///< sum 1; 0 at unused nodes
  Vector3 anchor = Vector3::Zero();              ///< m
  double stiffness = 0.0;                        ///< N/m, >= 0
};

/// A body with external forces on its nodes and a tether. Both are inputs, not state.
class TakesForces {
 public:
  virtual ~TakesForces() = default;
  /// (n, 3) N: dead loads in addition to gravity; zero unless set. Forces on fixed nodes do not
  /// affect the motion.
  virtual Points& external_forces() = 0;
  virtual const Points& external_forces() const = 0;
  /// Sets the tether from the next step on; none removes it.
  /// @param tether see Tether. Throws Error: index-out-of-range (node), out-of-range (weights,
  ///   stiffness), not-finite, bad-argument (nodes that do not share an element).
  virtual void set_tether(const std::optional<Tether>& tether) = 0;
  virtual const std::optional<Tether>& tether() const = 0;
  /// Current position of the point that the tether holds, (3,) m. Only if there is a tether.
  virtual Vector3 tether_point() const = 0;
};

/// A body with a base: nodes with a prescribed motion, or a rigid body that is fixed.
class HasBase {
 public:
  virtual ~HasBase() = default;
  /// Whether there is a base that can be moved.
  virtual bool base_can_move() const = 0;
  /// Requests a displacement from rest, which the base takes when the next step begins. None: it
  /// stays. An input.
  virtual void move_base(const std::optional<AffineField>& displacement) = 0;
  virtual const std::optional<AffineField>& base_input() const = 0;

  /// The part of a site that is fixed to the base: its motion in the last step, m or rad, and its
  /// velocity at the end, m/s or rad/s, both (3,). Of a mean of several nodes, the share of the
  /// fixed ones.
  struct Carried {
    Vector3 motion = Vector3::Zero(), velocity = Vector3::Zero();
  };
  /// Whether the base moved in the last step.
  virtual bool base_moved() const = 0;
  /// @param site number on the body. @param patch of a SurfaceSite; null for other sites.
  virtual Carried carried(int site, const Patch* patch) const = 0;
};

/// A body model that may have a base.
class MayHaveBase {
 public:
  virtual ~MayHaveBase() = default;
  /// Whether part of the body, or all of it, is fixed and follows a prescribed motion.
  virtual bool has_base() const = 0;
};

/// A body whose stiffness can be scaled.
class ScalesStiffness {
 public:
  virtual ~ScalesStiffness() = default;
  /// Factor of the stresses of its elements at a given strain, and thus of their stiffness damping.
  /// It does not scale membranes. Like external forces, it is an input and not part of the state;
  /// it is 1 initially.
  virtual double stiffness_factor() const = 0;
  /// Does not count the jump of the strain energy; sim::Simulation::set_stiffness_factor() does.
  /// @param factor > 0, finite.
  virtual void set_stiffness_factor(double factor) = 0;
};

/// A body with the loads of its model.
class TakesLoads {
 public:
  virtual ~TakesLoads() = default;
  /// Sets the factor of a load; 1 unless set. An input. @param load its number on the body.
  /// @param factor multiplies the load; of either sign.
  virtual void set_load_factor(int load, double factor) = 0;
  /// (3,) N: sum of the forces of the loads, from the last linearisation.
  virtual Vector3 load_force() const = 0;
};

/// A body model with rigid parts, such as the sections of an arm.
class AttachesOrientations {
 public:
  virtual ~AttachesOrientations() = default;
  /// Attaches the rotation of the part that contains a point. Building only.
  /// @param rest_position,outside,what as for BodyModel::attach().
  /// @return the number of the site. Throws Error(point-outside-mesh).
  virtual int attach_orientation(const Vector3& rest_position, mesh::Outside outside,
                                 const std::string& what) = 0;
};

/// A body of such a model.
class HasOrientations {
 public:
  virtual ~HasOrientations() = default;
  /// Rotation of an attached orientation relative to rest.
  virtual Matrix3 rotation(int orientation) const = 0;
};

/// A point mass that is attached to a body.
struct AttachedMass {
  std::string name;
  int site = -1;      ///< attached point
  double mass = 0.0;  ///< kg
  Location place;     ///< for error messages
};

/// A body model that carries point masses.
class CarriesMasses {
 public:
  virtual ~CarriesMasses() = default;
  virtual std::vector<AttachedMass> point_masses() const = 0;
};

/// Nodes and weights of an attached point: x = sum weights x_node.
struct Attachment {
  std::vector<NodeId> nodes;
  std::vector<double> weights;
};

/// A body model whose motion is that of the nodes of its mesh. Parts of the mesh that are joined at
/// nodes or edges only may move without deforming.
class MovesByNodes {
 public:
  virtual ~MovesByNodes() = default;
  /// Coordinates of nodes that do not move; repeats are allowed.
  virtual std::vector<mesh::HeldAxis> held_axes() const = 0;
  /// Nodes and weights of an attached point; none for a site that is no point.
  virtual const Attachment& attachment(int point) const = 0;
  /// Nodes and weights of any point, without attaching it. Throws as BodyModel::attach() does.
  virtual mesh::EmbeddedPoint locate(const Vector3& rest_position, mesh::Outside outside,
                                     const std::string& what) const = 0;
};

/// A body model with a surface of triangles. Their nodes need not be those of BodyModel::mesh().
class HasSurface {
 public:
  virtual ~HasSurface() = default;
  /// Attaches the whole surface as one site (SurfaceSite). Building only. @return its number.
  virtual int attach_surface() = 0;
  /// The triangles, oriented outwards. Quadratic faces are split into four triangles at the middle
  /// nodes. After attach_surface().
  virtual std::shared_ptr<const collision::SurfaceTopology> surface() const = 0;
  /// Interpolation of the nodes at points of these triangles. After attach_surface().
  virtual std::shared_ptr<const SurfaceTrace> surface_trace() const = 0;
  /// (n, 3) m: rest positions of the surface nodes. After attach_surface().
  virtual const Points& rest_surface_nodes() const = 0;
  /// Whether the motion of a node is prescribed, so that forces do not move it.
  virtual bool holds(NodeId node) const = 0;
};

/// A body of such a model.
class HasSurfaceNodes {
 public:
  virtual ~HasSurfaceNodes() = default;
  virtual const Points& surface_nodes() const = 0;            ///< (n, 3) m
  virtual const Points& surface_node_velocities() const = 0;  ///< (n, 3) m/s
};

/// Geometry by which a rigid body touches others: its shape, its convex hull or its triangles.
enum class TouchingPart { shape, hull, surface };

/// The model of a rigid body.
class HasShape {
 public:
  virtual ~HasShape() = default;
  virtual Vector3 rest_origin() const = 0;  ///< (3,) m, origin of its own frame at rest
  /// Signed distance, m, from a point (3,) m to the surface at rest: negative inside.
  virtual double rest_distance(const Vector3& point) const = 0;
  virtual double mass() const = 0;                  ///< kg
  virtual Vector3 own_centre() const = 0;           ///< (3,) m, centre of mass in its own frame
  virtual Vector3 rest_centre_of_mass() const = 0;  ///< (3,) m
  /// (3, 3) kg m^2, inertia about the centre of mass, in its own axes.
  virtual Matrix3 own_inertia() const = 0;
  virtual const char* shape_name() const = 0;  ///< "box", "sphere", ..., "mesh"
  virtual TouchingPart touching_part() const = 0;
  /// Radius of a sphere or capsule, m; 0 for shapes with edges or corners, and for meshes.
  virtual double touching_radius() const = 0;
  /// The touching shape or hull at rest, in world axes. For a surface, its hull, which touches
  /// planes in the same points.
  virtual collision::Shape rest_shape() const = 0;
};

/// A body of such a model.
class HasPose {
 public:
  virtual ~HasPose() = default;
  virtual Vector3 origin() const = 0;            ///< (3,) m, origin of its own frame
  virtual Vector3 centre_of_mass() const = 0;    ///< (3,) m
  virtual Matrix3 axes() const = 0;              ///< columns: axes of its own frame, in the world
  virtual Vector3 linear_velocity() const = 0;   ///< (3,) m/s, of the centre of mass
  virtual Vector3 angular_velocity() const = 0;  ///< (3,) rad/s, in world axes
  /// (3,) N m: moment of its loads about its centre of mass, from the last linearisation.
  virtual Vector3 load_moment() const = 0;
  /// Writes the state of the body with another pose, at zero velocity.
  /// @param origin (3,) m. @param axes unit quaternion.
  /// @param state (state_size(),) see Body::save_state().
  virtual void put_pose(const Vector3& origin, const Eigen::Quaterniond& axes,
                        std::span<double> state) const = 0;
};

/// A body with a few generalised coordinates that users can read and set.
class HasCoordinates {
 public:
  virtual ~HasCoordinates() = default;
  /// Value of an attached coordinate, rad or m. @param site its number.
  virtual double coordinate(int site) const = 0;
  virtual const VectorX& coordinates() const = 0;  ///< (coordinates,) rad; m for extensions
  virtual const VectorX& rates() const = 0;        ///< (coordinates,) rad/s or m/s
  /// Sets coordinates and rates. @param q,rate (coordinates,). Throws Error(wrong-shape).
  virtual void set_coordinates(const VectorX& q, const VectorX& rate) = 0;
};

}  // namespace sinew::mechanics
