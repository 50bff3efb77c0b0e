/// @file
/// Parts of build() that have files of their own.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/core/notice.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/description.hpp"

namespace sinew::mechanics {
class BodyModel;
}
namespace sinew::mesh {
class Embedder;
}
namespace sinew::sim {
class ModelBuilder;
}  // namespace sinew::sim

namespace sinew::scene {

struct Robot;

/// A body of the model.
struct BuiltBody {
  int number = 0;
  const mechanics::BodyModel* model = nullptr;  ///< null: the world
};
/// By its name; kWorldName gives the world.
using BodyOf = std::function<BuiltBody(const std::string&)>;
/// The number of a joint, by its name.
using JointOf = std::function<int(const std::string&)>;

/// Whether all points of a body move as one: of rigid bodies and of the world.
bool is_rigid(const BuiltBody& body);

/// The mesh of a body of finite elements, in the element that it names. Without a name: what the
/// file holds, tetrahedra for shapes; but quadratic tetrahedra in place of linear ones that would
/// lock, where the material is hyperelastic with a Poisson's ratio above 0.4. A file's nodes keep
/// their numbers; middle nodes follow them.
/// Throws what make_mesh() does.
mesh::Mesh make_body_mesh(const BodyDescription& body);

/// Moves points of the frame of a body's mesh file to the world's. @param body whose `rotation` and
/// `position`. @param points (n, 3) m.
void place_in_world(const BodyDescription& body, Points& points);

/// Throws Error(unsupported-element) where the mesh is not what the body asks for, or its elements
/// do not take its material. @param body,mesh the body, and its make_body_mesh().
void check_element(const BodyDescription& body, const mesh::Mesh& mesh);

/// What to say about linear tetrahedra at a Poisson's ratio above 0.4: a remark where the scene
/// asks for them, else a warning. @param body,mesh the body, and its make_body_mesh().
std::optional<Notice> locking_notice(const BodyDescription& body, const mesh::Mesh& mesh);

/// What to say of a cable that pulls at bare points of quadratic elements so that they dent by a
/// hundredth of the body's size: a remark where the scene asks for it, else a warning.
/// @param actuator of type cable. @param body that it runs through.
std::optional<Notice> bare_points_notice(const ActuatorDescription& actuator,
                                         const mechanics::BodyModel& body);

/// The region as the mesh's selections know it.
mesh::Region region_of(const FixedRegion& region);

/// The faces of the mesh that a surface names, whatever but a file. Throws Error at its place.
std::vector<mesh::Face> faces_of(const SurfaceDescription& surface, const mesh::Mesh& mesh);

/// Replaces robots in URDF files by their bodies ROBOT.LINK and joints ROBOT.JOINT, and names that
/// stand for a link within another body by that body's. Motors without limits get those of the
/// file. Throws what parse_urdf() does, and Error: unknown-name, file-not-found, unknown-format (a
/// mesh), missing-mass, contradictory-limits. @return what the files say and the robots do not do.
std::vector<Notice> expand_urdf(SceneDescription& scene);

/// @param surface of it. @param convex whether its hull touches. Throws Error(zero-volume) for a
/// hull without volume.
rigid::Solid make_solid(mesh::Surface surface, bool convex);

/// The mesh of a body of finite elements as another model of the same body has it.
struct SharedMesh {
  std::shared_ptr<const mesh::Mesh> mesh;
  std::shared_ptr<const mesh::Embedder> embedder;  ///< of it
};
/// By the names of the bodies.
using SharedMeshes = std::map<std::string, SharedMesh>;

/// build() of a scene whose meshes another model has already made and checked.
/// @param description,shared the scene, without robots in files, and the meshes of its bodies of
/// finite elements; those that are not there are made.
Robot build(SceneDescription description, const SharedMeshes& shared);

/// Adds a body that its scene describes. @param shared its mesh; null: it is made. @return what a
/// user should know of it, once for each mesh that is made.
std::optional<Notice> add_body(sim::ModelBuilder& builder, const SceneDescription& scene,
                               const BodyDescription& body, const SharedMesh* shared);

/// @param builder that has the bodies. @param scene of the actuator. @param actuator to be added.
/// @param body_of,joint_of find what it acts on.
void add_actuator(sim::ModelBuilder& builder, const SceneDescription& scene,
                  const ActuatorDescription& actuator, const BodyOf& body_of,
                  const JointOf& joint_of);

/// @param builder that has the bodies. @param effector to be added. @param body_of finds bodies.
void add_effector(sim::ModelBuilder& builder, const EffectorDescription& effector,
                  const BodyOf& body_of);

/// @param builder that has the bodies. @param load to be added. @param body_of finds bodies.
void add_load(sim::ModelBuilder& builder, const LoadDescription& load, const BodyOf& body_of);

/// A contact to be added.
struct SceneContact {
  ContactDescription contact;
  std::string entry;  ///< under `contacts`; of `between: all` many have one
};
/// With `between: all` replaced by its pairs. Throws Error: conflicting-keys (a pair twice),
/// not-in-this-version (pairs of deformable bodies, arms without points).
std::vector<SceneContact> contact_pairs(const SceneDescription& scene);
/// @param builder that has the bodies. @param contact to be added. @param body_of finds bodies.
/// @return what nodes of a deformable body may miss.
std::optional<Notice> add_contact(sim::ModelBuilder& builder, const ContactDescription& contact,
                                  const BodyOf& body_of);

/// @param builder that has the bodies. @param joint to be added. @param body_of finds bodies.
/// @return its number.
int add_joint(sim::ModelBuilder& builder, const JointDescription& joint, const BodyOf& body_of);

/// @param builder that has the bodies. @param probe to be added. @param body_of finds bodies.
void add_probe(sim::ModelBuilder& builder, const ProbeDescription& probe, const BodyOf& body_of);

/// What sensors of a scene refer to.
struct SensorSurroundings {
  const SceneDescription& scene;
  const std::vector<SceneContact>& contacts;  ///< see contact_pairs()
  const BodyOf& body_of;
};
/// @param builder that has the bodies, actuators and contacts. @param surroundings of the sensor.
/// @param sensor to be added. Throws Error: unknown-name (a contact, or an entry without pairs).
void add_sensor(sim::ModelBuilder& builder, const SensorSurroundings& surroundings,
                const SensorDescription& sensor);

/// Builds the robot as the estimator knows it, and adds the estimator.
/// @param builder that has the sensors. @param scene of the estimator, without robots in files.
/// @param estimator to be added. Throws what build() does of that robot, and Error: wrong-type and
/// out-of-range (a sensor), everything-fixed (a point that cannot move), conflicting-keys (a sensor
/// that answers to no unknown).
void add_estimator(sim::ModelBuilder& builder, const SceneDescription& scene,
                   const EstimatorDescription& estimator);

}  // namespace sinew::scene
