/// @file
/// Functions that add bodies and what acts on them to the data of a model, one per kind of part.
/// ModelBuilder, which calls them, documents their errors.
#pragma once

#include <memory>

namespace sinew {
struct Location;
}
namespace sinew::constraint {
class Constraint;
class Contact;
}  // namespace sinew::constraint
namespace sinew::mechanics {
class BodyModel;
}

namespace sinew::model {
struct ActuatorModel;
struct BaseMotion;
struct ModelData;
}  // namespace sinew::model

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

int add_body(model::ModelData& data, std::unique_ptr<mechanics::BodyModel> body);

/// @param data receives the actuator and its constraint.
/// @param actuator without the indices of constraint, row and first state, which are set here.
/// @param constraint whose first row is the actuator's. @param place source location.
/// Throws Error: duplicate-key, contradictory-limits, out-of-range (rate).
int add_actuator(model::ModelData& data, model::ActuatorModel actuator,
                 std::unique_ptr<constraint::Constraint> constraint, Location place);
int add_cable(model::ModelData& data, const CableSettings& settings);
int add_spring(model::ModelData& data, const SpringLineSettings& settings);
int add_force(model::ModelData& data, const ForceSettings& settings);
int add_torque(model::ModelData& data, const TorqueSettings& settings);
int add_chamber(model::ModelData& data, const ChamberSettings& settings);

void add_base_motion(model::ModelData& data, const model::BaseMotion& motion,
                     const Location& place);
int add_load(model::ModelData& data, const LoadSettings& settings);
int add_contact(model::ModelData& data, const ContactSettings& settings);
/// A contact between the surfaces of two deformable bodies. Throws Error: not-in-this-version (a
/// body without a surface), out-of-range (bodies overlap).
std::unique_ptr<constraint::Contact> make_surface_contact(model::ModelData& data,
                                                          const ContactSettings& settings);
int add_joint(model::ModelData& data, const JointSettings& settings);
int add_motor(model::ModelData& data, const MotorSettings& settings);
int add_weld(model::ModelData& data, const WeldSettings& settings);

int add_effector(model::ModelData& data, const EffectorSettings& settings);
int add_probe(model::ModelData& data, const ProbeSettings& settings);

}  // namespace sinew::builder
