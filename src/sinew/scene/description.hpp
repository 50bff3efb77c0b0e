/// @file
/// The contents of a scene file as plain structs in SI units. The parser fills them, and the
/// builder makes a simulation of them. In-class defaults are the documented ones (checked by a
/// test). Every part keeps its Location, so that errors found later (a point outside the mesh, an
/// unknown set) can still name file:line:column. Maps of the file are vectors here, in the file's
/// order.
#pragma once

#include <any>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/chamber_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/motor_settings.hpp"
#include "sinew/builder/spring_line_settings.hpp"
#include "sinew/builder/torque_settings.hpp"
#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/control/closed_loop_settings.hpp"
#include "sinew/control/inverse_settings.hpp"
#include "sinew/control/target.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"
#include "sinew/core/types.hpp"
#include "sinew/fem/mass_matrix.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/material/elastic_constants.hpp"
#include "sinew/material/hyperelastic.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/model/step_settings.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/rigid/rigid_settings.hpp"
#include "sinew/scene/node.hpp"
#include "sinew/sense/sensor_set.hpp"

namespace sinew::scene {

using fem::MassMatrix;
using mechanics::Integrator;
using mechanics::Tangent;
using model::Equilibrium;
using model::Method;
struct ActuatorKind;
struct BodyKind;
struct ControllerKind;
struct JointKind;
struct LoadKind;
struct ProbeKind;
struct SensorKind;

enum class MaterialModel { linear, corotational, hyperelastic };
enum class Element { any, tet4, tet4_patch, tet10, hex8 };
enum class MassDistribution { volume, even };

/// How a simulation solves its steps.
struct SolverDescription {
  Location place;
  Method method = Method::newton;
  Tangent tangent = Tangent::exact;
  std::optional<model::AdaptiveStep> adaptive;
  std::optional<Equilibrium> equilibrium;  ///< when quasi-static steps end
  std::optional<double> tolerance;         ///< of Newton's method: residual relative to the loads
  int max_iterations = 50;                 ///< of Newton's method
  double contact_tolerance = 1e-10;
  int threads = 1;                ///< inside a step
  std::string backend = "block";  ///< a name of linalg::backends()
  linalg::Ordering ordering = linalg::Ordering::fastest;
};

/// A mesh file, or a built-in shape.
struct MeshDescription {
  Location place;
  std::filesystem::path file;  ///< resolved against the scene's folder; empty for a shape
  double unit = 1.0;           ///< m per unit of the file
  bool unit_given = false;     ///< whether the scene states the unit
  Location unit_place;
  Vector3 scale = Vector3::Ones();  ///< of a file's coordinates along x, y, z; non-zero
  std::string shape;                ///< "block", "cylinder", ...; empty for a file
  std::map<std::string, double>
      parameters;  ///< of the shape, only those given: m, or dimensionless
};

struct MaterialDescription {
  Location place;
  MaterialModel model = MaterialModel::corotational;
  material::Hyperelastic energy;  ///< used if hyperelastic, in place of the next two
  double young_modulus = 0.0;     ///< Pa
  double poisson_ratio = 0.0;
  std::string library;   ///< its name, if it is from the library
  bool scaled = false;   ///< whether the scene scales its moduli
  double density = 0.0;  ///< kg/m^3, of a material from the library; else 0
  Location young_modulus_place, poisson_ratio_place;

  bool is_hyperelastic() const { return model == MaterialModel::hyperelastic; }
};

/// A choice of nodes, such as those that are fixed.
struct FixedRegion {
  enum class Kind { box, sphere, plane, set };
  Location place;
  Kind kind = Kind::box;
  Vector3 lower = Vector3::Zero();    ///< box: m
  Vector3 upper = Vector3::Zero();    ///< box: m
  Vector3 point = Vector3::Zero();    ///< sphere: centre; plane: a point of it; m
  Vector3 normal = Vector3::UnitZ();  ///< plane: unit length
  double radius = 0.0;                ///< sphere: m
  double within = 1e-6;               ///< plane: m, the distance up to which it selects nodes
  std::string set;                    ///< set: its name in the mesh
  std::array<bool, 3> axes{true, true, true};  ///< whether nodes are held along x, y, z
};

/// Initial velocity of the free nodes of a body.
struct InitialVelocityDescription {
  Location place;
  Vector3 linear = Vector3::Zero();   ///< m/s, of the centre of mass
  Vector3 angular = Vector3::Zero();  ///< rad/s, about the centre of mass
};

/// Settings of a kind of part, of the type that the kind reads.
struct OwnSettings {
  std::any own;

