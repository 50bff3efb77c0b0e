/// @file
/// A finite-element robot as a BodyModel: elements, loads, attached points, and the map from
/// constraint rows to its free nodes.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/sparse_row_plan.hpp"

namespace sinew::fem {

/// The matrix that a body factorises: the elements on one pattern, bordered by the persistent rows
/// (FemBodyModel::row_plan()). A body model has two systems, since the geometric stiffness of
/// constraints needs a wider pattern than most steps use.
struct FemSystem {
  std::shared_ptr<const FemModel> elements;
  std::shared_ptr<const linalg::FactorisationPlan> plan;
};

/// Model of a finite-element body. Immutable after finish(), and shared by simulations.
class FemBodyModel final : public mechanics::BodyModel,
                           public mechanics::HasSurface,
                           public mechanics::MayHaveBase,
                           public mechanics::BearsLoads,
                           public mechanics::CarriesMasses,
                           public mechanics::MovesByNodes,
                           public HasElements {
 public:
  /// Throws the errors of FemModel, and Error: out-of-range (negative damping, mass that is not
  /// positive), point-outside-mesh (a point mass outside of the mesh), unknown-choice (a solver
  /// that is not built in).
  explicit FemBodyModel(FemBodySettings settings);
  ~FemBodyModel() override;

  const std::string& name() const override { return settings_.name; }
  bool has_base() const override { return !settings_.elements.fixed_nodes.empty(); }
  int attach(const Vector3& rest_position, mesh::Outside outside, const std::string& what) override;
  int attach_ball(const Vector3& centre, double radius, mesh::Outside outside,
                  const std::string& what) override;
  int attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) override;
  int attach_mean(const Points& points, mesh::Outside outside, const std::string& what) override;
  std::vector<int> attach_anchors(std::span<const NodeId> part) override;
  int attach_surface() override;
  std::shared_ptr<const collision::SurfaceTopology> surface() const override { return surface_; }
  std::shared_ptr<const mechanics::SurfaceTrace> surface_trace() const override {
    return surface_trace_;
  }
  const Points& rest_surface_nodes() const override { return mesh().nodes; }
  bool holds(NodeId node) const override {
    return elements().free_index()[static_cast<std::size_t>(node)] < 0;
  }
  Vector3 rest_position(int point) const override;
  std::vector<mesh::HeldAxis> held_axes() const override;
  std::vector<mechanics::HeldDirection> held_directions() const override;
  bool is_loaded() const override;
  bool has_memory() const override;
  double stiffness_scale() const override;
  bool has_inertia() const override;
  double size() const override;
  bool has_few_coordinates() const override { return false; }
  std::vector<mechanics::AttachedMass> point_masses() const override;
  mesh::EmbeddedPoint locate(const Vector3& rest_position, mesh::Outside outside,
                             const std::string& what) const override;
  const mesh::Mesh& load_mesh() const override { return mesh(); }
  mesh::EmbeddedPoint carry(const Vector3& rest_position, mesh::Outside outside,
                            const std::string& what) override {
    return locate(rest_position, outside, what);
  }
  mechanics::DeadLoad inertial_load(const Vector3& acceleration) override;
  const Vector3& gravity() const override { return settings_.gravity; }
  int add_load(mechanics::Load load) override;
  void finish(int body, const mechanics::RowPattern& rows,
              std::span<const mechanics::StiffnessPair> stiffness_pairs) override;
  bool couples(int first, int second) const override;
  void describe(PartsVisitor& parts) const override;
  std::uint64_t site_hash(int site) const override;
  void describe_load(int load, PartVisitor& visitor) const override;
  std::unique_ptr<mechanics::Body> create(ThreadPool& pool, bool with_geometric_stiffness,
                                          int histories) const override;

  bool has_mesh() const override { return true; }
  const mesh::Mesh& mesh() const override { return *settings_.mesh; }
  const FemModel& elements() const override { return *elements_; }
  std::shared_ptr<const FemModel> shared_elements() const override { return elements_; }
  const FemBodySettings& settings() const override { return settings_; }
  /// (n, 3) m/s: initial velocities of all nodes; zero at fixed nodes and along held axes.
  Points start_velocities() const;
  /// (3,) N: weight of a mesh node.
  Vector3 weight(NodeId node) const { return elements().load_mass()[node] * settings_.gravity; }
  int mass_point(std::size_t mass) const override { return mass_points_[mass]; }
  /// All loads. Only after finish().
  const mechanics::LoadSet& loads() const { return *loads_; }
  const mechanics::Attachment& attachment(int point) const override {
    return attachments_[static_cast<std::size_t>(point)];
  }
  /// The rows that touch this body, on its free nodes. Only after finish().
  const mechanics::SparseRowPlan& row_plan() const { return row_plan_; }
  bool leaves_rows_out() const override { return true; }
  /// The plain system, or the one whose pattern has room for the geometric stiffness. Each is made
  /// on first use, since most robots need only one; thread-safe.
  const FemSystem& system(bool with_geometric_stiffness) const;
  bool is_plain(const FemSystem& system) const { return &system == &plain_; }

 private:
  mechanics::BlockSites block_sites() const;
  FemSystem make_system(const FemModelSettings& elements) const;
  void attach_mass(const PointMassSettings& mass);

  FemBodySettings settings_;
  std::vector<mechanics::Attachment> attachments_;
  int surface_site_ = -1;
  // From attach_surface() on.
  std::shared_ptr<const collision::SurfaceTopology> surface_;
  std::shared_ptr<const mechanics::SurfaceTrace> surface_trace_;
  std::vector<int> mass_points_;
  std::vector<mechanics::Load> added_loads_;  // until finish()
  std::unique_ptr<const mechanics::LoadSet> loads_;

  mechanics::SparseRowPlan row_plan_;
  std::vector<std::array<std::int32_t, 2>> coupled_points_;
  std::shared_ptr<const FemModel> elements_;
  mutable std::once_flag plain_once_, curved_once_;
  mutable FemSystem plain_, curved_;
};

}  // namespace sinew::fem
