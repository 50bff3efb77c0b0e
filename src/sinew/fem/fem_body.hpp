/// @file
/// The state and workspace of a finite-element robot in one simulation.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/element_history.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/rigid_base.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew::fem {

/// M a + C v + f(q) = p + H^T lambda over the free nodes, C = alpha M + beta K(q_start).
class FemBody : public mechanics::Body {
 public:
  /// @param model must outlive the body. @param pool likewise.
  /// @param with_curvature,histories see mechanics::BodyModel::create().
  FemBody(const FemBodyModel& model, ThreadPool& pool, bool with_curvature, int histories = 0);
  ~FemBody() override;

  const mechanics::BodyModel& model() const override { return model_; }
  const FemBodyModel& fem_model() const { return model_; }
  Vector3 position(int point) const override;
  Vector3 velocity(int point) const override;

  void begin_step() override;
  void begin_query() override;
  void linearise(const mechanics::LinearisationRequest& request) override;
  void add_curvature(const mechanics::RowCurvature& curvature) override;
  void take_rows(const mechanics::RowValues& rows) override;
  void retake_rows(const mechanics::RowValues& rows) override { take_rows(rows); }
  Vector3 proposed_motion(int point) const override;
  double residual(std::span<const double> effort) override;
  linalg::FactorStatus condense() override;
  void hold_imbalance(std::span<const double> effort) override;
  void set_imbalance_share(double share) override { imbalance_share_ = share; }
  void add_compliance(std::span<const int> place, MatrixX& compliance,
                      VectorX& free_motion) const override;
  void solve_motion(std::span<const double> effort) override;
  std::size_t motion_size() const override { return static_cast<std::size_t>(motion_.size()); }
  void imbalance(std::span<const double> effort, std::span<double> result) override;
  void solve(std::span<const double> right, std::span<double> result) override;
  void propose_motion(std::span<const double> motion) override;
  void propose_drift(double time_step) override;
  mechanics::MotionReport apply_motion(double scale) override;
  mechanics::SmallestVolume smallest_volume() override;
  double end_step(const mechanics::StepWeights& weights) override;
  mechanics::StepWork step_work() const override { return work_; }
  bool moved_from_outside() const override { return tether_.has_value() || rigid_base_.moves(); }

  void restart() override;
  std::size_t state_size() const override;
  void save_state(std::span<double> state) const override;
  void load_state(std::span<const double> state) override;

  int negative_pivots() const override;
  double force_scale() const override { return force_scale_; }
  double rounding_floor() const override;
  bool is_unsymmetric() const override { return !open_stiffness_.empty(); }
  double strain_energy() override;
  double kinetic_energy() override;
  double gravity_energy() const override;
  std::size_t bytes() const override;

  /// (n, 3) m, all mesh nodes in file order, fixed and unused ones included.
  const Points& positions() const override { return positions_; }
  /// (n, 3) m/s.
  const Points& velocities() const override { return velocities_; }
  /// (n, 3) N, dead loads added to gravity; zero unless set. Forces on fixed nodes do nothing.
  Points& external_forces() { return external_forces_; }
  const Points& external_forces() const { return external_forces_; }

  /// The motion of the fixed nodes. Each step begins its search where that motion takes the whole
  /// body. What moves the base puts in or takes out work.
  RigidBase& rigid_base() { return rigid_base_; }
  const RigidBase& rigid_base() const { return rigid_base_; }

  /// (loads,) of FemBodyModel::loads(), 1 unless set: an input as external forces are.
  std::vector<double>& load_factors() { return load_factors_; }
  const std::vector<double>& load_factors() const { return load_factors_; }
  /// (n, 3) N: what the loads put on all nodes, as of the last linearisation.
  Points load_forces() const { return load_forces_ + drag_forces_; }

  /// From the next step on; none lets go. An input as external forces are: not part of the state.
  /// @param tether see there. Throws Error: index-out-of-range (node), out-of-range (weights,
  /// stiffness), not-finite, bad-argument when the nodes are no face of an element.
  void set_tether(const std::optional<Tether>& tether);
  const std::optional<Tether>& tether() const { return tether_; }
  /// Where the tether holds the body now, (3,) m. Only while there is one.
  Vector3 tether_point() const;

