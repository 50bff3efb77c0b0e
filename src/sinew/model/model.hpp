/// @file
/// A complete robot with its surroundings: the immutable data that simulations share.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/part_visitor.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/part_list.hpp"

namespace sinew::constraint {
class Cable;
class Chamber;
class Contact;
class Effector;
class Joint;
class Tie;
}  // namespace sinew::constraint

namespace sinew::model {

/// An immutable robot model, built by ModelBuilder. Simulations and threads may share it.
class Model {
 public:
  explicit Model(ModelData data);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  PartList<mechanics::BodyModel> bodies() const { return PartList(data_.bodies); }
  PartList<constraint::Constraint> constraints() const { return PartList(data_.constraints); }
  const std::vector<ActuatorModel>& actuators() const { return data_.actuators; }
  /// In the order of the cables, along each from its pull point.
  const std::vector<GuideModel>& guides() const { return data_.guides; }
  const std::vector<EffectorModel>& effectors() const { return data_.effectors; }
  const std::vector<ContactModel>& contacts() const { return data_.contacts; }
  const std::vector<JointModel>& joints() const { return data_.joints; }
  const std::vector<AnchorModel>& anchors() const { return data_.anchors; }
  /// Whether fixed nodes and joints leave a body free to move, which weight, cables, springs or
  /// contacts must then hold.
  bool is_loose() const { return data_.loose; }
  const std::vector<CouplingModel>& couplings() const { return data_.couplings; }
  PartList<constraint::Probe> probes() const { return PartList(data_.probes); }
  /// Sensors and estimators, in the order in which they observe.
  PartList<InstrumentModel> instruments() const { return PartList(data_.instruments); }
  const mechanics::RowPattern& rows() const { return data_.rows; }
  const std::vector<mechanics::StiffnessPair>& stiffness_pairs() const {
    return data_.stiffness_pairs;
  }
  const StepSettings& step() const { return data_.step; }
  /// Whether an error that a step leaves in its equation persists in the motion: true in dynamics
  /// and if a material has memory. Other quasi-static steps correct the error of the previous one.
  bool errors_last() const { return errors_last_; }
  const std::vector<BaseMotion>& base_motions() const { return data_.base_motions; }
  const std::vector<LoadModel>& loads() const { return data_.loads; }
  const std::vector<MassModel>& masses() const { return data_.masses; }
  const GeometricStiffnessModel& geometric_stiffness() const { return data_.geometric_stiffness; }

  /// Indices in the lists above. Throw Error(unknown-name) with a suggestion. The name of a link
  /// that is part of a body is a name of this body.
  int body_index(std::string_view name) const;
  int actuator_index(std::string_view name) const;
  int effector_index(std::string_view name) const;
  int contact_index(std::string_view name) const;
  int joint_index(std::string_view name) const;
  int load_index(std::string_view name) const;
  int mass_index(std::string_view name) const;
  int probe_index(std::string_view name) const;

  /// Further names of bodies: links that are part of them, with the index of the body, or kWorld.
  const std::map<std::string, int, std::less<>>& body_names() const { return data_.body_names; }

  /// Parts by index.
  const mechanics::BodyModel& body(int index) const;
  const constraint::Constraint& constraint(int index) const;
  const constraint::Probe& probe(int index) const;
  /// The instrument of a type; null if there is none.
  template <class T>
  const T* instrument() const {
    return data_.instrument<T>();
  }
  const constraint::Effector& effector(int index) const;
  const constraint::Contact& contact(int index) const;
  /// The constraint of a weld of points; null for other joints.
  const constraint::Tie* tie(int joint) const;
  /// The constraint of a joint between rigid parts; null for a weld of points.
  const constraint::Joint* joint(int joint) const;
  /// The path of a cable or spring; null if the actuator has none.
  const constraint::Cable* cable(int actuator) const;
  /// The chamber of an actuator; null if it has none.
  const constraint::Chamber* chamber(int actuator) const;
  /// Number of state variables of all drives.
  int drive_states() const { return data_.drive_states; }
  /// Characteristic length of the robot, m: the largest diagonal of its bodies at rest.
  double size() const { return data_.size; }
  /// Hashes of the parts that determine the motion, see list_parts(); saved states identify their
  /// model by them.
  const std::vector<NamedHash>& parts() const { return parts_; }
  /// The numbers among the data of these parts, with paths and units; see list_parameters(). Lists
  /// them anew at each call.
  std::vector<Parameter> parameters() const;
  /// Hash of parts().
  std::uint64_t fingerprint() const { return fingerprint_; }

 private:
  const ModelData data_;
  const bool errors_last_;
  const std::vector<NamedHash> parts_;
  const std::uint64_t fingerprint_;
};

}  // namespace sinew::model
