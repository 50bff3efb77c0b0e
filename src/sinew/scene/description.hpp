/// @file
/// What a scene file says, as plain structs in SI units. The parser fills them, the builder makes a
/// simulation of them. In-class defaults are the documented ones (a test holds them equal). Every
/// part keeps its Location, so that what is found wrong later (a point outside the mesh, an unknown
/// set) can still name file:line:column. Maps of the file are vectors here, in the file's order.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/constraint/joint_type.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/fem/mass_matrix.hpp"
#include "sinew/inverse/inverse_settings.hpp"
#include "sinew/inverse/target.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/material/elastic_constants.hpp"
#include "sinew/material/hyperelastic.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/rigid/rigid_settings.hpp"
#include "sinew/scene/node.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/base_motion.hpp"
#include "sinew/sim/cable_settings.hpp"
#include "sinew/sim/chamber_settings.hpp"
#include "sinew/sim/force_settings.hpp"
#include "sinew/sim/load_settings.hpp"
#include "sinew/sim/motor_settings.hpp"
#include "sinew/sim/sensor_model.hpp"
#include "sinew/sim/signal.hpp"
#include "sinew/sim/spring_line_settings.hpp"
#include "sinew/sim/step_settings.hpp"
#include "sinew/sim/torque_settings.hpp"

namespace sinew::scene {

using fem::MassMatrix;
using inverse::Regularisation;
using mechanics::Integrator;
using mechanics::Tangent;
using sim::Method;
enum class MaterialModel { linear, corotational, hyperelastic };
enum class Element { any, tet4, tet4_patch, tet10, hex8 };
enum class MassDistribution { volume, even };

/// How each step is solved.
struct SolverDescription {
  Location place;
  Method method = Method::newton;
  Tangent tangent = Tangent::exact;
  std::optional<sim::AdaptiveStep> adaptive;
  std::optional<double> tolerance;  ///< Newton: residual relative to the loads
  int max_iterations = 50;          ///< Newton
  double contact_tolerance = 1e-10;
  int threads = 1;                ///< inside a step
  std::string backend = "block";  ///< a name of linalg::backends()
  linalg::Ordering ordering = linalg::Ordering::fastest;
};

/// A mesh file, or one of the project's own shapes.
struct MeshDescription {
  Location place;
  std::filesystem::path file;  ///< resolved against the scene's folder; empty for a shape
  double unit = 1.0;           ///< m per unit of the file
  bool unit_given = false;     ///< whether the scene says what the unit is
  Location unit_place;
  Vector3 scale = Vector3::Ones();  ///< of a file's coordinates along x, y, z; none is 0
  std::string shape;                ///< "block", "cylinder", ...; empty for a file
  std::map<std::string, double>
      parameters;  ///< of the shape, those given only: m, or plain numbers
};

struct MaterialDescription {
  Location place;
  MaterialModel model = MaterialModel::corotational;
  material::Hyperelastic energy;  ///< when hyperelastic; the next two are then unused
  double young_modulus = 0.0;     ///< Pa
  double poisson_ratio = 0.0;
  double density = 0.0;  ///< kg/m^3 of a material of the library; else 0
  Location young_modulus_place, poisson_ratio_place;
};

/// Nodes that do not move.
struct FixedRegion {
  enum class Kind { box, sphere, plane, set };
  Location place;
  Kind kind = Kind::box;
  Vector3 lower = Vector3::Zero();             ///< box: m
  Vector3 upper = Vector3::Zero();             ///< box: m
  Vector3 point = Vector3::Zero();             ///< sphere: centre; plane: a point of it; m
  Vector3 normal = Vector3::UnitZ();           ///< plane: unit length
  double radius = 0.0;                         ///< sphere: m
  double within = 1e-6;                        ///< plane: m, nodes no farther from it are fixed
  std::string set;                             ///< set: its name in the mesh
  std::array<bool, 3> axes{true, true, true};  ///< held along x, y, z
};

/// How the free nodes of a body move at the start.
struct InitialVelocityDescription {
  Location place;
  Vector3 linear = Vector3::Zero();   ///< m/s, of the centre of mass
  Vector3 angular = Vector3::Zero();  ///< rad/s, about it
};

/// A robot in a URDF file, which expand_urdf() replaces by its bodies and joints.
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
  bool fixed = true;                       ///< the root link
  std::optional<double> density;           ///< kg/m^3, of links without `<inertial>`
  std::vector<Start> starts;
};

