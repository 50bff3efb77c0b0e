#include "sinew/scene/urdf.hpp"

#include <cmath>
#include <mutex>
#include <utility>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "sinew/scene/urdf_tree.hpp"

namespace sinew::scene {

namespace {

// Collects the messages of the parser instead of printing them.
class Messages : public console_bridge::OutputHandler {
 public:
  Messages() { console_bridge::useOutputHandler(this); }
  ~Messages() override { console_bridge::restorePreviousOutputHandler(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    text_ += (text_.empty() ? "" : ": ") + text;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

urdf::ModelInterfaceSharedPtr parse_values(const UrdfTree& tree) {
  static std::mutex one_at_a_time;  // the parser's messages are global
  const std::lock_guard lock(one_at_a_time);
  const Messages messages;
  urdf::ModelInterfaceSharedPtr model;
  std::string reason;
  try {
    model = urdf::parseURDF(tree.text());
  } catch (const std::exception& error) {
    reason = error.what();
  }
  // After some errors, the parser continues without the element.
  if (model != nullptr && messages.text().empty()) return model;
  if (!messages.text().empty()) reason = messages.text();
  throw Error(ErrorKind::malformed_file, tree.place_named_in(reason), reason,
              "correct the file there");
}

Vector3 vector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  result.translation() = vector(pose.position);
  return result;
}

void require(bool holds, const Location& place, const std::string& what,
             const std::string& remedy) {
  if (!holds) throw Error(ErrorKind::out_of_range, place, what, remedy);
}

bool is_positive(std::initializer_list<double> lengths) {
  for (const double length : lengths) {
    if (!(length > 0.0) || !std::isfinite(length)) return false;
  }
  return true;
}

std::optional<rigid::MassProperties> inertial_of(const urdf::Link& link, const Location& place) {
  if (link.inertial == nullptr || link.inertial->mass == 0.0) return std::nullopt;
  const urdf::Inertial& own = *link.inertial;
  require(is_positive({own.mass}), place, fmt::format("its mass is {:g} kg", own.mass),
          "give a mass above zero, or none to a link that is fixed to its parent");
  const Eigen::Isometry3d frame = isometry(own.origin);
  Matrix3 inertia;
  inertia << own.ixx, own.ixy, own.ixz, own.ixy, own.iyy, own.iyz, own.ixz, own.iyz, own.izz;
  require(inertia.allFinite() && frame.matrix().allFinite(), place, "its <inertial> is not finite",
          "give finite numbers");
  return rigid::MassProperties{own.mass, frame.translation(),
                               frame.linear() * inertia * frame.linear().transpose()};
}

UrdfGeometry geometry_of(const urdf::Geometry& form, const urdf::Pose& pose,
                         const Location& place) {
  UrdfGeometry result{place, isometry(pose), UrdfMesh{}};
  const char* const remedy = "give positive sizes";
  if (const auto* box = dynamic_cast<const urdf::Box*>(&form)) {
    require(is_positive({box->dim.x, box->dim.y, box->dim.z}), place, "an edge is not positive",
            remedy);
    result.form = rigid::Box{vector(box->dim)};
  } else if (const auto* ball = dynamic_cast<const urdf::Sphere*>(&form)) {
    require(is_positive({ball->radius}), place, "the radius is not positive", remedy);
    result.form = rigid::Sphere{ball->radius};
  } else if (const auto* rod = dynamic_cast<const urdf::Cylinder*>(&form)) {
    require(is_positive({rod->radius, rod->length}), place, "a size is not positive", remedy);
    result.form = rigid::Cylinder{rod->radius, rod->length};
  } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&form)) {
    const Vector3 scale = vector(mesh->scale);
    require(scale.allFinite() && scale.prod() != 0.0, place, "the scale is zero",
            "give three numbers that are not");
    result.form = UrdfMesh{mesh->filename, scale};
  }
  require(result.pose.matrix().allFinite(), place, "the <origin> is not finite",
          "give finite numbers");
  return result;
}

// @param parts <visual> or <collision> elements from the parser. @param tag of the elements.
template <class Parts>
std::vector<UrdfGeometry> geometries_of(const Parts& parts, const char* tag,
                                        const pugi::xml_node& link, const UrdfTree& tree) {
  std::vector<UrdfGeometry> result;
  pugi::xml_node element = link.child(tag);
  for (const auto& part : parts) {
    Location place = tree.place(element);
    place.item = fmt::format("link '{}'", link.attribute("name").value());
    if (part != nullptr && part->geometry != nullptr) {
      result.push_back(geometry_of(*part->geometry, part->origin, place));
    }
    element = element.next_sibling(tag);
  }
  return result;
}

UrdfJoint::Type type_of(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return UrdfJoint::Type::revolute;
    case urdf::Joint::CONTINUOUS:
      return UrdfJoint::Type::continuous;
    case urdf::Joint::PRISMATIC:
      return UrdfJoint::Type::prismatic;
    case urdf::Joint::FLOATING:
      return UrdfJoint::Type::floating;
    default:
      return UrdfJoint::Type::fixed;
  }
}

void read_limits(const urdf::Joint& from, UrdfJoint& joint) {
  if (from.dynamics != nullptr) joint.friction = from.dynamics->friction;
  require(joint.friction >= 0.0 && std::isfinite(joint.friction), joint.place,
          fmt::format("its friction is {:g}", joint.friction), "give a number above or equal zero");
  if (from.limits == nullptr) return;
  const urdf::JointLimits& limits = *from.limits;
  if (limits.effort > 0.0) joint.effort = limits.effort;
  if (limits.velocity > 0.0) joint.velocity = limits.velocity;
  if (joint.type != UrdfJoint::Type::revolute && joint.type != UrdfJoint::Type::prismatic) return;
  joint.lower = limits.lower;
  joint.upper = limits.upper;
  if (joint.lower < joint.upper) return;
  throw Error(
      ErrorKind::contradictory_limits, joint.place,
      fmt::format("its lower limit is {:g} and its upper one {:g}", joint.lower, joint.upper),
      "make it of type fixed if it does not move");
}

UrdfJoint joint_of(const urdf::Joint& from, const UrdfTree& tree, const pugi::xml_node& element) {
  UrdfJoint joint;
  joint.name = from.name;
  joint.place = tree.place(element);
  joint.type = type_of(from);
  joint.parent = tree.link_number(from.parent_link_name);
  joint.child = tree.link_number(from.child_link_name);
  joint.pose = isometry(from.parent_to_joint_origin_transform);
  require(joint.pose.matrix().allFinite(), joint.place, "its <origin> is not finite",
          "give finite numbers");
  const bool moves =
      joint.type != UrdfJoint::Type::fixed && joint.type != UrdfJoint::Type::floating;
  if (!moves) return joint;
  const Vector3 axis = vector(from.axis);
  require(axis.allFinite() && axis.norm() > 0.0, joint.place, "its <axis> has no length",
          "give a direction such as 0 0 1");
  joint.axis = axis.normalized();
  read_limits(from, joint);
  return joint;
}

}  // namespace

UrdfRobot parse_urdf(std::string_view text, const std::string& name) {
  const UrdfTree tree(text, name);
  const urdf::ModelInterfaceSharedPtr model = parse_values(tree);
  UrdfRobot robot;
  robot.notices = tree.notices();
  for (const pugi::xml_node& element : tree.links()) {
    const urdf::Link& from = *model->links_.at(element.attribute("name").value());
    UrdfLink& link = robot.links.emplace_back();
    link.name = from.name;
    link.place = tree.place(element);
    link.inertial = inertial_of(from, link.place);
    link.visuals = geometries_of(from.visual_array, "visual", element, tree);
    link.collisions = geometries_of(from.collision_array, "collision", element, tree);
  }
  for (const pugi::xml_node& element : tree.joints()) {
    const urdf::Joint& from = *model->joints_.at(element.attribute("name").value());
    robot.joints.push_back(joint_of(from, tree, element));
  }
  return robot;
}

}  // namespace sinew::scene
