/// @file
/// The model of a rigid body.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/collision/surface_tree.hpp"
#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/own_rows.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/rigid/rigid_loads.hpp"
#include "sinew/rigid/rigid_settings.hpp"

namespace sinew::rigid {

/// Model of a rigid body: its shape, mass and attached sites.
class RigidBodyModel final : public mechanics::BodyModel,
                             public mechanics::AttachesOrientations,
                             public mechanics::HasShape,
                             public mechanics::HasSurface,
                             public mechanics::MayHaveBase,
                             public mechanics::BearsLoads {
 public:
  /// A site on the body.
  struct Attachment {
    enum class Kind { point, orientation, surface };
    Kind kind = Kind::point;
    Vector3 arm = Vector3::Zero();  ///< m, from the centre of mass, at rest in the world's axes
  };

  /// Throws Error: out-of-range for an impossible size, mass or inertia; missing-mass if a movable
  /// body has none; what mesh::require_solid() throws if the mass requires a solid.
  explicit RigidBodyModel(RigidSettings settings);

  const std::string& name() const override { return settings_.name; }
  int attach(const Vector3& rest_position, mesh::Outside outside, const std::string& what) override;
  int attach_ball(const Vector3& centre, double radius, mesh::Outside outside,
                  const std::string& what) override;
  int attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) override;
  /// The mean of material points of a rigid body is a material point.
  int attach_mean(const Points& points, mesh::Outside outside, const std::string& what) override;
  std::vector<int> attach_anchors(std::span<const NodeId> part) override;
  int attach_orientation(const Vector3& rest_position, mesh::Outside outside,
                         const std::string& what) override;
  int attach_surface() override;
  std::shared_ptr<const collision::SurfaceTopology> surface() const override { return touching_; }
  std::shared_ptr<const mechanics::SurfaceTrace> surface_trace() const override;
  const Points& rest_surface_nodes() const override { return touching_nodes_; }
  bool holds(NodeId) const override { return settings_.fixed; }
  Vector3 rest_position(int point) const override;
  void finish(int body, const mechanics::RowPattern& rows,
              std::span<const mechanics::StiffnessPair> stiffness_pairs) override;
  bool couples(int, int) const override { return true; }
  bool is_free() const { return !settings_.fixed; }
  std::vector<mechanics::HeldDirection> held_directions() const override;
  bool has_memory() const override { return false; }
  double stiffness_scale() const override;
  bool has_inertia() const override { return true; }  // a body that can move has mass
  double size() const override;
  bool is_loaded() const override {
    return load_count() > 0 || (mass() > 0.0 && settings_.gravity.norm() > 0.0);
  }
  bool has_few_coordinates() const override { return true; }
  bool has_base() const override { return settings_.fixed; }
  void describe(PartsVisitor& parts) const override;
  std::uint64_t site_hash(int site) const override;
  bool has_mesh() const override { return true; }
  const mesh::Mesh& mesh() const override { return skin_; }
  std::unique_ptr<mechanics::Body> create(ThreadPool& pool, bool with_geometric_stiffness,
                                          int histories) const override;

  Vector3 rest_origin() const override { return settings_.position; }
  double rest_distance(const Vector3& point) const override;

  const RigidSettings& settings() const { return settings_; }
  double mass() const override { return mass_.mass; }
  Vector3 own_centre() const override {
    return settings_.rotation.transpose() * (mass_.centre - settings_.position);
  }
  Vector3 rest_centre_of_mass() const override { return mass_.centre; }
  Matrix3 own_inertia() const override {
    return settings_.rotation.transpose() * mass_.inertia * settings_.rotation;
  }
  mechanics::TouchingPart touching_part() const override;
  double touching_radius() const override { return smooth_radius(settings_.shape); }
  collision::Shape rest_shape() const override {
    return placed(settings_.shape, shape_origin(), shape_axes());
  }
  const char* shape_name() const override { return rigid::shape_name(settings_.shape); }
  const Vector3& centre() const { return mass_.centre; }    ///< (3,) m, at rest, in the world
  const Matrix3& inertia() const { return mass_.inertia; }  ///< kg m^2 about it, at rest, in world
  /// Turning radius s, m: a rotation by an angle moves the body by about s times the angle.
  /// Rotations are multiplied by it, so that all coordinates have the unit m.
  double turning_radius() const { return radius_; }
  const Attachment& attachment(int site) const {
    return attachments_[static_cast<std::size_t>(site)];
  }
  /// True, since few of the many contact points of a heap touch.
  bool leaves_rows_out() const override { return true; }
  const mechanics::OwnRows& own_rows() const { return own_rows_; }

  const mesh::Mesh& load_mesh() const override;
  mesh::EmbeddedPoint carry(const Vector3& rest_position, mesh::Outside outside,
                            const std::string& what) override;
  mechanics::DeadLoad inertial_load(const Vector3& acceleration) override;
  const Vector3& gravity() const override { return settings_.gravity; }
  int add_load(mechanics::Load load) override;
  void describe_load(int load, PartVisitor& visitor) const override;
  std::size_t load_count() const { return added_loads_.size(); }
  /// (loads,) the dead ones; zero for the others.
  const std::vector<PointForce>& point_forces() const { return point_forces_; }
  /// The loads on faces of load_mesh(); none if there are none. After finish().
  const mechanics::LoadSet* face_loads() const { return face_loads_.get(); }
  /// Whether a load is a pressure on a surface with a border.
  bool is_open(int load) const;
  /// (face loads,) their numbers among all loads.
  const std::vector<int>& face_load_numbers() const { return face_load_numbers_; }

 private:
  int add(const Attachment& attachment);
  Vector3 shape_origin() const;  // m, at rest, in the world
  Matrix3 shape_axes() const;
  void check_inside(const Vector3& rest_position, mesh::Outside outside,
                    const std::string& what) const;

  RigidSettings settings_;
  MassProperties mass_;
  double radius_ = 1.0;
  mesh::Mesh skin_;
  std::unique_ptr<collision::SurfaceTree> surface_;  // surface of a Solid, in its own frame
  std::shared_ptr<const collision::SurfaceTopology> touching_;  // the surface that touches others
  Points touching_nodes_ = Points(0, 3);                        // m, at rest, in the world
  int surface_site_ = -1;
  std::vector<Attachment> attachments_;
  mechanics::OwnRows own_rows_;
  mutable std::unique_ptr<mesh::Mesh> load_mesh_;  // made when a load first asks for it
  std::vector<Vector3> load_points_;               // m, numbered after the nodes of the mesh
  std::vector<mechanics::Load> added_loads_;
  std::vector<PointForce> point_forces_;
  std::vector<int> face_load_numbers_;
  std::unique_ptr<const mechanics::LoadSet> face_loads_;
};

}  // namespace sinew::rigid
