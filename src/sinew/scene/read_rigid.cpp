// Reads bodies of type rigid.
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/rigid/rigid_settings.hpp"
#include "sinew/scene/readers.hpp"

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

}  // namespace

Matrix3 read_rotation(const Fields& pose) {
  Vector3 turn = Vector3::Zero();
  if (pose.find("rotation") == nullptr) return Matrix3::Identity();
  if (pose.form("rotation").shape == Shape::quantity) {
    pose.read("rotation", turn);
    return rotation_matrix(turn);
  }
  const Fields rotation = pose.below("rotation");
  double angle = 0.0;
  Vector3 axis = Vector3::UnitZ();
  rotation.read("angle", angle);
  axis = read_axis(*rotation.find("axis"), rotation.table().find("axis")->forms);
  return rotation_matrix(angle * axis);
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

}  // namespace sinew::scene
