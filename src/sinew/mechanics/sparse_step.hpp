/// @file
/// Steps of a body with many coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mechanics/sparse_rows.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/mechanics/touched_blocks.hpp"

namespace sinew::mechanics {

/// The matrix A of a sparse step, in blocks of three coordinates, and its solver.
struct SparseSystem {
  const linalg::BlockPattern* pattern = nullptr;
  std::span<double> matrix;                 ///< in the layout of linalg::BlockPattern
  linalg::Factorisation* factor = nullptr;  ///< for this pattern, and the border of the body's rows
};

/// StepSystem with a sparse symmetric A, to which derived classes may add a small unsymmetric part
/// B. The counterpart of DenseStep for bodies whose coordinates come in blocks of three: nodes of
/// finite elements, positions and rotations of rods. Derived classes define the equation of the
/// body and how a motion changes its state; what their sites are is in the SparseRowPlan.
class SparseStep : public StepSystem, protected SiteLevers {
 public:
  void linearise(const LinearisationRequest& request) final;
  void add_geometric_stiffness(const StiffnessPair& pair) override;
  void take_rows(const RowValues& rows) final { rows_.take(rows); }
  void retake_rows(const RowValues& rows) final { take_rows(rows); }
  Inertia condense() final;
  void add_matrix(int first, std::vector<MatrixEntry>& entries) const final;
  void add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                      VectorX& free_motion) const final;

  std::size_t size() const final { return static_cast<std::size_t>(motion_.size()); }
  double residual(std::span<const double> effort, std::span<double> imbalance) final;
  double force_scale() const final { return force_scale_; }
  void subtract_residual(std::span<const double> force) final;

  void renew(std::span<const double> effort, bool turned) final;
  void solve_motion(std::span<const double> effort) final;
  void add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const final;
  void solve(std::span<const double> right, std::span<double> result) final;
  void solve_transposed(std::span<const double> right, std::span<double> result) final;
  void propose_motion(std::span<const double> motion) final;
  void propose_drift(double time_step) final;
  Vector3 proposed_motion(int site) const final;

  /// Adds H^T effort of the last take_rows(). @param effort (all rows,) N. @param sum (size(),) N.
  void add_row_forces(std::span<const double> effort, VectorX& sum) const {
    rows_.add_forces(effort, sum);
  }
  virtual std::size_t bytes() const;

 protected:
  /// @param size number of coordinates, three for each block. @param plan must outlive this.
  /// @param held coordinates that do not move, ascending; must outlive this.
  SparseStep(std::size_t size, const SparseRowPlan& plan, std::span<const std::int32_t> held);

  /// Computes b and A at the current state. @param request tangent and weights.
  /// @param right (size,). @param system the matrix, valid until the next call.
  /// @return force_scale().
  virtual double form(const LinearisationRequest& request, VectorX& right,
                      SparseSystem& system) = 0;
  /// Completes A before it is factorised, after all that form() and constraints add. Held
  /// coordinates have zero rows and columns with a non-zero diagonal from then on.
  virtual void complete_matrix() = 0;
  /// Called when something was added to the matrix.
  virtual void changed_matrix() {}
  /// Called when the proposed motion starts from the current state.
  virtual void depart() = 0;
  /// (size,) motion: time_step times the velocities at the start of the step. The motion starts
  /// from the current state.
  virtual void drift(double time_step, VectorX& motion) = 0;

  /// Whether A has no unsymmetric part B, which the factor leaves out.
  virtual bool is_symmetric() const { return true; }
  /// Given A_s^-1 r in `motion`, computes (A_s + B)^-1 r, or (A_s + B^T)^-1 r. Only called unless
  /// is_symmetric().
  virtual void correct(linalg::Factorisation& factor, VectorX& motion, bool transposed) const;

  /// Remembers the directions of the material, since A is factorised there.
  virtual void keep_directions() {}
  /// Measures by how much the material has turned since (see renew()).
  /// @return false: the body does not know. turn() and turn_back() are then not called.
  virtual bool measure_turns() { return false; }
  /// v = R v with the turns R measured. @param v (size,).
  virtual void turn(VectorX& v) const;
  /// v = R^T v. @param v (size,).
  virtual void turn_back(VectorX& v) const;

  const VectorX& motion() const { return motion_; }
  /// b + H^T effort of the last linearisation, N. Valid until the next call of this object.
  const VectorX& imbalance(std::span<const double> effort);

 private:
  void solve_for_imbalance();
  void hold(VectorX& v) const;

  std::span<const std::int32_t> held_;
  SparseRows rows_;
  TouchedBlocks touched_blocks_;
  SparseSystem system_;
  bool turned_ = false;  // whether the factor is used at a later state, with turns
  VectorX right_, motion_;
  VectorX imbalance_;   // b + H^T effort, N
  VectorX subtracted_;  // N, empty until subtract_residual() is called
  bool subtracts_ = false;
  // What b the factor contains: right_; right_ + H^T base_effort_; another one.
  enum class Content { right, imbalance, other };
  Content content_ = Content::other;
  std::vector<double> base_effort_, effort_change_;  // (border rows,) N
  double force_scale_ = 0.0;                         // N
};

}  // namespace sinew::mechanics