/// Elements of a body that are of another material.
struct PartDescription {
  std::string name;
  Location place;
  FixedRegion region;  ///< that has all their nodes
  MaterialDescription material;
  std::optional<double> density;  ///< kg/m^3; none: of the material, or of the body
};

struct BodyDescription {
  std::string name;
  Location place;
  std::optional<UrdfDescription> urdf;        ///< of type urdf; nothing below is then used
  std::optional<pcc::ArmSettings> arm;        ///< of type pcc; nothing below is then used
  bool convex = false;                        ///< of type rigid, a mesh: its hull touches
  std::optional<rigid::RigidSettings> rigid;  ///< of type rigid; likewise, but for a mesh file
  MeshDescription mesh;
  Vector3 position = Vector3::Zero();  ///< m, of the mesh's origin
  Vector3 rotation = Vector3::Zero();  ///< rad, a rotation vector about it
  Element element = Element::any;
  Location element_place;
  MaterialDescription material;
  std::vector<PartDescription> parts;
  std::optional<double> mass;     ///< kg, total; not together with density
  std::optional<double> density;  ///< kg/m^3
  Location mass_place;            ///< of whichever is given
  MassDistribution mass_distribution = MassDistribution::volume;  ///< with `mass`
  MassMatrix mass_matrix = MassMatrix::lumped;
  double mass_damping = 0.0;       ///< 1/s, Rayleigh: damping matrix = mass_damping M + ...
  double stiffness_damping = 0.0;  ///< s, ... + stiffness_damping K
  std::vector<FixedRegion> fixed;
  std::optional<sim::BaseMotion> base;  ///< of the fixed nodes; its body's number is not yet known
  Location base_place;
  std::optional<InitialVelocityDescription> initial_velocity;
};

/// (n, 3) m, each row with the place where it was written (a scene line or a line of a CSV).
struct PointList {
  Location place;
  Points points = Points(0, 3);
  std::vector<Location> places;
  std::vector<std::string> bodies;  ///< (n,) empty: that of the whole; or none at all
};

/// Where a pressure acts.
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

/// A cable, whose points' bodies are not yet numbered.
struct CableDescription {
  sim::CableSettings settings;
  Location points_place;
  std::vector<std::string> point_bodies;  ///< (n,) empty: the actuator's; or none at all
  bool guide_radius_given = false;
};

/// A chamber, whose surface is not yet known.
struct ChamberDescription {
  sim::ChamberSettings settings;
  SurfaceDescription surface;
};

/// A motor, whose joint is not yet numbered.
struct MotorDescription {
  sim::MotorSettings settings;
  std::string joint;
  Location joint_place;
};

struct ActuatorDescription {
  using Type = sim::ActuatorType;
  std::string name;
  Location place;
  Type type = Type::cable;
  std::string body;  ///< none: of a motor, which acts on a joint
  Location body_place;
  sim::Command command;  ///< left out: zero effort (slack) until told
  /// What is the type's own. The builder adds to its settings what all types have: name, place,
  /// body and command.
  std::variant<CableDescription, sim::ForceSettings, ChamberDescription, sim::SpringLineSettings,
               sim::TorqueSettings, MotorDescription>
      own;
};

/// What the surroundings do to a body.
struct LoadDescription {
  enum class Type { force, line, traction, acceleration, pressure, water };
  std::string name;
  Location place;
  Type type = Type::force;
  std::string body;
  Vector3 point = Vector3::Zero();   ///< force: m
  PointList points;                  ///< line
  Vector3 vector = Vector3::Zero();  ///< N, N/m, Pa or m/s^2, by type
  std::optional<SurfaceDescription> surface;
  mesh::Outside outside = mesh::Outside::error;
  sim::WaterSettings water;                         ///< its faces are not yet known
  sim::Signal factor = sim::Signal::constant(1.0);  ///< pressure: Pa
};

/// A thin layer on faces of a body.
struct MembraneDescription {
  std::string name;
  Location place;
  std::string body;
  Location body_place;
  SurfaceDescription surface;
  double thickness = 0.0;  ///< m, > 0
  material::ElasticConstants constants{.young_modulus = 0.0, .poisson_ratio = 0.3};
};

