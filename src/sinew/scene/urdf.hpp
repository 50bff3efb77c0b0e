/// @file
/// Robots from URDF files: links and joints as the file has them, in SI units. Internal to this
/// folder, but for the fuzzer.
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
  std::string file;  ///< as it is written, package:// and file:// included
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
  /// In the link's frame; none where the file gives none, or a mass of 0.
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
  std::vector<UrdfJoint> joints;  ///< joint k leads to link k + 1
  std::vector<Notice> notices;    ///< what the file says and this version does not do
};

/// Reads a robot description (URDF 1.0, as ROS documents it: wiki.ros.org/urdf/XML). Throws Error
/// with the file's line: syntax-error, malformed-file (what the format does not allow, loops, no
/// single root), missing-key, duplicate-key, unknown-name (a link), bad-argument (a name that
/// scenes cannot hold), out-of-range, not-in-this-version (planar joints, mimic).
/// @param text of the file. @param name of the file, for messages.
UrdfRobot parse_urdf(std::string_view text, const std::string& name);

}  // namespace sinew::scene
