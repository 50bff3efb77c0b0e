// Bodies of type rigid, and planes.
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/rigid/rigid_settings.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace {

rigid::Shape read_shape(const Fields& fields) {
  const auto number = [](const Fields& from, const char* key) {
    double value = 0.0;
    from.read(key, value);
    return value;
  };
  if (fields.find("sphere") != nullptr)
    return rigid::Sphere{number(fields.below("sphere"), "radius")};
  if (fields.find("capsule") != nullptr) {
    const Fields capsule = fields.below("capsule");
    return rigid::Capsule{number(capsule, "radius"), number(capsule, "length")};
  }
  if (fields.find("cylinder") != nullptr) {
    const Fields cylinder = fields.below("cylinder");
    return rigid::Cylinder{number(cylinder, "radius"), number(cylinder, "height")};
  }
  rigid::Box box{Vector3::Zero()};
  fields.read("box", box.edges);
  if ((box.edges.array() > 0.0).all()) return box;
  throw Error(ErrorKind::out_of_range, fields.place("box"), "an edge of the box is not positive",
              "give three lengths above zero");
}

rigid::RigidSettings read_rigid(const Fields& fields, const std::string& name) {
  rigid::RigidSettings body;
  body.name = name;
  if (fields.find("shape") != nullptr) body.shape = read_shape(fields.below("shape"));
  if (double value = 0.0; fields.read("density", value)) body.density = value;
  if (double value = 0.0; fields.read("mass", value)) body.mass = value;
  if (Vector3 moments; fields.find("inertia") != nullptr) {
    fields.read("inertia", moments);
    body.inertia = Matrix3(moments.asDiagonal());
  }
  if (Vector3 centre; fields.read("centre_of_mass", centre)) body.centre_of_mass = centre;
  const Fields pose = fields.below("pose");
  pose.read("position", body.position);
  body.rotation = read_rotation(pose);
  const Fields velocity = fields.below("velocity");
  velocity.read("linear", body.velocity);
  velocity.read("angular", body.spin);
  fields.read("fixed", body.fixed);
  return body;
}

void read_rigid_body(const Fields& fields, const ReadContext& context, BodyDescription& body) {
  rigid::RigidSettings settings = read_rigid(fields, body.name);
  if (fields.find("mesh") != nullptr) {
    body.mesh = read_mesh_file(fields.below("mesh"), context);
    fields.below("mesh").read_choice("use", body.convex, {{"surface", false}, {"convex", true}});
  }
  if (fields.find("motion") != nullptr) {
    refuse_free(fields);
    settings.fixed = true;
    body.motion = read_motion(fields.below("motion"), context);
    body.motion_place = fields.place("motion");
  }
  body.own = std::move(settings);
}

std::unique_ptr<mechanics::BodyModel> make_rigid(const BodySite& site) {
  rigid::RigidSettings settings = *site.body.as<rigid::RigidSettings>();
  settings.gravity = site.scene.gravity;
  if (!site.body.mesh.file.empty()) {
    settings.shape = make_solid(make_surface(site.body.mesh), site.body.convex);
  }
  return std::make_unique<rigid::RigidBodyModel>(std::move(settings));
}

bool is_fixed_rigid(const BodyDescription& body) { return body.as<rigid::RigidSettings>()->fixed; }

}  // namespace

void refuse_free(const Fields& fields) {
  bool fixed = true;
  fields.read("fixed", fixed);
  if (!fixed) {
    throw Error(ErrorKind::conflicting_keys, fields.place("fixed"),
                "the body has a motion, and is to be free", "leave one of the two out");
  }
  if (fields.find("velocity") == nullptr) return;
  throw Error(ErrorKind::conflicting_keys, fields.place("velocity"),
              "the body has a motion, which says how fast it is", "leave `velocity` out");
}

Vector3 read_rotation_vector(const Fields& pose) {
  Vector3 turn = Vector3::Zero();
  if (pose.find("rotation") == nullptr) return turn;
  if (pose.form("rotation").shape == Shape::quantity) {
    pose.read("rotation", turn);
    return turn;
  }
  const Fields rotation = pose.below("rotation");
  double angle = 0.0;
  rotation.read("angle", angle);
  return angle * read_axis(*rotation.find("axis"), rotation.table().find("axis")->forms);
}

Matrix3 read_rotation(const Fields& pose) {
  if (pose.find("rotation") == nullptr) return Matrix3::Identity();
  return rotation_matrix(read_rotation_vector(pose));
}

bool is_plane(const Node::Entry& body) {
  const Node* shape = body.value.find("shape");
  return shape != nullptr && shape->is_map() && shape->find("plane") != nullptr;
}

PlaneDescription read_plane(const Node::Entry& entry, const ReadContext& context) {
  refuse_world(entry);
  PlaneDescription plane{.name = entry.key, .place = entry.key_place, .plane = {}, .motion = {}};
  const Fields fields(entry.value, form_of(grammar(), "bodies", Shape::names).items.front());
  for (const char* key : {"density", "mass", "velocity"}) {
    if (fields.find(key) == nullptr) continue;
    throw Error(ErrorKind::conflicting_keys, fields.place(key),
                fmt::format("'{}' is a plane, to which `{}` does not apply", plane.name, key),
                "leave it out");
  }
  bool fixed = false;
  fields.read("fixed", fixed);
  if (fields.find("motion") != nullptr) {
    refuse_free(fields);
    plane.motion = read_motion(fields.below("motion"), context);
  } else if (!fixed) {
    throw Error(ErrorKind::conflicting_keys, plane.place,
                fmt::format("'{}' is a plane, which cannot move freely", plane.name),
                "add `fixed: true`, or a `motion`");
  }
  const Fields pose = fields.below("pose");
  pose.read("position", plane.plane.point);
  plane.plane.normal = read_rotation(pose).col(2);
  return plane;
}

const BodyKind& rigid_kind() {
  static const BodyKind kind{.word = "rigid",
                             .description = "A rigid body.",
                             .noun = "a rigid body",
                             .table = forms::rigid_table,
                             .read = read_rigid_body,
                             .make = make_rigid,
                             .is_rigid = true,
                             .is_fixed = is_fixed_rigid,
                             .carry_masses = "weld a rigid body of that mass to it"};
  return kind;
}

rigid::Solid make_solid(mesh::Surface surface, bool convex) {
  rigid::Solid solid;
  solid.surface = std::make_shared<const mesh::Surface>(std::move(surface));
  if (convex) solid.hull = std::make_shared<const collision::Polyhedron>(solid.surface->nodes);
  return solid;
}

}  // namespace sinew::scene
