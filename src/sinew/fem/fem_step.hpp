/// @file
/// Steps of a finite-element body.
#pragma once

#include "sinew/fem/body_elements.hpp"
#include "sinew/fem/body_loads.hpp"
#include "sinew/fem/fem_state.hpp"
#include "sinew/fem/inertia_forces.hpp"
#include "sinew/fem/node_turns.hpp"
#include "sinew/mechanics/sparse_step.hpp"

namespace sinew::fem {

/// Steps of a finite-element body: M a + C v + f(q) = p + H^T lambda over the free nodes, with
/// C = alpha M + beta K. K is evaluated once per step (BodyElements::linearise()).
class FemStep : public mechanics::SparseStep {
 public:
  /// @param state,pool must outlive this. @param with_geometric_stiffness see
  /// mechanics::BodyModel::create().
  FemStep(FemState& state, ThreadPool& pool, bool with_geometric_stiffness);

  void begin_step() override;
  void begin_query() override;
  mechanics::Wrench unbalanced(std::span<const double> effort, const Vector3& about) override;
  double rounding_floor() const override;
  double proposed_move() const override { return motion().cwiseAbs().maxCoeff(); }
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
  /// Adds H^T effort on mesh nodes. @param effort (all rows,) N. @param forces (n, 3) N.
  void add_row_forces(std::span<const double> effort, Points& forces) const;
  std::size_t bytes() const override;

 private:
  double form(const mechanics::LinearisationRequest& request, VectorX& right,
              mechanics::SparseSystem& system) override;
  void complete_matrix() override;
  void changed_matrix() override { elements_.moved(); }
  void depart() override;
  void drift(double time_step, VectorX& motion) override;
  bool is_symmetric() const override { return loads_.unsymmetric().empty(); }
  void correct(linalg::Factorisation& factor, VectorX& motion, bool transposed) const override;
  void keep_directions() override { turns_.start(state_.positions); }
  bool measure_turns() override;
  void turn(VectorX& v) const override { turns_.turn(v); }
  void turn_back(VectorX& v) const override { turns_.turn_back(v); }

  double form_right_side(const mechanics::StepWeights& weights, VectorX& right);
  void keep_positions();
  void count_tether(const mechanics::StepWeights& weights, mechanics::StepEnd& end);
  void carried_force(const mechanics::StepWeights& weights);
  void count_work(const mechanics::StepWeights& weights, mechanics::StepEnd& end);

  FemState& state_;
  BodyElements elements_;
  BodyLoads loads_;
  NodeTurns turns_;  // since the factorisation
  InertiaForces inertia_;
  mechanics::Tangent tangent_ = mechanics::Tangent::corotated;  // of the last linearisation
  bool first_linearisation_ = true;

  VectorX from_;              // (size(),) m, positions at which the proposed motion starts
  mutable VectorX scratch_;   // (size(),)
  mutable VectorX row_sums_;  // of rounding_floor(), scratch
  bool departs_ = false;      // whether a solved motion has not been applied yet
  double min_force_ = 0.0;    // N, at the stiffness factor 1
  double blow_up_ = 0.0;      // m^2, sum of squared positions above which the state counts as lost
};

}  // namespace sinew::fem