/// A mass that hangs on a point of a body.
struct MassDescription {
  std::string name;
  Location place;
  std::string body;
  Location body_place;
  Vector3 point = Vector3::Zero();  ///< m
  double mass = 0.0;                ///< kg, > 0
  mesh::Outside outside = mesh::Outside::error;
};

/// Something on the robot whose motion matters.
struct EffectorDescription {
  enum class Kind { point, points, set, orientation };
  std::string name;
  Location place;
  Kind kind = Kind::point;
  std::string body;
  Location body_place;
  PointList points;  ///< point: 1; points: their mean is meant; orientation: 3, or 1 of an arm
  std::string set;   ///< set: mean of the nodes of this set of the mesh
  Location set_place;
  mesh::Outside outside = mesh::Outside::error;
  /// (k, 3) unit vectors along which the motion matters, k = 1 .. 3; for an orientation always
  /// x, y, z, the components of the rotation vector.
  Points directions = Points(Matrix3::Identity());
};

/// Something that is measured and recorded, and acts on nothing.
struct ProbeDescription {
  enum class Kind { point, line, bend, distance, extent };
  /// Points, whose mean is meant, or a region's nodes.
  struct Part {
    Location place;
    std::string body;
    PointList points;
    std::optional<FixedRegion> region;  ///< none: `points`, or the whole body for an extent
  };
  std::string name;
  Location place;
  Kind kind = Kind::point;
  std::vector<Part> parts;         ///< bend, distance: 2; else 1
  int samples = 21;                ///< line
  std::optional<Vector3> about;    ///< bend: unit length
  Vector3 axis = Vector3::Zero();  ///< extent: unit length
  constraint::ExtentProbe::Way way = constraint::ExtentProbe::Way::along;
  mesh::Outside outside = mesh::Outside::error;
};

/// Something that is measured as a sensor would, and acts on nothing.
struct SensorDescription {
  std::string name;
  Location place, rate_place;
  std::string type;  ///< its word in scenes: "marker"
  std::string body, actuator, contact;
  PointList points;                   ///< marker, line; those that an orientation turns with
  std::optional<FixedRegion> region;  ///< set of a marker, patch of a contact
  std::string patch_body;             ///< empty: the first of the contact
  mesh::Outside outside = mesh::Outside::error;
  int samples = 21;              ///< of a line
  std::vector<double> places;    ///< curvature: m along the line
  double gauge = 0.0;            ///< curvature: m; 0: a tenth of the line
  std::optional<Vector3> about;  ///< curvature: unit length
  double resistance = 0.0;       ///< Ohm
  double gauge_factor = 0.0;     ///< of a resistance
  double loss_per_length = 0.0;  ///< attenuation: dB/m
  double loss_per_turn = 0.0;    ///< attenuation: dB/rad
  double permittivity = 1.0;     ///< relative
  std::array<SurfaceDescription, 2> electrodes;
  std::array<std::string, 2> electrode_bodies;  ///< empty: the sensor's
  double motor_constant = 0.0;                  ///< N m/A or N/A
  bool turns = true;                            ///< the constant is of a torque
  double radius = 0.0;                          ///< m, of a drum; 0: none
  double threshold = 0.0;                       ///< touch: N
  sim::ChannelSettings channel;
  std::shared_ptr<const sim::SensorRecord> record;  ///< of a file
};

/// A force from outside, the effort of an actuator or the stiffness of a body, to be found.
struct UnknownDescription {
  std::string name;
  Location place, where_place;
  std::string body;                 ///< that the force acts on, or whose stiffness it is
  Vector3 point = Vector3::Zero();  ///< m
  mesh::Outside outside = mesh::Outside::error;
  std::string actuator;       ///< whose effort it is
  std::string quantity;       ///< "pressure", "tension", "stiffness"; empty: a force
  bool command_known = true;  ///< see sim::Unknown
  double prior = 0.0;         ///< N or Pa, > 0; of the logarithm of a stiffness
  double walk = 0.0;          ///< over sqrt(s), >= 0

  bool is_force() const { return quantity.empty(); }
  bool is_stiffness() const { return quantity == "stiffness"; }
};

