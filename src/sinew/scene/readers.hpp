/// @file
/// The readers of the parts of a scene. Each takes a node that check_scene() accepted. Internal to
/// this folder.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sinew/core/csv.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/fields.hpp"
#include "sinew/scene/node.hpp"
#include "sinew/scene/scene.hpp"

namespace sinew::scene {

/// The folder of relative paths, and whether files are opened.
struct ReadContext {
  std::filesystem::path base_dir;
  Files files = Files::check;

  /// The path under `key`, prefixed by base_dir if it is relative. If files are checked, throws
  /// Error(file-not-found) or, for anything but a regular file, Error(file-unreadable).
  std::filesystem::path path(const Fields& fields, std::string_view key) const;
};

BodyDescription read_body(const Node::Entry& entry, const ReadContext& context);
/// Throws Error(bad-argument) if a body has the name of the world.
void refuse_world(const Node::Entry& body);
/// Reads the mesh of a rigid body. @param fields of the key `mesh`. @param context of the scene.
MeshDescription read_mesh_file(const Fields& fields, const ReadContext& context);
/// Throws Error(conflicting-keys) if a body with a prescribed motion is to be free or has a
/// velocity.
/// @param fields of a body of type rigid.
void refuse_free(const Fields& fields);
/// Whether a body is of type rigid with a plane as its shape.
bool is_plane(const Node::Entry& body);
/// Reads such a body. Throws Error(conflicting-keys) if it has a mass or a velocity or is free.
PlaneDescription read_plane(const Node::Entry& entry, const ReadContext& context);
/// Reads the material under `material`. @param body fields with that key. @param context of the
/// scene.
MaterialDescription read_material(const Fields& body, const ReadContext& context);
/// Reads the rotation of a pose. @param pose fields of the pose.
Matrix3 read_rotation(const Fields& pose);
/// The same as a rotation vector, rad. @param pose fields of the pose.
Vector3 read_rotation_vector(const Fields& pose);
/// Reads a region from one of the keys box, sphere, plane and set.
FixedRegion read_region(const Fields& fields);
/// Reads one region or a list of them; empty without the key.
/// @param fields that may have the key. @param key of the regions.
std::vector<FixedRegion> read_regions(const Fields& fields, std::string_view key);
ActuatorDescription read_actuator(const Node::Entry& entry, const ReadContext& context);
MassDescription read_hung_mass(const Node::Entry& entry);
MembraneDescription read_membrane(const Node::Entry& entry, const ReadContext& context);
LoadDescription read_load(const Node::Entry& entry, const ReadContext& context);
/// Reads a surface from the keys of the surface table.
void read_surface(const Fields& fields, SurfaceDescription& surface, const ReadContext& context);
EffectorDescription read_effector(const Node::Entry& entry, const ReadContext& context);
ContactDescription read_contact(const Node::Entry& entry, const ReadContext& context);
JointDescription read_joint(const Node::Entry& entry, const ReadContext& context);
/// Reads a prescribed motion. @param fields of its map. @param context of the scene.
model::BaseMotion read_motion(const Fields& fields, const ReadContext& context);
ProbeDescription read_probe(const Node::Entry& entry, const ReadContext& context);
SensorDescription read_sensor(const Node::Entry& entry, const ReadContext& context);
EstimatorDescription read_estimator(const Node::Entry& entry);
/// Reads the samples of a sensor from its `file`; null if files are not opened. Throws Error:
/// wrong-columns, wrong-length, non-monotonic-time, not-finite, malformed-table and bad-signal (a
/// gap), the latter with the line.
/// @param fields of the sensor, with the key `file`. @param sensor whose name, rate and delay have
/// been read. @param numbers names of its components, such as "x", "y", "z"; empty for a scalar.
/// @param context of the scene.
std::shared_ptr<const sense::SensorRecord> read_sensor_record(
    const Fields& fields, const SensorDescription& sensor, const std::vector<std::string>& numbers,
    const ReadContext& context);
/// Reads an axis: the world axis x, y or z, or a vector, which is normalised.
/// @param node,forms the value, and the forms that it may have.
Vector3 read_axis(const Node& node, const std::vector<Form>& forms);
/// Reads a controller. @param entry of the controller. @param context of the scene. @param scene
/// with the effectors, which determine the size of weights and targets.
ControllerDescription read_controller(const Node::Entry& entry, const ReadContext& context,
                                      const SceneDescription& scene);

/// Reads the signal under `key`: a value, or a map of the signal table.
model::Signal read_signal(const Fields& fields, std::string_view key, const ReadContext& context);

/// Reads the points under `key`: a list of vectors, or a CSV table.
PointList read_points(const Fields& fields, std::string_view key, const ReadContext& context);
/// Reads the point under a key. @param fields that have it. @param key of a vector.
PointList read_point(const Fields& fields, std::string_view key);
/// Reads one of the keys point, points and set. @param fields of a map that has one.
/// @param context of the scene.
SpotDescription read_spot(const Fields& fields, const ReadContext& context);
/// Reads the key `outside`. @param fields that may have it. @param outside receives what happens to
/// points outside the mesh.
void read_outside(const Fields& fields, mesh::Outside& outside);

/// The unit (SI) of a column: that under `unit`, else that of its heading, else the SI unit. Throws
/// Error: conflicting-keys if they differ, and what heading_unit() throws.
/// @param fields of the map that names the file; the dimension is that of its key `unit`, and 1
/// without such a key. @param table,column of the file.
double column_unit(const Fields& fields, const Table& table, Eigen::Index column);
/// The unit (s) of a column of times. Throws what heading_unit() throws.
double time_unit(const Fields& fields, const Table& table, Eigen::Index column);

/// A CSV table of times and values in SI units.
struct TimeTable {
  std::vector<double> times;                                                      ///< (n,) s
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;  ///< (n, columns)
  bool unit_given = false;  ///< whether the scene or the headings have the unit of the values
};
/// Reads the CSV file under `file`, with the unit under `unit`. The result is empty if files are
/// not opened. If there is one value and the key `column`, reads the column of that name. Throws
/// Error: wrong-columns, non-monotonic-time, and what column_unit() and time_unit() throw.
/// @param fields of the table. @param columns number of values in a row, besides the time.
/// @param context of the scene.
TimeTable read_time_table(const Fields& fields, int columns, const ReadContext& context);

/// Returns `make()`. If that throws an Error without a location, the Error gets `place`.
template <typename Make>
auto at_place(const Location& place, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw error.at(place);
  }
}

}  // namespace sinew::scene
