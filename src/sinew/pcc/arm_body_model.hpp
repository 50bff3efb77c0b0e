/// @file
/// A constant-curvature arm as a BodyModel, so that cables, effectors and controllers act on it as
/// on finite elements. Its generalised coordinates are those of pcc::Arm; at rest it is straight.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/own_rows.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/pcc/arm_dynamics.hpp"
#include "sinew/pcc/has_arm.hpp"

namespace sinew::pcc {

/// The immutable part of an arm's body, with the sites attached to it.
class ArmBodyModel final : public mechanics::BodyModel,
                           public mechanics::AttachesOrientations,
                           public HasArm {
 public:
  /// A site: where rows act on the arm.
  struct Attachment {
    enum class Kind { point, orientation, coordinate };
    Kind kind = Kind::point;
    ArmPoint point;                               ///< for an orientation, any point of the section
    int coordinate = -1;                          ///< of kind coordinate
    Matrix3 rest_rotation = Matrix3::Identity();  ///< of kind orientation
  };

  explicit ArmBodyModel(std::shared_ptr<const Arm> arm);
  /// Throws as Arm does.
  explicit ArmBodyModel(ArmSettings settings);

  const std::string& name() const override { return arm_->settings().name; }
  /// Attaches a point to the section of the straight arm that contains it. If the point lies before
  /// the base, beyond the tip, or farther from the axis than the radius, throws
  /// Error(point-outside-mesh), or with `outside` nearest attaches it to the nearest section.
  int attach(const Vector3& rest_position, mesh::Outside outside, const std::string& what) override;
  int attach_ball(const Vector3& centre, double radius, mesh::Outside outside,
                  const std::string& what) override;
  /// Throws Error(wrong-type), since an arm has no nodes.
  int attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) override;
  /// Of points of one cross-section; throws Error(wrong-type) for others.
  int attach_mean(const Points& points, mesh::Outside outside, const std::string& what) override;
  std::vector<int> attach_anchors(std::span<const NodeId> part) override;
  int attach_orientation(const Vector3& rest_position, mesh::Outside outside,
                         const std::string& what) override;
  int attach_coordinate(int coordinate) override;
  Vector3 rest_position(int point) const override;
  void finish(int body, const mechanics::RowPattern& rows,
              std::span<const mechanics::StiffnessPair> stiffness_pairs) override;
  bool couples(int, int) const override { return true; }
  std::vector<mechanics::HeldDirection> held_directions() const override;
  bool is_loaded() const override { return true; }
  bool has_memory() const override { return false; }
  double stiffness_scale() const override;
  bool has_inertia() const override { return true; }  // every section has mass
  double size() const override { return arm_->length(); }
  bool has_few_coordinates() const override { return true; }
  void describe(PartsVisitor& parts) const override;
  std::uint64_t site_hash(int site) const override;
  std::unique_ptr<mechanics::Body> create(ThreadPool& pool, bool with_geometric_stiffness,
                                          int histories) const override;
  bool has_mesh() const override { return true; }
  /// The skin for records and the view: a cylinder of hexahedra with the arm's radius.
  const mesh::Mesh& mesh() const override { return skin_; }

  const Arm& arm() const override { return *arm_; }
  std::shared_ptr<const Arm> shared_arm() const override { return arm_; }

  const Attachment& attachment(int site) const {
    return attachments_[static_cast<std::size_t>(site)];
  }
  const mechanics::OwnRows& own_rows() const { return own_rows_; }
  /// The material points of the nodes of mesh().
  const std::vector<ArmPoint>& skin_points() const { return skin_points_; }

 private:
  ArmPoint locate(const Vector3& rest_position, mesh::Outside outside,
                  const std::string& what) const;
  ArmDynamics<double> at_rest() const;
  int add(const Attachment& attachment);
  void make_skin();

  std::shared_ptr<const Arm> arm_;
  std::vector<Attachment> attachments_;
  mechanics::OwnRows own_rows_;
  mesh::Mesh skin_;
  std::vector<ArmPoint> skin_points_;
};

}  // namespace sinew::pcc
