/// @file
/// Puts a Model together: bodies, then what acts on them, then the plan.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/constraint/surface.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/sim/fluid_drive.hpp"
#include "sinew/sim/joint_settings.hpp"
#include "sinew/sim/load_settings.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/probe_settings.hpp"
#include "sinew/sim/spring_drive.hpp"
#include "sinew/sim/torque_settings.hpp"

namespace sinew {}

namespace sinew::sim {

/// A cable through points given by rest positions.
struct CableSettings {
  std::string name;
  Place place;
  int body = 0;
  Points points;                    ///< (n, 3) m, n >= 2; the first is the pull point
  std::vector<Place> point_places;  ///< (n,) where each was written; may be empty
  std::vector<int> point_bodies;    ///< (n,) whose material each is in; empty: all in `body`
  bool pull_from_world = true;      ///< the pull point is fixed to the world, else to the body
  mesh::Outside outside = mesh::Outside::error;
  Limits tension{.min = 0.0};  ///< N, min >= 0
  Limits displacement;         ///< m
  Command command;
  bool geometric_stiffness = true;  ///< in every step; solve_static always has it
  double friction = 0.0;            ///< Coulomb's coefficient at every point between its ends, >= 0
  /// m, >= 0: every point is the mean of a ball of this radius, such as a tube set into the
  /// material; 0: a bare point
  double guide_radius = 0.0;
  /// m: guides are set between the points, evenly and no farther apart, as along a conduit; 0: none
  double guide_spacing = 0.0;
};

/// A force along a fixed direction on a point.
struct ForceSettings {
  std::string name;
  Place place;
  int body = 0;
  Vector3 point = Vector3::Zero();  ///< m, at rest
  Vector3 direction = Vector3::UnitZ();
  mesh::Outside outside = mesh::Outside::error;
  Limits force;         ///< N
  Limits displacement;  ///< m
  Command command;
};

/// A chamber of a body under pressure.
struct CavitySettings {
  std::string name;
  Place place;
  int body = 0;
  /// Faces of the body's mesh as seen from the material, or a surface that the body carries along
  /// (its vertices are attached to the elements; either orientation).
  std::variant<std::vector<mesh::Face>, mesh::Surface> surface;
  mesh::Outside outside = mesh::Outside::error;  ///< for a surface's vertices
  bool cap = false;  ///< close openings by a lid without stiffness that passes its force to the rim
  bool load_stiffness = true;
  Limits pressure;       ///< Pa, above ambient
  Limits volume_growth;  ///< m^3
  Command command;
  /// What fills it; neither: the commanded pressure or growth of volume acts as it is.
  std::optional<GasSettings> gas;
  std::optional<LiquidSettings> liquid;
};

/// A spring, a tendon, or a shape-memory spring.
struct SpringLineSettings {
  std::string name;
  Place place;
  int body = 0;
  Points points;  ///< (n, 3) m; via points without friction between its ends
  std::vector<Place> point_places;
  bool pull_from_world = false;  ///< the first point is fixed to the world, else to the body
  mesh::Outside outside = mesh::Outside::error;
  std::variant<SpringSettings, SmaSettings> spring;
  bool free_at_rest = false;  ///< its free length is that at rest, whatever `spring` says
  Command command{CommandKind::effort, {}};
};

/// A point, the mean of several points or nodes, or an orientation by three points.
struct EffectorSettings {
  enum class Kind { points, nodes, orientation };
  std::string name;
  Place place;
  int body = 0;
  Kind kind = Kind::points;
  Points points;                    ///< (n, 3) m; their mean, or the three of an orientation
  std::vector<NodeId> nodes;        ///< kind nodes: their mean
  std::vector<Vector3> directions;  ///< empty: x, y, z
  mesh::Outside outside = mesh::Outside::error;
};

/// Points of a body that may touch a surface.
struct ContactSettings {
  std::string name;
  Place place;
  int body = 0;
  constraint::Surface surface;
  std::vector<NodeId> nodes;  ///< of the body's mesh; fixed ones are left out
  Points points;              ///< (n, 3) m, at rest; beside the nodes
  mesh::Outside outside = mesh::Outside::error;
  double friction = 0.0;             ///< Coulomb's coefficient, >= 0
  std::optional<BaseMotion> motion;  ///< of the surface
};

/// The mean of points given by position, as one attached point. @return its number.
/// @param body,points,outside (n, 3) m on it, at rest. @param what names it in messages.
/// @param place of what is declared. Throws Error: too-few-points, point-outside-mesh, wrong-type.
int attach_mean(mechanics::BodyModel& body, const Points& points, mesh::Outside outside,
                const std::string& what, const Place& place);

/// An axis of unit length. @param axis,place (3,), and where it was written. Throws
/// Error(out-of-range) for one without length.
Vector3 checked_axis(const Vector3& axis, const Place& place);

class ModelBuilder {
 public:
  explicit ModelBuilder(StepSettings settings = {});

