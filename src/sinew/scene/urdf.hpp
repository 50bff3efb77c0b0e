/// @file
/// Reads robots from URDF files: links and joints as written in the file, in SI units. Used only in
/// this folder and by the fuzzer.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"
#include "sinew/rigid/shape.hpp"

namespace sinew::scene {

struct UrdfMesh {
  std::string file;  ///< as written, including package:// and file://
  Vector3 scale = Vector3::Ones();
};

struct UrdfGeometry {
  Location place;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< m, in the link's frame
  std::variant<rigid::Box, rigid::Sphere, rigid::Cylinder, UrdfMesh> form;
};

struct UrdfLink {
  std::string name;
  Location place;
  /// In the link's frame; none if the file gives none, or a mass of 0.
  std::optional<rigid::MassProperties> inertial;
  std::vector<UrdfGeometry> visuals, collisions;
};

struct UrdfJoint {
  enum class Type { fixed, revolute, continuous, prismatic, floating };
  std::string name;
  Location place;
  Type type = Type::fixed;
  int parent = -1, child = -1;                             ///< numbers of links
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< m, of the child in the parent
  Vector3 axis = Vector3::UnitX();                         ///< unit length, in the child's frame
  double lower = -kInfinity, upper = kInfinity;            ///< rad or m
  double effort = kInfinity, velocity = kInfinity;         ///< N m or N; rad/s or m/s
  double friction = 0.0;                                   ///< N m or N
};

struct UrdfRobot {
  std::vector<UrdfLink> links;    ///< each after its parent; the first is the root
  std::vector<UrdfJoint> joints;  ///< the child of joint k is link k + 1
  std::vector<Notice> notices;    ///< about elements of the file that are not used
};

/// Reads a robot description (URDF 1.0, as documented by ROS: wiki.ros.org/urdf/XML). Throws Error
/// with the line of the file: syntax-error, size-limit, malformed-file (violates the format, has a
/// loop or several roots), missing-key, duplicate-key, unknown-name (a link), unknown-choice (a
/// type of joint), bad-argument (a name that scenes do not allow, or '%'), out-of-range,
/// contradictory-limits, not-in-this-version (planar joints, mimic).
/// @param text of the file. @param name of the file, for messages.
UrdfRobot parse_urdf(std::string_view text, const std::string& name);

}  // namespace sinew::scene
