/// @file
/// Steps of a finite-element body.
#pragma once

#include "sinew/fem/body_elements.hpp"
#include "sinew/fem/body_loads.hpp"
#include "sinew/fem/body_rows.hpp"
#include "sinew/fem/fem_state.hpp"
#include "sinew/fem/inertia_forces.hpp"
#include "sinew/fem/node_turns.hpp"
#include "sinew/fem/touched_blocks.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::fem {

/// StepSystem of a finite-element body: M a + C v + f(q) = p + H^T lambda over the free nodes, with
/// C = alpha M + beta K. K is evaluated once per step (BodyElements::linearise()).
class FemStep : public mechanics::StepSystem {
 public:
  /// @param state,pool must outlive this. @param with_geometric_stiffness see
  /// mechanics::BodyModel::create().
  FemStep(FemState& state, ThreadPool& pool, bool with_geometric_stiffness);

  void begin_step() override;
  void begin_query() override;
  void linearise(const mechanics::LinearisationRequest& request) override;
  void add_geometric_stiffness(const mechanics::StiffnessPair& pair) override;
  void take_rows(const mechanics::RowValues& rows) override;
  void retake_rows(const mechanics::RowValues& rows) override { take_rows(rows); }
  mechanics::Inertia condense() override;
  void add_matrix(int first, std::vector<mechanics::MatrixEntry>& entries) const override;
  void add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                      VectorX& free_motion) const override;

  std::size_t size() const override { return static_cast<std::size_t>(motion_.size()); }
  double residual(std::span<const double> effort, std::span<double> imbalance) override;
  mechanics::Wrench unbalanced(std::span<const double> effort, const Vector3& about) override;
  double force_scale() const override { return force_scale_; }
  double rounding_floor() const override;
  void subtract_residual(std::span<const double> force) override;

  void renew(std::span<const double> effort, bool turned) override;
  void solve_motion(std::span<const double> effort) override;
  void add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const override;
  double proposed_move() const override { return motion_.cwiseAbs().maxCoeff(); }
  void solve(std::span<const double> right, std::span<double> result) override;
  void propose_motion(std::span<const double> motion) override;
  void propose_drift(double time_step) override;
  Vector3 proposed_motion(int point) const override;
  void add_proposed_motion(Points& nodes) const override;
  mechanics::MotionReport apply_motion(double scale) override;
  mechanics::SmallestVolume smallest_volume() override { return elements_.smallest_volume(); }
  mechanics::LargestStretch largest_stretch() override { return elements_.largest_stretch(); }
  void find_acceleration(const mechanics::StepWeights& weights,
                         std::span<double> acceleration) override;
  void apply_mass(std::span<const double> motion, std::span<double> result) override;
  mechanics::StepEnd end_step(const mechanics::StepWeights& weights) override;
  bool keeps_linearisation() const override;
  void release() override { elements_.release(); }
  bool can_carry_on() const override;
  void scale_motion(double factor) override;
  void add_velocity(std::span<const double> change) override;

  /// Called when another state is loaded.
  void forget() { elements_.forget(); }
  double strain_energy() { return elements_.strain_energy(); }   ///< J, of the current state
  double kinetic_energy() { return inertia_.kinetic_energy(); }  ///< J, of the current state
  /// (n, 3) N on all nodes, from the last linearisation, with drag.
  Points load_forces() const { return loads_.forces() + loads_.drag(); }
  void add_row_forces(std::span<const double> effort, Points& forces) const {
    rows_.add_forces(effort, elements_.active(), forces);
  }
  std::size_t bytes() const;

 private:
  void form_right_side(const mechanics::StepWeights& weights);
  void find_imbalance(std::span<const double> effort);
  void solve_for_imbalance();
  void correct_for_unsymmetric();
  void keep_positions();
  void leave_from_here();
  void count_tether(const mechanics::StepWeights& weights, mechanics::StepEnd& end);
  void carried_force(const mechanics::StepWeights& weights);
  void count_work(const mechanics::StepWeights& weights, mechanics::StepEnd& end);

  FemState& state_;
  BodyElements elements_;
  BodyLoads loads_;
  BodyRows rows_;
  TouchedBlocks touched_blocks_;
  NodeTurns turns_;      // since the factorisation
  bool turned_ = false;  // whether the factor is used at a later state, with these
  InertiaForces inertia_;
  mechanics::Tangent tangent_ = mechanics::Tangent::corotated;  // of the last linearisation
  bool first_linearisation_ = true;

  // Over free nodes, (3 free,); subtracted_ is empty until subtract_residual() is called.
  VectorX right_, motion_;
  VectorX imbalance_;   // b + H^T effort, N
  VectorX from_;        // positions at which motion_ starts, m
  VectorX subtracted_;  // N
  bool subtracts_ = false;
  mutable VectorX row_sums_;  // of rounding_floor(), scratch
  // What b the factor contains: right_; right_ + H^T base_effort_; another one.
  enum class Content { right, imbalance, other };
  Content content_ = Content::other;
  std::vector<double> base_effort_, effort_change_;  // (border rows,) N
  bool departs_ = false;      // whether a solved motion has not been applied yet
  double force_scale_ = 0.0;  // N
  double min_force_ = 0.0;    // N, at the stiffness factor 1
  double blow_up_ = 0.0;      // m^2, sum of squared positions above which the state counts as lost
};

}  // namespace sinew::fem