/// What concludes forces and efforts from sensors.
struct EstimatorDescription {
  std::string name;
  Location place;
  std::vector<std::string> sensors;
  std::vector<Location> sensor_places;
  std::vector<UnknownDescription> unknowns;
  std::vector<std::string> unknown_loads;
  bool inertia = true;  ///< whether its robot has the integrator of the scene
  int rank = 12;        ///< see sim::EstimatorModel
};

/// A surface that points of a body may touch, or two bodies.
struct ContactDescription {
  std::string name;
  Location place;
  std::string body;
  std::string other;  ///< that has the surface; empty: the surface below
  Location between_place;
  bool all = false;  ///< between all pairs, but:
  std::vector<std::pair<std::string, std::string>> except;
  constraint::SmoothSurface surface;
  std::optional<FixedRegion> nodes;  ///< of the outside; none, and no points: all of it
  PointList points;
  mesh::Outside outside = mesh::Outside::error;
  double friction = 0.0;                   ///< Coulomb's coefficient, >= 0
  std::optional<double> kinetic_friction;  ///< of points that slide; none: the same
  std::optional<double> restitution;       ///< 0 to 1; none: the integrator's
  double aggregate = 0.0;                  ///< m, of zones; 0: single points
  std::optional<sim::BaseMotion> motion;   ///< of the surface
};

/// What holds two bodies together, or a body to the world.
struct JointDescription {
  std::string name;
  Location place;
  constraint::JointType type = constraint::JointType::weld;
  std::string first, second;  ///< bodies, or kWorldName
  Location bodies_place;
  // all but a weld
  Vector3 point = Vector3::Zero();         ///< m
  Vector3 axis = Vector3::UnitZ();         ///< unit length
  Vector3 second_axis = Vector3::UnitX();  ///< of a universal joint
  sim::Limits angle, displacement;         ///< rad, m
  double friction = 0.0;                   ///< N m, N
  // weld
  std::optional<FixedRegion> region;  ///< of the first; none, and no points: where they touch
  PointList points;                   ///< of the first
  mesh::Outside outside = mesh::Outside::error;
};

/// In place of a body's name, where a joint may hold a body to the world.
inline constexpr std::string_view kWorldName = "world";

/// What a controller asks of one effector.
struct TaskDescription {
  std::string effector;
  Location place;
  inverse::Target target;               ///< m; for an orientation effector a rotation vector (rad)
  std::vector<double> weights = {1.0};  ///< one for all, or one per direction of the effector; >= 0
  int priority = 1;
};

/// What a controller asks of the forces of one contact.
struct ContactTaskDescription {
  std::string contact;
  Location place;
  inverse::ContactTask asked;  ///< its contact's number is not known yet
};

struct ControllerDescription {
  std::string name;
  Location place;
  std::optional<inverse::Feedback> feedback;  ///< of a closed loop; its sensors have no numbers yet
  std::vector<std::string> sensors;           ///< (tasks,) of a closed loop, what measures each
  std::vector<std::string> actuators;         ///< empty: all
  std::vector<Location> actuator_places;
  std::vector<TaskDescription> tasks;
  std::vector<ContactTaskDescription> contacts;
  Regularisation regularisation = Regularisation::change;
  std::optional<double> epsilon;  ///< relative weight of the regularisation; none: the engine's
};

struct RecordDescription {
  Location place;
  int every = 1;       ///< steps per record
  bool states = true;  ///< positions of all nodes, too
};

/// A whole scene.
struct SceneDescription {
  std::string name;  ///< file name without folder and extension, or what the caller said
  Location place;
  int version = 1;
  Vector3 gravity = Vector3::Zero();  ///< m/s^2
  Location gravity_place;
  double time_step = 0.01;  ///< s
  Integrator integrator = Integrator::quasi_static;
  double spectral_radius = 0.8;  ///< of generalized-alpha
  double restitution = 0.0;      ///< of event-driven integration
  SolverDescription solver;
  std::optional<double> duration;  ///< s
  std::vector<BodyDescription> bodies;
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
  Node tree;  ///< what this was read from, for to_yaml() and overrides

  /// `duration`, or else the end of the longest signal and target; 0 when there is neither.
  double run_duration() const;
};

}  // namespace sinew::scene