  /// The settings, if they are of this type; else null.
  template <class Own>
  const Own* as() const {
    return std::any_cast<Own>(&own);
  }
  template <class Own>
  Own* as() {
    return std::any_cast<Own>(&own);
  }
};

/// A robot in a URDF file. expand_urdf() replaces it by its bodies and joints.
struct UrdfDescription {
  struct Start {
    std::string joint;
    Location place;
    double value = 0.0;  ///< rad or m
    bool turns = true;
  };
  std::filesystem::path file;  ///< resolved against the scene's folder
  Location file_place;
  std::map<std::string, std::filesystem::path> packages;
  Vector3 position = Vector3::Zero();      ///< m, of the root link
  Matrix3 rotation = Matrix3::Identity();  ///< of its axes
  bool fixed = true;                       ///< whether the root link is fixed
  std::optional<double> density;           ///< kg/m^3, of links without `<inertial>`
  std::vector<Start> starts;
};

/// A part of a body that has a material of its own.
struct PartDescription {
  std::string name;
  Location place;
  FixedRegion region;  ///< contains all nodes of the part's elements
  MaterialDescription material;
  std::optional<double> density;  ///< kg/m^3; none: that of the material or the body
};

struct BodyDescription : OwnSettings {
  std::string name;
  Location place;
  const BodyKind* kind = nullptr;  ///< never null in a scene that was read
  // `own` has UrdfDescription, pcc::ArmSettings or rigid::RigidSettings. It is empty for type fem,
  // whose settings are the members below. Of those, rigid bodies use mesh, convex and motion.
  bool convex = false;  ///< rigid with a mesh: contacts use its hull
  MeshDescription mesh;
  Vector3 position = Vector3::Zero();  ///< m, of the origin of the mesh
  Vector3 rotation = Vector3::Zero();  ///< rad, rotation vector about that origin
  Element element = Element::any;
  Location element_place;
  MaterialDescription material;
  std::vector<PartDescription> parts;
  std::optional<double> mass;     ///< kg, total; not together with density
  std::optional<double> density;  ///< kg/m^3
  Location mass_place;            ///< of mass or density
  MassDistribution mass_distribution = MassDistribution::volume;  ///< with `mass`
  MassMatrix mass_matrix = MassMatrix::lumped;
  double mass_damping = 0.0;       ///< 1/s, Rayleigh: damping matrix = mass_damping M + ...
  double stiffness_damping = 0.0;  ///< s, ... + stiffness_damping K
  std::vector<FixedRegion> fixed;
  /// Of the fixed nodes, or of a rigid body; its body number is set later.
  std::optional<model::BaseMotion> motion;
  Location motion_place;
  std::optional<InitialVelocityDescription> velocity;
};

/// Points, each with the location where it was written (a line of the scene or of a CSV file).
struct PointList {
  Location place;
  Points points = Points(0, 3);  ///< (n, 3) m
  std::vector<Location> places;
  std::vector<std::string> bodies;  ///< (n,) or (0,); an empty name means the owner's body
};

/// The faces on which a load, chamber, membrane or electrode acts.
struct SurfaceDescription {
  enum class Kind { inside, patch, file, region };
  Location place;
  Kind kind = Kind::region;
  Vector3 point = Vector3::Zero();     ///< inside, patch: m
  double angle = 0.69813170079773179;  ///< patch: rad, 40 degrees
  std::filesystem::path file;          ///< file: resolved against the scene's folder
  double unit = 1.0;                   ///< file: m per unit
  FixedRegion region;                  ///< region
};

/// A cable. The bodies of its points are given by name and not yet by number.
struct CableDescription {
  builder::CableSettings settings;
  Location points_place;
  std::vector<std::string> point_bodies;  ///< (n,) or (0,); an empty name means the actuator's body
  bool guide_radius_given = false;
};

/// A chamber. Its surface is not yet resolved to faces.
struct ChamberDescription {
  builder::ChamberSettings settings;
  SurfaceDescription surface;
};

/// A motor. Its joint is given by name and not yet by number.
struct MotorDescription {
  builder::MotorSettings settings;
  std::string joint;
  Location joint_place;
};

struct ActuatorDescription : OwnSettings {
  std::string name;
  Location place;
  const ActuatorKind* kind = nullptr;  ///< never null in a scene that was read
  std::string body;                    ///< empty for a motor, which acts on a joint
  Location body_place;
  model::Command command;  ///< default: zero effort (slack)
  // Building adds to `own` what all kinds have: name, location, body and command.
};

/// A load that the environment exerts on a body.
struct LoadDescription : OwnSettings {
  std::string name;
  Location place;
  const LoadKind* kind = nullptr;  ///< never null in a scene that was read
  std::string body;
  mesh::Outside outside = mesh::Outside::error;         ///< for points outside the mesh
  model::Signal factor = model::Signal::constant(1.0);  ///< or its value, see LoadKind::signal
};

/// A thin elastic layer on faces of a body.
struct MembraneDescription {
  std::string name;
  Location place;
  std::string body;
  Location body_place;
  SurfaceDescription surface;
  double thickness = 0.0;  ///< m, > 0
  material::ElasticConstants constants{.young_modulus = 0.0, .poisson_ratio = 0.3};
};

/// A point mass attached to a body.
struct MassDescription {
  std::string name;
  Location place;
  std::string body;
  Location body_place;
  Vector3 point = Vector3::Zero();  ///< m
  double mass = 0.0;                ///< kg, > 0
  mesh::Outside outside = mesh::Outside::error;
};

/// A point or frame of the robot that controllers steer.
struct EffectorDescription {
  enum class Kind { point, points, set, orientation };
  std::string name;
  Location place;
  Kind kind = Kind::point;
  std::string body;
  Location body_place;
  PointList points;  ///< point: 1; points: their mean counts; orientation: 3, or 1 of an arm
  std::string set;   ///< set: the mean of the nodes of this mesh set counts
  Location set_place;
  mesh::Outside outside = mesh::Outside::error;
  /// (k, 3) unit vectors along which the motion counts, k = 1 .. 3. For an orientation they are
  /// always x, y, z, the components of the rotation vector.
  Points directions = Points(Matrix3::Identity());
};

/// A point of a body, the mean of several, or nodes of a region.
struct SpotDescription {
  Location place;
  std::string body;
  PointList points;
  std::optional<FixedRegion> region;  ///< none: `points`, or the whole body
};

/// A quantity that is computed and recorded exactly. It exerts no force.
struct ProbeDescription : OwnSettings {
  std::string name;
  Location place;
  const ProbeKind* kind = nullptr;     ///< never null in a scene that was read
  std::vector<SpotDescription> parts;  ///< what it measures, as many as its kind needs
  mesh::Outside outside = mesh::Outside::error;
};

/// A capacitive sensor. The bodies of its electrodes are SensorDescription::further_bodies.
struct CapacitanceDescription {
  std::array<SurfaceDescription, 2> electrodes;
  double permittivity = 1.0;  ///< relative
};

/// A sensor of contacts. The body of its patch is the first of SensorDescription::further_bodies;
/// without, it is the first body of the contact.
struct ContactSensorDescription {
  std::string contact;
  std::optional<FixedRegion> patch;
  std::optional<double> threshold;  ///< N, of a switch
};

/// A sensor with noise, delay and sample rate. It exerts no force.
struct SensorDescription : OwnSettings {
  std::string name;
  Location place, rate_place;
  const SensorKind* kind = nullptr;         ///< never null in a scene that was read
  std::string body, actuator;               ///< that it measures; empty: it has no such key
  std::vector<std::string> further_bodies;  ///< empty names mean `body`
  mesh::Outside outside = mesh::Outside::error;
  sense::ChannelSettings channel;
  std::shared_ptr<const sense::SensorRecord> record;  ///< samples from a file
};

/// An unknown of an estimator: an external force, the effort of an actuator, or the stiffness of a
/// body.
struct UnknownDescription {
  std::string name;
  Location place, where_place;
  std::string body;                 ///< on which the force acts, or whose stiffness it is
  Vector3 point = Vector3::Zero();  ///< m
  mesh::Outside outside = mesh::Outside::error;
  std::string actuator;       ///< whose effort it is
  std::string quantity;       ///< "pressure", "tension", "stiffness"; empty: a force
  bool command_known = true;  ///< see estimate::Unknown
  double prior = 0.0;         ///< N or Pa, > 0; of a stiffness, of the logarithm of its factor
  double walk = 0.0;          ///< the unit of the prior over sqrt(s), >= 0

