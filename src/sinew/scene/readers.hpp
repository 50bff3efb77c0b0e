/// @file
/// Parts of the parser, one for each part of a scene; internal to this folder. Each takes a node
/// that check_scene() accepted.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sinew/scene/description.hpp"
#include "sinew/scene/fields.hpp"
#include "sinew/scene/node.hpp"
#include "sinew/scene/scene.hpp"

namespace sinew::scene {

/// What relative paths are relative to, and whether files are opened.
struct ReadContext {
  std::filesystem::path base_dir;
  Files files = Files::check;

  /// The path under `key` of the fields, made absolute or relative to the working folder. Throws
  /// Error(file-not-found) at its place when it is no readable file and files are checked.
  std::filesystem::path path(const Fields& fields, std::string_view key) const;
};

BodyDescription read_body(const Node::Entry& entry, const ReadContext& context);
/// What a body of type pcc is. @param fields of it. @param name of the body.
pcc::ArmSettings read_arm(const Fields& fields, const std::string& name);
/// What a body of type rigid is. @param fields of it. @param name of the body.
rigid::RigidSettings read_rigid(const Fields& fields, const std::string& name);
/// What a body of type urdf is. @param fields of it. @param context of the scene.
UrdfDescription read_urdf(const Fields& fields, const ReadContext& context);
/// The rotation of a pose. @param pose its fields.
Matrix3 read_rotation(const Fields& pose);
/// The region that one of the keys box, sphere, plane and set gives.
FixedRegion read_region(const Fields& fields);
ActuatorDescription read_actuator(const Node::Entry& entry, const ReadContext& context);
MassDescription read_hung_mass(const Node::Entry& entry);
MembraneDescription read_membrane(const Node::Entry& entry, const ReadContext& context);
LoadDescription read_load(const Node::Entry& entry, const ReadContext& context);
/// The surface that the keys of the surface table give.
void read_surface(const Fields& fields, SurfaceDescription& surface, const ReadContext& context);
EffectorDescription read_effector(const Node::Entry& entry, const ReadContext& context);
ContactDescription read_contact(const Node::Entry& entry, const ReadContext& context);
JointDescription read_joint(const Node::Entry& entry, const ReadContext& context);
/// A motion over time. @param fields of its map. @param context of the scene.
sim::BaseMotion read_motion(const Fields& fields, const ReadContext& context);
ProbeDescription read_probe(const Node::Entry& entry, const ReadContext& context);
SensorDescription read_sensor(const Node::Entry& entry, const ReadContext& context);
EstimatorDescription read_estimator(const Node::Entry& entry);
/// The samples under `file`; null without, and when files are not opened.
/// @param fields of the sensor. @param sensor read so far: its name, rate and delay.
/// @param numbers names of its components: "x", "y", "z"; empty for its only one.
/// @param context of the scene. Throws Error: wrong-columns, non-monotonic-time, not-finite,
/// malformed-table and bad-signal (a gap) with the line.
std::shared_ptr<const sim::SensorRecord> read_sensor_record(const Fields& fields,
                                                            const SensorDescription& sensor,
                                                            const std::vector<std::string>& numbers,
                                                            const ReadContext& context);
/// A unit vector, or the axis that x, y or z names. @param node,forms what is read, as one of
/// these.
Vector3 read_axis(const Node& node, const std::vector<Form>& forms);
/// Knows the effectors, which say how many weights and what kind of target there may be.
ControllerDescription read_controller(const Node::Entry& entry, const ReadContext& context,
                                      const SceneDescription& scene);

/// The sensors and gains of a closed loop. @param fields of it. @param scene with bodies,
/// actuators, effectors, sensors, contacts and joints. @param controller read so far: its tasks and
/// actuators.
void read_feedback(const Fields& fields, const SceneDescription& scene,
                   ControllerDescription& controller);

/// The signal under `key`: a value, or a map of the signal table.
sim::Signal read_signal(const Fields& fields, std::string_view key, const ReadContext& context);

/// The points under `key`: a list of vectors, or a CSV table.
PointList read_points(const Fields& fields, std::string_view key, const ReadContext& context);

/// A CSV table of time and `columns` values, the values times `unit`.
struct TimeTable {
  std::vector<double> times;                                                      ///< (n,) s
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;  ///< (n, columns)
};
/// Reads the CSV under `file` with the unit under `unit`; empty when files are not opened. With one
/// value and a name under `column`, of which column: its unit is the heading's where `unit` is left
/// out.
TimeTable read_time_table(const Fields& fields, int columns, const ReadContext& context);

/// The value of `make()`; an Error without a place gets `place`.
template <typename Make>
auto at_place(const Location& place, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw error.at(place);
  }
}

}  // namespace sinew::scene
