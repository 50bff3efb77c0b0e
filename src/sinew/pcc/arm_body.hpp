/// @file
/// A constant-curvature arm as a Body: cables, effectors and controllers work on it as on finite
/// elements. Its coordinates are those of pcc::Arm, at rest straight.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/pcc/arm_equations.hpp"
#include "sinew/pcc/has_arm.hpp"

namespace sinew::pcc {

class ArmBodyModel : public mechanics::BodyModel, public HasArm {
 public:
  explicit ArmBodyModel(std::shared_ptr<const Arm> arm);

  const std::string& name() const override { return arm_->settings().name; }
  /// The section of the straight arm that a point lies in carries it. Throws
  /// Error(point-outside-mesh) before the base, behind the tip, or farther from the axis than the
  /// arm's radius, unless `outside` says nearest: the first or last section then carries it.
  int attach(const Vector3& rest_position, mesh::Outside outside, const std::string& what) override;
  int attach_ball(const Vector3& centre, double radius, mesh::Outside outside,
                  const std::string& what) override;
  /// Throws Error(wrong-type): it has no nodes.
  int attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) override;
  int attach_coordinate(int coordinate) override;
  Vector3 rest_position(int point) const override;
  void finish(int body, const mechanics::RowPattern& rows,
              std::span<const mechanics::RowCurvature> curvatures,
              const linalg::FactorisationSettings& settings) override;
  bool couples(int, int) const override { return true; }
  std::vector<NamedHash> parts() const override;
  std::uint64_t point_hash(int point) const override;
  std::unique_ptr<mechanics::Body> create(ThreadPool& pool, bool with_curvature,
                                          int histories) const override;
  /// A cylinder of hexahedra of the arm's radius, for records and the view.
  const mesh::Mesh& mesh() const override { return skin_; }

  const Arm& arm() const override { return *arm_; }
  std::shared_ptr<const Arm> shared_arm() const override { return arm_; }

 private:
  friend class ArmBody;

  /// A material point, or a coordinate in a point's place.
  struct Attachment {
    ArmPoint point;
    int coordinate = -1;  ///< >= 0: this coordinate
  };
  struct Entry {
    int row = 0;    ///< of own rows
    int entry = 0;  ///< of the world's
    int attachment = 0;
  };

  ArmPoint locate(const Vector3& rest_position, mesh::Outside outside,
                  const std::string& what) const;
  void make_skin();

  std::shared_ptr<const Arm> arm_;
  std::vector<Attachment> attachments_;
  std::vector<std::int32_t> rows_;  ///< of the world that touch it, ascending
  std::vector<Entry> entries_;
  mesh::Mesh skin_;
  std::vector<ArmPoint> skin_points_;
};

class ArmBody : public mechanics::Body {
 public:
  ArmBody(const ArmBodyModel& model, int histories);

  const mechanics::BodyModel& model() const override { return model_; }
  Vector3 position(int point) const override;
  Vector3 velocity(int point) const override;

  void begin_step() override { start_ = q_; }
  void linearise(const mechanics::LinearisationRequest& request) override;
  void add_curvature(const mechanics::RowCurvature& curvature) override;
  void take_rows(const mechanics::RowValues& rows) override;
  void retake_rows(const mechanics::RowValues& rows) override;
  double residual(std::span<const double> effort) override;
  linalg::FactorStatus condense() override;
  void add_compliance(std::span<const int> place, MatrixX& compliance,
                      VectorX& free_motion) const override;
  void hold_imbalance(std::span<const double> effort) override;
  void set_imbalance_share(double share) override { imbalance_share_ = share; }
  void solve_motion(std::span<const double> effort) override;
  std::size_t motion_size() const override { return static_cast<std::size_t>(q_.size()); }
  void imbalance(std::span<const double> effort, std::span<double> result) override;
  void solve(std::span<const double> right, std::span<double> result) override;
  void propose_motion(std::span<const double> motion) override;
  void propose_drift(double time_step) override;
  mechanics::MotionReport apply_motion(double scale) override;
  double end_step(const mechanics::StepWeights& weights) override;
  mechanics::StepWork step_work() const override { return work_; }

  void restart() override;
  std::size_t state_size() const override;
  void save_state(std::span<double> state) const override;
  void load_state(std::span<const double> state) override;

  int negative_pivots() const override { return negative_pivots_; }
  double force_scale() const override { return force_scale_; }
  double rounding_floor() const override;
  double strain_energy() override;
  double kinetic_energy() override;
  double gravity_energy() const override;
  std::size_t bytes() const override;
  const Points& positions() const override;
  const Points& velocities() const override;

  const VectorX& coordinates() const { return q_; }  ///< (coordinates,) rad; e: m
  const VectorX& rates() const { return rate_; }     ///< (coordinates,) rad/s
  /// A new state. @param q,rate (coordinates,). Throws Error(wrong-shape).
  void set_coordinates(const VectorX& q, const VectorX& rate);

 private:
  /// Puts the workspace of kinematics at q and rate.
  void look() const;
  void combine(const mechanics::Combination& weights, VectorX& result) const;
  void stiffen_by_rows();
  /// Of an attached point, (3, n).
  void point_jacobian(int point, MatrixX& result);
  void make_definite();
  void respond();
  void show() const;

  const ArmBodyModel& model_;
  ArmEquations equations_;
  mutable ArmDynamics<double> kinematics_;
  mutable bool looking_ = false;  // the workspace is at q_ and rate_
  ArmDynamics<Dual<8>> slopes_;
  VectorX q_, rate_, start_;
  std::vector<VectorX> history_;
  VectorX right_, motion_, base_, scratch_, new_rate_, acceleration_, imbalance_;
  double imbalance_share_ = 0.0;
  MatrixX matrix_, symmetric_;
  MatrixX first_jacobian_, second_jacobian_, pulled_;  // (3, n), of a curvature's points
  linalg::LuFactor decomposed_;
  linalg::SymmetricPivots pivots_;
  linalg::SymmetricSpectrum spectrum_;
  int negative_pivots_ = 0;
  bool definite_wanted_ = true;
  bool iterating_ = false;                  // further linearisations of this step may follow
  MatrixX rows_, moved_rows_, compliance_;  // (n, own rows): H^T, A^-1 H^T; (own rows, own rows)
  VectorX free_motion_, effort_;
  std::vector<Vector3> directions_;  // of the entries, as last taken
  std::vector<Vec3<double>> columns_;
  std::vector<Vec3<Dual<8>>> slope_columns_;
  std::vector<Dual<8>> slope_q_;
  double force_scale_ = 1.0, least_force_ = 1e-12;
  double rest_gravity_energy_ = 0.0;
  mechanics::StepWork work_;
  mutable Points shown_, shown_velocities_;
  mutable bool showing_ = false;
};

}  // namespace sinew::pcc