  bool is_force() const { return quantity.empty(); }
  bool is_stiffness() const { return quantity == "stiffness"; }
};

/// An estimator of forces and efforts from sensor samples.
struct EstimatorDescription {
  std::string name;
  Location place;
  std::vector<std::string> sensors;
  std::vector<Location> sensor_places;
  std::vector<UnknownDescription> unknowns;
  std::vector<std::string> unknown_loads;
  bool inertia = true;  ///< whether its model has the scene's integrator; else it is quasi-static
  int rank = 12;        ///< see estimate::EstimatorModel
};

/// Contact of a body with an analytic surface, or contact between bodies.
struct ContactDescription {
  std::string name;
  Location place;
  std::string body;
  std::string other;  ///< second body; empty: contact with `surface`
  Location between_place;
  bool all = false;  ///< between all pairs of bodies, except those of `except`
  std::vector<std::pair<std::string, std::string>> except;
  constraint::SmoothSurface surface;
  std::vector<FixedRegion> nodes;  ///< outer nodes that may touch; none, and no points: all
  PointList points;
  mesh::Outside outside = mesh::Outside::error;
  double friction = 0.0;                    ///< Coulomb's coefficient, >= 0
  std::optional<double> kinetic_friction;   ///< of sliding points; none: `friction`
  std::optional<double> restitution;        ///< 0 to 1; none: that of the scene
  double aggregate = 0.0;                   ///< m, size of contact zones; 0: single points
  std::optional<model::BaseMotion> motion;  ///< of the surface
};

/// A body of type rigid whose shape is a plane. Only contacts can name it.
struct PlaneDescription {
  std::string name;
  Location place;
  constraint::Plane plane;                  ///< at the start
  std::optional<model::BaseMotion> motion;  ///< none: fixed
};

/// A joint between two bodies, or between a body and the world.
struct JointDescription : OwnSettings {
  std::string name;
  Location place;
  const JointKind* kind = nullptr;  ///< never null in a scene that was read
  std::string first, second;        ///< bodies, or kWorldName
  Location bodies_place;
};

/// A weld: what it holds of the first body.
struct WeldDescription {
  std::optional<FixedRegion> region;  ///< none, and no points: where both touch
  PointList points;
  mesh::Outside outside = mesh::Outside::error;
};

/// Stands for a body's name where a joint connects a body to the world.
inline constexpr std::string_view kWorldName = "world";

/// The target of one effector of a controller.
struct TaskDescription {
  std::string effector;
  Location place;
  control::Target target;               ///< m; for an orientation effector a rotation vector (rad)
  std::vector<double> weights = {1.0};  ///< (1,) or one per direction of the effector; >= 0
  int priority = 1;
};

/// The task of a controller for the forces of one contact.
struct ContactTaskDescription {
  std::string contact;
  Location place;
  control::ContactTask asked;  ///< its contact number is set later
};

/// An inverse controller. Its contacts are given by name and not yet by number.
struct InverseDescription {
  control::InverseSettings settings;
  std::vector<ContactTaskDescription> contacts;
};

/// A closed loop. Its sensors are given by name and not yet by number.
struct ClosedLoopDescription {
  control::ClosedLoopSettings settings;
  std::vector<std::string> sensors;  ///< (tasks,) sensor of each task
};

struct ControllerDescription : OwnSettings {
  std::string name;
  Location place;
  const ControllerKind* kind = nullptr;  ///< never null in a scene that was read
  std::vector<std::string> actuators;    ///< empty: all
  std::vector<Location> actuator_places;
  std::vector<TaskDescription> tasks;
};

struct RecordDescription {
  Location place;
  int every = 1;       ///< steps per record
  bool states = true;  ///< whether positions of all nodes are recorded
};

/// A whole scene.
struct SceneDescription {
  std::string name;  ///< file name without folder and extension, or the name given by the caller
  Location place;
  int version = 1;
  Vector3 gravity = Vector3::Zero();  ///< m/s^2
  Location gravity_place;
  double time_step = 0.01;  ///< s
  Integrator integrator = Integrator::quasi_static;
  Location integrator_place;
  double spectral_radius = 0.8;  ///< of generalized-alpha
  double restitution = 0.0;      ///< of event-driven integration
  SolverDescription solver;
  std::optional<double> duration;  ///< s
  std::vector<BodyDescription> bodies;
  /// Links ROBOT.LINK of URDF robots, and the body that each is part of; see expand_urdf().
  std::map<std::string, std::string> link_bodies;
  std::vector<PlaneDescription> planes;  ///< bodies in the scene, but not in the simulation
  std::vector<ActuatorDescription> actuators;
  std::vector<LoadDescription> loads;
  std::vector<MassDescription> masses;
  std::vector<MembraneDescription> membranes;
  std::vector<EffectorDescription> effectors;
  std::vector<ProbeDescription> probes;
  std::vector<SensorDescription> sensors;
  std::vector<EstimatorDescription> estimators;
  std::vector<ContactDescription> contacts;
  std::vector<JointDescription> joints;
  std::vector<ControllerDescription> controllers;
  RecordDescription record;
  std::vector<Notice> notices;  ///< about numbers of the scene
  Node tree;                    ///< tree that this was read from, for to_yaml() and overrides

  /// `duration`, or by default the end of the longest signal or target; 0 if there is none.
  double run_duration() const;
};

}  // namespace sinew::scene
