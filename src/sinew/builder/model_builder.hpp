/// @file
/// Builds a Model: first its bodies, then what acts on them, then the factorisation.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/step_settings.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::builder {

struct CableSettings;
struct ChamberSettings;
struct ContactSettings;
struct EffectorSettings;
struct ForceSettings;
struct LoadSettings;
struct ProbeSettings;
struct SpringLineSettings;
struct TorqueSettings;
struct JointSettings;
struct MotorSettings;
struct WeldSettings;

/// Collects the parts of a Model. The settings types are declared in headers of their own, such as
/// cable_settings.hpp.
class ModelBuilder {
 public:
  explicit ModelBuilder(model::StepSettings settings = {});

  /// All add functions return the index of the new part. Names are unique within their kind:
  /// Error(duplicate-key). This one throws Error(missing-mass) for dynamics without inertia.
  /// @param body of any kind. @param place source location of the body, for errors.
  int add_body(std::unique_ptr<mechanics::BodyModel> body, const Location& place = {});
  /// Makes a body and adds it: add_body<fem::FemBodyModel>(settings). Throws as its constructor
  /// does. @param settings of the body. @param place source location of the body, for errors.
  template <class Kind, class Settings>
  int add_body(Settings settings, const Location& place = {}) {
    return add_body(std::make_unique<Kind>(std::move(settings)), place);
  }
  /// Throws Error: too-few-points, degenerate-cable, point-outside-mesh, contradictory-limits,
  /// out-of-range (friction, tension).
  int add_cable(const CableSettings& settings);
  int add_force(const ForceSettings& settings);
  /// Throws Error: wrong-type (no arm), index-out-of-range (segment), unknown-choice (towards).
  int add_torque(const TorqueSettings& settings);
  /// Throws Error: surface-not-closed, zero-volume, point-outside-mesh, contradictory-limits,
  /// out-of-range, conflicting-keys (gas and liquid).
  int add_chamber(const ChamberSettings& settings);
  /// Gives a body another name: that of a link which is part of it.
  /// @param name the other name. @param body index, or kWorld.
  void name_body(const std::string& name, int body);
  /// Prescribes the motion of a body's fixed nodes. Throws Error: nothing-fixed, out-of-range (axis
  /// without length), wrong-type.
  void add_base_motion(const model::BaseMotion& motion, const Location& place);
  /// Throws Error: point-outside-mesh, too-few-points, zero-volume, out-of-range, wrong-type.
  int add_load(const LoadSettings& settings);
  /// Throws as add_cable() does, and Error(out-of-range).
  int add_spring(const SpringLineSettings& settings);
  int add_effector(const EffectorSettings& settings);
  /// Throws Error: too-few-points, point-outside-mesh, out-of-range (friction, radius, normal, a
  /// point inside the surface at the start), wrong-type (nodes of a body that has none),
  /// conflicting-keys (restitution or zones where they do not apply).
  int add_contact(const ContactSettings& settings);
  /// Throws Error: too-few-points, point-outside-mesh, bad-argument (a body welded to itself),
  /// wrong-type (nodes of a body that has none).
  int add_weld(const WeldSettings& settings);
  /// Throws Error: point-outside-mesh, bad-argument (a body and itself, the world twice),
  /// wrong-type (parts that are not rigid), out-of-range (axes, friction), contradictory-limits.
  int add_joint(const JointSettings& settings);
  /// Throws Error: unknown-name (no such joint), wrong-type (a joint that a motor cannot move),
  /// contradictory-limits.
  int add_motor(const MotorSettings& settings);
  /// Throws Error: too-few-points, empty-region, point-outside-mesh, degenerate-orientation.
  int add_probe(const ProbeSettings& settings);
  /// Returns the model; the builder is empty afterwards.
  /// Throws Error(nothing-fixed) if the integrator is quasi-static and neither fixed nodes nor
  /// joints prevent a rigid motion of some body, Error(out-of-range) for a time step that is not
  /// positive, Error(missing-mass) for dynamics without mass.
  std::shared_ptr<const model::Model> build();

  /// The parts so far, for functions that add parts of further kinds, such as add_sensor().
  model::ModelData& data() { return data_; }
  /// A body that was added, by index.
  const mechanics::BodyModel& added_body(int index) const { return data_.body(index); }

 private:
  model::ModelData data_;
  std::vector<Location> places_;  // (bodies,) where each is written
};

}  // namespace sinew::builder
