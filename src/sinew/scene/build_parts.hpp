/// @file
/// The steps of build(), each implemented in a file of its own. Internal to this folder.
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
namespace sinew::builder {
class ModelBuilder;
struct ProbeSpot;
}  // namespace sinew::builder

namespace sinew::model {
class Model;
}

namespace sinew::scene {

struct Robot;

/// A body of the model.
struct BuiltBody {
  int number = 0;
  const mechanics::BodyModel* model = nullptr;  ///< null: the world
};
/// Finds a body by its name; kWorldName gives the world.
using BodyOf = std::function<BuiltBody(const std::string&)>;
/// Finds the number of a joint by its name.
using JointOf = std::function<int(const std::string&)>;

/// Whether a body is rigid: true for rigid bodies and for the world.
bool is_rigid(const BuiltBody& body);

/// Makes the mesh of a finite-element body, with the element type that the body names. By default,
/// files keep their elements and shapes get linear tetrahedra. If the material is hyperelastic,
/// quadratic tetrahedra replace linear ones, which are too stiff. Nodes of a file keep their
/// numbers; midside nodes follow them. Throws what make_mesh() throws.
mesh::Mesh make_body_mesh(const BodyDescription& body);

/// Transforms points from the frame of the body's mesh file to the world frame.
/// @param body whose `rotation` and `position` apply. @param points (n, 3) m.
void place_in_world(const BodyDescription& body, Points& points);

/// Throws Error(unsupported-element) if the mesh has other elements than the body asks for, or
/// elements that do not support its material. @param body,mesh the body, and its make_body_mesh().
void check_element(const BodyDescription& body, const mesh::Mesh& mesh);

/// Warning about parts of a mesh that can move without deforming, see mesh::loose_joints(). With
/// inertia, they swing; without, the step decides whether something else holds them.
/// @param place of the body in the scene. @param body with a mesh.
std::optional<Notice> loose_part_notice(const Location& place, const mechanics::BodyModel& body);

/// Notices about the laws of a body that are unstable at strains of robots, and remarks about those
/// of the library that are too soft at small strain.
std::vector<Notice> law_notices(const BodyDescription& body);

/// Notice about a cable whose point forces dent quadratic elements by a hundredth of the body's
/// size or more: a remark if the scene gives a guide radius of 0, else a warning.
/// @param actuator of type cable. @param body that it runs through.
std::optional<Notice> bare_points_notice(const ActuatorDescription& actuator,
                                         const mechanics::BodyModel& body);

/// Converts a region to the type of mesh/selection.hpp.
mesh::Region region_of(const FixedRegion& region);
/// The nodes in a region. Throws Error(empty-region) at its location.
/// @param region,mesh which nodes of which mesh.
std::vector<NodeId> nodes_of(const FixedRegion& region, const mesh::Mesh& mesh);
/// A spot on its body, with its points or nodes. @param spot of a scene. @param body_of finds
/// bodies.
builder::ProbeSpot spot_of(const SpotDescription& spot, const BodyOf& body_of);

/// The faces of the mesh that a surface selects. The surface may be of any kind except `file`.
/// Throws Error at the location of the surface.
std::vector<mesh::Face> faces_of(const SurfaceDescription& surface, const mesh::Mesh& mesh);

/// Replaces each URDF robot by its bodies ROBOT.LINK and joints ROBOT.JOINT. Where a link is merged
/// into another body, references to the link become references to that body. Motors without limits
/// get those of the file. Throws what parse_urdf() throws, and Error: unknown-name, file-not-found,
/// unknown-format (a mesh), missing-mass, contradictory-limits.
/// @return notices about parts of the files that have no effect.
std::vector<Notice> expand_urdf(SceneDescription& scene);

/// Makes the solid that a surface encloses. Throws Error(zero-volume) for a hull without volume.
/// @param surface of the solid. @param convex whether contacts use the convex hull.
rigid::Solid make_solid(mesh::Surface surface, bool convex);

/// The mesh of a finite-element body, shared with another model of the same body.
struct SharedMesh {
  std::shared_ptr<const mesh::Mesh> mesh;
  std::shared_ptr<const mesh::Embedder> embedder;  ///< of `mesh`
};
/// Shared meshes by the names of their bodies.
using SharedMeshes = std::map<std::string, SharedMesh>;

/// Builds a scene, reusing meshes that another model has already made and checked.
/// @param description the scene, with its URDF robots expanded (expand_urdf()).
/// @param shared meshes of finite-element bodies; the others are made.
Robot build(SceneDescription description, const SharedMeshes& shared);

/// Notices about bodies of linear elements that are stiffer than the same mesh in quadratic ones by
/// a tenth or more (element_stiffness.cpp), in the order of the bodies.
/// @param scene expanded. @param model of it. @param shared bodies whose meshes are not judged.
std::vector<Notice> locking_notices(const SceneDescription& scene, const model::Model& model,
                                    const SharedMeshes& shared);

/// Adds a body of a scene. @param builder,scene,body which. @param shared its mesh; null: makes the
/// mesh.
void add_body(builder::ModelBuilder& builder, const SceneDescription& scene,
              const BodyDescription& body, const SharedMesh* shared);

/// Adds an effector. @param builder that has the bodies. @param effector to be added.
/// @param body_of finds bodies.
void add_effector(builder::ModelBuilder& builder, const EffectorDescription& effector,
                  const BodyOf& body_of);

/// Adds a load. @param builder that has the bodies. @param load to be added.
/// @param body_of finds bodies.
void add_load(builder::ModelBuilder& builder, const LoadDescription& load, const BodyOf& body_of);

/// The pressure of water with a level on faces that it wets, all of them: without tension in their
/// wall, the fluid behind them has this pressure more than the air above the water.
/// @param scene with the loads. @param body,model the name of the body and the body itself.
/// @param faces of its mesh.
/// @return Pa, at the highest of the faces in the scene's pose, with the least factor of the load;
/// 0 where no water wets them.
double water_head(const SceneDescription& scene, const std::string& body,
                  const mechanics::BodyModel& model, const std::vector<mesh::Face>& faces);

/// A contact to be added.
struct SceneContact {
  ContactDescription contact;
  std::string entry;  ///< name under `contacts`; all pairs of a `between: all` share it
};
/// The contacts of a scene, with `between: all` replaced by its pairs of bodies. Throws Error:
/// conflicting-keys (a pair twice), not-in-this-version (a pair with an arm in `between: all`).
std::vector<SceneContact> contact_pairs(const SceneDescription& scene);
/// Adds a contact. @param builder that has the bodies. @param contact to be added.
/// @param body_of finds bodies.
/// @return a notice if the surface is so small that it may pass between the nodes that touch it.
std::optional<Notice> add_contact(builder::ModelBuilder& builder, const ContactDescription& contact,
                                  const BodyOf& body_of);

/// Adds a probe. @param builder that has the bodies. @param probe to be added.
/// @param body_of finds bodies.
void add_probe(builder::ModelBuilder& builder, const ProbeDescription& probe,
               const BodyOf& body_of);

struct SensorSite;
/// Adds a sensor. Throws Error: unknown-name (a contact, or an entry without pairs).
/// @param builder that has the bodies, actuators and contacts. @param site of the sensor.
void add_sensor(builder::ModelBuilder& builder, const SensorSite& site);

/// Builds the estimator's own model of the robot, and adds the estimator. Throws what build() of
/// that model throws, and Error: wrong-type and out-of-range (a sensor), everything-fixed (an
/// unknown that moves nothing), conflicting-keys (a sensor that responds to no unknown).
/// @param builder that has the sensors. @param scene of the estimator, after expand_urdf().
/// @param estimator to be added.
void add_estimator(builder::ModelBuilder& builder, const SceneDescription& scene,
                   const EstimatorDescription& estimator);

}  // namespace sinew::scene
