/// @file
/// A whole robot and its surroundings, ready to run: what never changes, shared by simulations.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/error.hpp"
#include "sinew/core/named_hash.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/signal.hpp"
#include "sinew/sim/step_settings.hpp"

namespace sinew::constraint {
class Cable;
class Cavity;
class Constraint;
class Contact;
class Effector;
class Probe;
class Tie;
}  // namespace sinew::constraint

namespace sinew::mechanics {
class BodyModel;
}  // namespace sinew::mechanics

namespace sinew::sim {

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

/// What welds two bodies.
struct WeldModel {
  std::string name;
  Place place;
  int first = 0, second = 1;  ///< bodies
  int constraint = -1;        ///< a constraint::Tie
};

/// Springs that A has in statics so that it can be factorised, and that the robot has not: see
/// step::StiffnessBlock.
struct AnchorModel {
  int body = 0;
  int constraint = -1;     ///< three rows, along x, y and z of one point
  double stiffness = 0.0;  ///< N/m
};

/// Rows for the curvature of a cable between two bodies.
struct CouplingModel {
  int curvature = -1;   ///< in curvatures()
  int constraint = -1;  ///< a constraint::Coupling
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
  ~Model();
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const std::vector<std::unique_ptr<mechanics::BodyModel>>& bodies() const { return bodies_; }
  const std::vector<std::unique_ptr<constraint::Constraint>>& constraints() const {
    return constraints_;
  }
  const std::vector<ActuatorModel>& actuators() const { return actuators_; }
  /// Along each cable from its pull point on.
  const std::vector<GuideModel>& guides() const { return guides_; }
  const std::vector<EffectorModel>& effectors() const { return effectors_; }
  const std::vector<ContactModel>& contacts() const { return contacts_; }
  const std::vector<WeldModel>& welds() const { return welds_; }
  const std::vector<AnchorModel>& anchors() const { return anchors_; }
  const std::vector<CouplingModel>& couplings() const { return couplings_; }
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
  int weld_index(std::string_view name) const;
  int load_index(std::string_view name) const;
  int mass_index(std::string_view name) const;
  int probe_index(std::string_view name) const;

  const constraint::Effector& effector(int index) const;
  const constraint::Contact& contact(int index) const;
  const constraint::Tie& weld(int index) const;
  /// The line of a cable or spring; null when an actuator has none.
  const constraint::Cable* cable(int actuator) const;
  /// The chamber of an actuator; null when it has none.
  const constraint::Cavity* cavity(int actuator) const;
  /// Numbers of all drives.
  int drive_states() const { return drive_states_; }
  /// A length of the robot's size, m: the largest diagonal of its bodies at rest.
  double size() const { return size_; }
  /// See list_parts(): what saved states tell models apart by.
  const std::vector<NamedHash>& parts() const { return parts_; }
  /// A hash of them.
  std::uint64_t fingerprint() const { return fingerprint_; }

 private:
  friend class ModelBuilder;

  Model();

  std::vector<std::unique_ptr<mechanics::BodyModel>> bodies_;
  std::vector<std::unique_ptr<constraint::Constraint>> constraints_;
  std::vector<ActuatorModel> actuators_;
  std::vector<GuideModel> guides_;
  std::vector<EffectorModel> effectors_;
  std::vector<ContactModel> contacts_;
  std::vector<WeldModel> welds_;
  std::vector<AnchorModel> anchors_;
  std::vector<CouplingModel> couplings_;
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
  double size_ = 0.0;
  std::vector<NamedHash> parts_;
  std::uint64_t fingerprint_ = 0;
};

}  // namespace sinew::sim