  /// All return the new part's position. Names are unique among their kind: Error(duplicate-key).
  int add_body(std::unique_ptr<mechanics::BodyModel> body);
  /// Throws what fem::FemBodyModel does, and Error(missing-mass).
  /// @param place where it is written.
  int add_fem_body(fem::FemBodySettings settings, const Place& place = {});
  /// A constant-curvature arm. Throws what pcc::Arm does.
  int add_arm(pcc::ArmSettings settings);
  /// Throws Error: too-few-points, degenerate-cable, point-outside-mesh, contradictory-limits,
  /// out-of-range (friction, tension).
  int add_cable(const CableSettings& settings);
  int add_force(const ForceSettings& settings);
  /// Throws Error: wrong-type (no arm), index-out-of-range (segment), unknown-choice (towards).
  int add_torque(const TorqueSettings& settings);
  /// Throws Error: surface-not-closed, zero-volume, point-outside-mesh, contradictory-limits,
  /// out-of-range, conflicting-keys (gas and liquid).
  int add_cavity(const CavitySettings& settings);
  /// Moves a body's fixed nodes. Throws Error: nothing-fixed, out-of-range (no axis), wrong-type.
  void add_base_motion(const BaseMotion& motion, const Place& place);
  /// Throws Error: point-outside-mesh, too-few-points, zero-volume, out-of-range, wrong-type.
  int add_load(const LoadSettings& settings);
  /// As add_cable(), and Error(out-of-range).
  int add_spring(const SpringLineSettings& settings);
  int add_effector(const EffectorSettings& settings);
  /// Throws Error: too-few-points, point-outside-mesh, out-of-range (friction, radius, normal, a
  /// point inside the surface at the start), wrong-type (nodes of a body without),
  /// not-in-this-version (generalized-alpha).
  int add_contact(const ContactSettings& settings);
  /// Throws Error: too-few-points, point-outside-mesh, bad-argument (a body and itself), wrong-type
  /// (nodes of a body without).
  int add_weld(const WeldSettings& settings);
  /// Throws Error: too-few-points, empty-region, point-outside-mesh, degenerate-orientation.
  int add_probe(const ProbeSettings& settings);

  /// Plans and hands the model over; the builder is empty afterwards.
  /// @param settings of the factorisation.
  /// Throws Error(nothing-fixed) when the integrator is quasi-static and a body has no fixed node
  /// nor hangs, by welds that leave it no rigid motion, on bodies that have,
  /// Error(out-of-range) for a time step that is not positive, Error(missing-mass) for dynamics
  /// without mass.
  std::shared_ptr<const Model> build(const linalg::FactorisationSettings& settings = {});

  /// A body that was added.
  const mechanics::BodyModel& added_body(int index) const {
    return *model_->bodies_[static_cast<std::size_t>(index)];
  }

 private:
  mechanics::BodyModel& body(int index);
  void check_body(int index, const Place& place) const;
  void add_masses(const fem::FemBodyModel& body);
  void hold_bodies();
  [[noreturn]] void throw_loose(std::size_t body, bool welded) const;
  void add_anchors(int body);
  void add_couplings();
  fem::FemBodyModel& fem_body(int index, const Place& place, const char* what);
  void add_liquid_weight(const CavitySettings& settings);
  int add_actuator(ActuatorModel actuator, std::unique_ptr<constraint::Constraint> constraint);
  struct Line {
    const char* kind;           // "cable"
    Points points;              // (n, 3) m
    std::vector<Place> places;  // (n,) where each was written, or empty
    std::vector<int> bodies;    // (n,)
    bool from_world = false;
    mesh::Outside outside = mesh::Outside::error;
    bool friction = false;
    double guide_radius = 0.0;  // m
  };
  std::unique_ptr<constraint::Cable> make_line(const std::string& name, const Place& place,
                                               Line line);
  std::vector<int> bodies_of(const CableSettings& settings) const;

  std::unique_ptr<Model> model_;
  std::vector<char> held_;     // (bodies,) by itself
  std::vector<Place> places_;  // (bodies,)
};

}  // namespace sinew::sim