  /// What its elements have behind them; part of the state.
  const ElementHistory& history() const { return element_history_; }

  /// Adds the force that rows put on each free node, as of the last linearisation.
  /// @param effort (rows,) N of the world's rows. @param forces (n, 3) N, added to.
  void add_row_forces(std::span<const double> effort, Points& forces) const;

 private:
  struct Numbers;  // assembly and factorisation of one FemSystem
  struct LoadBlock {
    std::int32_t row = 0, column = 0;  // free numbers
    Matrix3 value;
  };

  Numbers& numbers(bool with_curvature);
  void form_right_side(const mechanics::LinearisationRequest& request);
  void add_inertia(const mechanics::StepWeights& weights);
  Vector3 combined(const mechanics::Combination& weights, NodeId node) const;
  void combine(const mechanics::Combination& weights, VectorX& result) const;
  void combine_velocity(const mechanics::StepWeights& weights, VectorX& result) const;
  void hold_right_side();
  void evaluate_elements(const mechanics::LinearisationRequest& request);
  void stiffen_by_tether();
  void apply_loads(const mechanics::LinearisationRequest& request);
  void stiffen_by_loads();
  void add_majorant(std::int32_t row, std::int32_t column, const Matrix3& block);
  void correct_for_open_pressure();
  void multiply_blocks(const std::vector<LoadBlock>& blocks, const VectorX& x, VectorX& y) const;
  void add_work(const mechanics::StepWeights& weights);
  double rayleigh_work(const mechanics::StepWeights& weights);
  void pull_by_tether();
  Vector3 weighted(const Points& field, int point) const;
  void place_base();
  void find_base_velocity(const mechanics::StepWeights& weights);
  void add_base_momentum(const mechanics::Combination& weights, VectorX& result) const;
  void remember_base();
  void keep_positions();
  void prepare_history(double time_step);
  void take_presence(const mechanics::RowValues& rows);
  void add_passing_compliance(std::span<const int> place, MatrixX& compliance,
                              VectorX& free_motion) const;
  /// (3,) N on a mesh node.
  Vector3 weight(NodeId node) const {
    return model_.elements().load_mass()[node] * model_.settings().gravity;
  }

  const FemBodyModel& model_;
  ThreadPool& pool_;
  Points positions_, velocities_, external_forces_;
  std::vector<Points> history_;  // what the integrator keeps, (n, 3) each
  std::vector<double> load_factors_;
  Points load_forces_, drag_forces_;                    // (n, 3) N
  Points load_rates_, load_gaps_, load_accelerations_;  // (n, 3), where loads resist motion
  std::vector<LoadBlock> load_stiffness_;               // symmetric, row >= column
  std::vector<LoadBlock> open_stiffness_;               // what is left of it; in statics alone
  mechanics::StepWork work_;
  ElementHistory element_history_;
  std::optional<double> prepared_step_;  // that element_history_ was last prepared for
  Points start_positions_;  // of the step; velocities_ stay those of its start until it ends
  std::unique_ptr<Numbers> plain_, curved_;
  Numbers* active_ = nullptr;
  mechanics::Tangent tangent_ = mechanics::Tangent::real_time;  // of the last linearisation

  // Over free nodes, (3 free,); travel and momentum from the first step of dynamics on, the
  // imbalance from the first time that it is held.
  VectorX right_, motion_, base_, scratch_, travel_, momentum_, imbalance_;
  std::vector<double> row_effort_;
  std::vector<std::int32_t>
      passing_;  // groups of three of the rows that come and go: those present
  double imbalance_share_ = 0.0;
  std::optional<Tether> tether_;
  RigidBase rigid_base_;
  bool carried_ = false;     // the base's motion took all nodes along at the start of the step
  VectorX carry_;            // by this much, (3 free,) m
  bool base_moves_ = false;  // base_velocity_ is not zero
  VectorX base_velocity_;    // see find_base_velocity(), (3 free,) m/s
  double blow_up_ = 0.0;  // sum of squared positions, m^2, beyond which the state is taken as lost
  bool first_linearisation_ = true;
  double force_scale_ = 0.0;
  double least_force_ = 0.0;  // N
};

}  // namespace sinew::fem
