/// @file
/// The links of a URDF robot as rigid bodies: which links are one body, where they are, what they
/// look like. Internal to this folder.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/notice.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/urdf.hpp"

namespace sinew::scene {

/// A link that has no `<inertial>` and hangs on a fixed joint is part of its parent, as a file's
/// frames and decorations are; what hangs on a fixed root by fixed joints is fixed; any other link
/// is a body of its own.
class UrdfBodies {
 public:
  static constexpr int kNone = -1;  ///< the world's

  /// Throws Error: unknown-name and contradictory-limits (of where joints start), missing-mass.
  /// @param robot must outlive this. @param description,name what the scene says of it.
  UrdfBodies(const UrdfRobot& robot, const UrdfDescription& description, std::string name);

  /// The link whose body a link is part of, or kNone.
  int carrier(int link) const { return carriers_[static_cast<std::size_t>(link)]; }
  /// ROBOT.LINK of the carrier, or `world`.
  std::string body_of(int link) const;
  bool is_fixed(int link) const { return fixed_[static_cast<std::size_t>(link)]; }
  /// Where a link is at the start, in the world.
  const Eigen::Isometry3d& frame(int link) const { return frames_[static_cast<std::size_t>(link)]; }
  /// rad or m: where joint k starts.
  double start(int joint) const { return starts_[static_cast<std::size_t>(joint)]; }

  /// The bodies. Throws Error(file-not-found), and what make_surface() does.
  /// @param notices get a line for what is drawn otherwise than the file says.
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
