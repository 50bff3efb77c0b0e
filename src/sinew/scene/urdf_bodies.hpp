/// @file
/// Converts the links of a URDF robot to rigid bodies: merges links, and computes poses, masses and
/// geometry. Internal to this folder.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/notice.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/urdf.hpp"

namespace sinew::scene {

/// The rigid bodies of a URDF robot. A link without `<inertial>` on a fixed joint, such as a frame
/// or a decoration, is merged into its parent. Links that fixed joints connect to a fixed root are
/// fixed; those without geometry are merged into their parent or the world. Any other link becomes
/// a body of its own.
class UrdfBodies {
 public:
  static constexpr int kNone = -1;  ///< stands for the world

  /// Throws Error: unknown-name and contradictory-limits (for the initial values of joints).
  /// @param robot must outlive this. @param description must outlive this. @param name of the
  /// robot.
  UrdfBodies(const UrdfRobot& robot, const UrdfDescription& description, std::string name);

  /// The link into whose body a link is merged (maybe itself), or kNone.
  int carrier(int link) const { return carriers_[static_cast<std::size_t>(link)]; }
  /// Name of that body: ROBOT.LINK of the carrier, or `world`.
  std::string body_of(int link) const;
  bool is_fixed(int link) const { return fixed_[static_cast<std::size_t>(link)]; }
  /// Initial pose of a link in the world frame, m.
  const Eigen::Isometry3d& frame(int link) const { return frames_[static_cast<std::size_t>(link)]; }
  /// Initial angle (rad) or displacement (m) of a joint.
  double start(int joint) const { return starts_[static_cast<std::size_t>(joint)]; }

  /// Makes the bodies. Throws Error: missing-mass, file-not-found, unknown-name (a package), and
  /// what make_surface() throws.
  /// @param notices gets a warning for each body that is drawn by its collision geometry because
  /// the format of its visual is not supported.
  std::vector<BodyDescription> make(std::vector<Notice>& notices) const;

 private:
  struct Part {
    const UrdfGeometry* geometry;
    Eigen::Isometry3d pose;  // in the body's frame
  };
  using Parts = std::vector<Part>;

  void read_starts();
  void place_links();
  void find_carriers();
  int carrier_of_root() const;
  Parts parts_of(int carrier, std::vector<UrdfGeometry> UrdfLink::*kind) const;
  rigid::MassProperties mass_of(int link, const Parts& solids) const;
  mesh::Surface surface_of(const UrdfGeometry& geometry) const;
  mesh::Surface united(const Parts& parts) const;
  std::filesystem::path resolved(const UrdfMesh& mesh, const Location& place) const;
  void give_shape(const Parts& parts, rigid::RigidSettings& body) const;
  void give_look(const Parts& visuals, rigid::RigidSettings& body,
                 std::vector<Notice>& notices) const;

  const UrdfRobot& robot_;
  const UrdfDescription& description_;
  std::string name_;
  std::vector<double> starts_;
  std::vector<Eigen::Isometry3d> frames_;
  std::vector<int> carriers_;
  std::vector<char> fixed_;
};

}  // namespace sinew::scene
