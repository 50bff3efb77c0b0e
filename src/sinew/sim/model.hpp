/// @file
/// A whole robot and its surroundings, ready to run: what never changes, shared by simulations.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/cavity.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/point_force.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

/// How many linearisations a step takes.
enum class Method {
  one_linearisation,  ///< one linear solve a step, as real-time codes do; watched, not corrected
  newton,             ///< as many as the tolerance asks for: one where little changes
};

/// Smaller steps inside each time step where the integrator's error asks for them or a step fails.
struct AdaptiveStep {
  double tolerance = 1e-4;  ///< error of a step in any coordinate, relative to the robot's size
  double smallest = 0.0;    ///< s, > 0
};

/// A quasi-static step hands what is left of its residual to the next one, which takes it away: one
/// linearisation a step keeps a robot this near equilibrium while it moves at usual speeds.
inline constexpr double kQuasiStaticTolerance = 5e-3;
/// In dynamics a residual is an impulse that stays.
inline constexpr double kDynamicTolerance = 1e-8;

/// How each step is solved.
struct StepSettings {
  double time_step = 0.01;  ///< s, > 0
  mechanics::Integrator integrator = mechanics::Integrator::quasi_static;
  double spectral_radius = 0.8;  ///< of generalized-alpha, 0 to 1
  std::optional<AdaptiveStep> adaptive;
  Method method = Method::newton;
  /// The exact tangent comes with the geometric stiffness of all cables, without which it says
  /// little: a compressed robot's own tangent may be indefinite where the held robot is stable.
  /// Where it is indefinite for the held robot, too, the projected one takes its place.
  mechanics::Tangent tangent = mechanics::Tangent::exact;
  /// Newton: residual relative to the loads, and motion to the size. None: kQuasiStaticTolerance
  /// or kDynamicTolerance.
  std::optional<double> tolerance;
  int max_iterations = 50;  ///< Newton

  bool dynamic() const { return integrator != mechanics::Integrator::quasi_static; }
  double newton_tolerance() const {
    return tolerance.value_or(dynamic() ? kDynamicTolerance : kQuasiStaticTolerance);
  }
  double contact_tolerance = 1e-10;  ///< of the contacts' residual, see qp::ConeResult
};

/// A point that a cable slides through with friction.
struct GuideModel {
  int actuator = -1;    ///< whose cable
  int via = 0;          ///< point between the cable's ends, from the pull point on
  int row = -1;         ///< of H
  double friction = 0;  ///< Coulomb's coefficient, > 0
};

/// An effector and where it is declared.
struct EffectorModel {
  std::string name;
  Place place;
  int constraint = -1;
};

/// A motion given over time, from rest: of a body's fixed nodes or of a surface.
struct BaseMotion {
  int body = 0;                       ///< whose fixed nodes; a surface has none
  std::array<Signal, 3> translation;  ///< m, along x, y, z
  Signal angle;                       ///< rad
  Vector3 axis = Vector3::UnitZ();    ///< of the turn, unit length
  Vector3 centre = Vector3::Zero();   ///< of the turn, m

  /// (3,) m and (3,) rad at a time.
  Vector3 translation_at(double time) const {
    return {translation[0].value(time), translation[1].value(time), translation[2].value(time)};
  }
  Vector3 rotation_at(double time) const { return angle.value(time) * axis; }
};

/// Points that may touch a surface, and how the surface moves.
struct ContactModel {
  std::string name;
  Place place;
  int constraint = -1;               ///< a constraint::Contact
  std::optional<BaseMotion> motion;  ///< of the surface; none: it stands still

  /// Of the surface at a time.
  Eigen::Isometry3d pose(double time) const;
};

/// A mass that hangs on a point of a body.
struct MassModel {
  std::string name;
  int body = 0;
  int point = -1;     ///< attached, of the body
  double mass = 0.0;  ///< kg
};

/// A load on a body, and its factor over time.
struct LoadModel {
  std::string name;
  Place place;
  int body = 0;
  std::vector<int> numbers;  ///< in fem::FemBodyModel::loads()
  Signal factor;
};

/// Immutable; made by ModelBuilder. Several simulations and threads may share one.
class Model {
 public:
  const std::vector<std::unique_ptr<mechanics::BodyModel>>& bodies() const { return bodies_; }
  const std::vector<std::unique_ptr<constraint::Constraint>>& constraints() const {
    return constraints_;
  }
  const std::vector<ActuatorModel>& actuators() const { return actuators_; }
  /// Along each cable from its pull point on.
  const std::vector<GuideModel>& guides() const { return guides_; }
  /// Actuators and, after them, guides: rows that a law finds efforts for.
  std::size_t range_count() const { return actuators_.size() + guides_.size(); }
  const std::vector<EffectorModel>& effectors() const { return effectors_; }
  const std::vector<ContactModel>& contacts() const { return contacts_; }
  const std::vector<std::unique_ptr<constraint::Probe>>& probes() const { return probes_; }
  const mechanics::RowPattern& rows() const { return rows_; }
  const std::vector<mechanics::RowCurvature>& curvatures() const { return curvatures_; }
  const StepSettings& step() const { return step_; }
  const std::vector<BaseMotion>& base_motions() const { return base_motions_; }
  const std::vector<LoadModel>& loads() const { return loads_; }
  const std::vector<MassModel>& masses() const { return masses_; }
  /// Constraints whose curvature joins A in every step.
  const std::vector<int>& stiffening_constraints() const { return stiffening_; }
  /// Whether that needs blocks that the elements' pattern has not.
  bool stiffening_widens() const { return stiffening_widens_; }
  /// All constraints with curvature.
  const std::vector<int>& curved_constraints() const { return curved_; }

  /// Positions in the lists above. Throw Error(unknown-name) with a suggestion.
  int body_index(std::string_view name) const;
  int actuator_index(std::string_view name) const;
  int effector_index(std::string_view name) const;
  int contact_index(std::string_view name) const;
  int load_index(std::string_view name) const;
  int mass_index(std::string_view name) const;
  int probe_index(std::string_view name) const;

  const constraint::Effector& effector(int index) const;
  const constraint::Contact& contact(int index) const;
  /// The line of a cable or spring; null when an actuator has none.
  const constraint::Cable* cable(int actuator) const;
  /// The chamber of an actuator; null when it has none.
  const constraint::Cavity* cavity(int actuator) const;
  /// Numbers of all drives.
  int drive_states() const { return drive_states_; }
  /// A length of the robot's size, m: the largest diagonal of its bodies at rest.
  double size() const { return size_; }
  /// Tells models apart: a hash of meshes, materials, rows, contacts and settings. Saved
  /// states carry it.
  std::uint64_t fingerprint() const { return fingerprint_; }

 private:
  friend class ModelBuilder;

  std::vector<std::unique_ptr<mechanics::BodyModel>> bodies_;
  std::vector<std::unique_ptr<constraint::Constraint>> constraints_;
  std::vector<ActuatorModel> actuators_;
  std::vector<GuideModel> guides_;
  std::vector<EffectorModel> effectors_;
  std::vector<ContactModel> contacts_;
  std::vector<std::unique_ptr<constraint::Probe>> probes_;
  mechanics::RowPattern rows_;
  std::vector<mechanics::RowCurvature> curvatures_;
  std::vector<int> stiffening_, curved_;
  bool stiffening_widens_ = false;
  int drive_states_ = 0;
  StepSettings step_;
  std::vector<BaseMotion> base_motions_;
  std::vector<LoadModel> loads_;
  std::vector<MassModel> masses_;
  double size_ = 1.0;
  std::uint64_t fingerprint_ = 0;
};

}  // namespace sinew::sim
