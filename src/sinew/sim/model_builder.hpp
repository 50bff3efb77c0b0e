/// @file
/// Puts a Model together: bodies, then what acts on them, then the plan.
#pragma once

#include <memory>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/sim/model_data.hpp"
#include "sinew/sim/step_settings.hpp"

namespace sinew::fem {
struct FemBodySettings;
}
namespace sinew::pcc {
struct ArmSettings;
}
namespace sinew::rigid {
struct RigidSettings;
}

namespace sinew::sim {

class Model;
struct CableSettings;
struct ChamberSettings;
struct ContactSettings;
struct EffectorSettings;
struct EstimatorSettings;
struct ForceSettings;
struct LoadSettings;
struct ProbeSettings;
struct SensorSettings;
struct SpringLineSettings;
struct TorqueSettings;
struct JointSettings;
struct MotorSettings;
struct WeldSettings;

/// What its functions take is declared in headers of their own, such as cable_settings.hpp.
class ModelBuilder {
 public:
  explicit ModelBuilder(StepSettings settings = {});

  /// All return the new part's position. Names are unique among their kind: Error(duplicate-key).
  /// Throws what fem::FemBodyModel does, and Error(missing-mass).
  /// @param settings of the body. @param place where it is written.
  int add_fem_body(fem::FemBodySettings settings, const Location& place = {});
  /// A constant-curvature arm. Throws what pcc::Arm does.
  int add_arm(pcc::ArmSettings settings);
  /// Throws what rigid::RigidBodyModel does. @param settings of the body. @param place where it is
  /// written.
  int add_rigid_body(rigid::RigidSettings settings, const Location& place = {});
  /// Throws Error: too-few-points, degenerate-cable, point-outside-mesh, contradictory-limits,
  /// out-of-range (friction, tension).
  int add_cable(const CableSettings& settings);
  int add_force(const ForceSettings& settings);
  /// Throws Error: wrong-type (no arm), index-out-of-range (segment), unknown-choice (towards).
  int add_torque(const TorqueSettings& settings);
  /// Throws Error: surface-not-closed, zero-volume, point-outside-mesh, contradictory-limits,
  /// out-of-range, conflicting-keys (gas and liquid).
  int add_chamber(const ChamberSettings& settings);
  /// Moves a body's fixed nodes. Throws Error: nothing-fixed, out-of-range (no axis), wrong-type.
  void add_base_motion(const BaseMotion& motion, const Location& place);
  /// Throws Error: point-outside-mesh, too-few-points, zero-volume, out-of-range, wrong-type.
  int add_load(const LoadSettings& settings);
  /// As add_cable(), and Error(out-of-range).
  int add_spring(const SpringLineSettings& settings);
  int add_effector(const EffectorSettings& settings);
  /// Throws Error: too-few-points, point-outside-mesh, out-of-range (friction, radius, normal, a
  /// point inside the surface at the start), wrong-type (nodes of a body without),
  /// conflicting-keys (restitution or zones where there are none).
  int add_contact(const ContactSettings& settings);
  /// Throws Error: too-few-points, point-outside-mesh, bad-argument (a body and itself), wrong-type
  /// (nodes of a body without).
  int add_weld(const WeldSettings& settings);
  /// Throws Error: point-outside-mesh, bad-argument (a body and itself, the world twice),
  /// wrong-type (parts that do not stay rigid), out-of-range (axes, friction),
  /// contradictory-limits.
  int add_joint(const JointSettings& settings);
  /// Throws Error: unknown-name (no such joint), wrong-type (a joint that a motor cannot move),
  /// contradictory-limits.
  int add_motor(const MotorSettings& settings);
  /// Throws Error: too-few-points, empty-region, point-outside-mesh, degenerate-orientation.
  int add_probe(const ProbeSettings& settings);
  /// After actuators and contacts. Throws Error: what its channel does, out-of-range (a rate that
  /// is no whole part of the steps', a place beyond its line), unknown-name, wrong-actuator-type,
  /// missing-key and conflicting-keys (the radius of a drum), wrong-length and
  /// degenerate-orientation, too-few-points, point-outside-mesh, empty-region, zero-volume.
  int add_sensor(const SensorSettings& settings);

  /// After sensors. Throws Error: unknown-name (a sensor), out-of-range (a sensor without noise, or
  /// with a delay of more than 100 steps).
  int add_estimator(const EstimatorSettings& settings);

  /// Plans and hands the model over; the builder is empty afterwards.
  /// @param settings of the factorisation.
  /// Throws Error(nothing-fixed) when the integrator is quasi-static and a body keeps a rigid
  /// motion that neither what is fixed of it nor a joint holds, Error(out-of-range) for a time step
  /// that is not positive, Error(missing-mass) for dynamics without mass.
  std::shared_ptr<const Model> build(const linalg::FactorisationSettings& settings = {});

  /// A body that was added.
  const mechanics::BodyModel& added_body(int index) const { return data_.body(index); }

 private:
  ModelData data_;
  std::vector<Location> places_;  // (bodies,) where each is written
};

}  // namespace sinew::sim
