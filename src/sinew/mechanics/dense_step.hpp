/// @file
/// Steps of a body with few generalised coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mechanics/own_rows.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::mechanics {

/// StepSystem with a dense matrix A, which may be unsymmetric. All rows on attached sites have a
/// column, which is zero while a row is not active; rows on the surface of the body have one only
/// while active. Derived classes define the equation of the body, the Jacobians of its sites, and
/// how a motion changes its state.
class DenseStep : public StepSystem {
 public:
  void linearise(const LinearisationRequest& request) final;
  void add_geometric_stiffness(const StiffnessPair& pair) final;
  void take_rows(const RowValues& rows) final;
  void retake_rows(const RowValues& rows) final;
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
  Vector3 proposed_motion(int site) const final;
  void solve(std::span<const double> right, std::span<double> result) final;
  void solve_transposed(std::span<const double> right, std::span<double> result) final;
  void propose_motion(std::span<const double> motion) final;
  void propose_drift(double time_step) final;

  virtual std::size_t bytes() const;

 protected:
  /// @param coordinates n. @param own,memory must outlive this.
  DenseStep(Eigen::Index coordinates, const OwnRows& own, RowMemory& memory);

  /// Computes b and A at the current state. @param request tangent and weights.
  /// @param right (n,). @param matrix (n, n).
  /// @return force_scale().
  virtual double form(const LinearisationRequest& request, VectorX& right, MatrixX& matrix) = 0;
  /// A -= sum over entries of effort direction . d2(motion of the site)/dq2, with the efforts and
  /// directions of RowMemory and of surface_rows().
  virtual void add_row_stiffness(MatrixX& matrix) = 0;
  /// Jacobian of the motion of a site. @param site its number on the body.
  /// @param result (3, n).
  virtual void site_jacobian(int site, MatrixX& result) const = 0;
  /// Jacobian of the displacement of a point of the surface. Bodies without a surface throw
  /// Error(internal).
  virtual void patch_jacobian(const Patch& patch, MatrixX& result) const;
  /// Smallest eigenvalue that the corotated tangent of an indefinite A may have.
  virtual double softest() const = 0;
  /// Called when the proposed motion starts from the current state.
  virtual void depart() = 0;
  /// (n,) motion: time_step times the current rates.
  virtual void drift(double time_step, VectorX& motion) const = 0;

  const VectorX& motion() const { return motion_; }
  const MatrixX& matrix() const { return matrix_; }
  /// Whether further linearisations of this step may follow.
  bool iterating() const { return iterating_; }
  /// Whether A is to be a majorant of the derivative, see Tangent::projected.
  bool projected() const { return projected_; }
  /// A row on the surface, from the last take_rows().
  struct SurfaceRow {
    std::int32_t row = 0;  // of the world
    Vector3 direction = Vector3::Zero();
    Patch patch;
    double effort = 0.0;  // N, last known in this step
  };
  /// Active rows on the surface, ascending.
  const std::vector<SurfaceRow>& surface_rows() const { return surface_rows_; }
  /// Clears them at the beginning of a step, since their points are found anew.
  void forget_surface_rows() { surface_rows_.clear(); }

 private:
  void take_lasting_rows(const RowValues& rows);
  void take_surface_rows(const RowValues& rows);
  void take_shares(const RowGroups& groups);
  void make_room(Eigen::Index columns);
  std::int32_t world_row(Eigen::Index column) const;
  double known_effort(Eigen::Index column) const;  // N
  void find_imbalance(std::span<const double> effort);
  void make_definite();
  void respond();

  const OwnRows& own_;
  RowMemory& memory_;
  VectorX right_, motion_, scratch_;
  VectorX subtracted_;
  VectorX gross_;  // of one row: sum of the magnitudes of its terms, to tell rounding from zero
  bool subtracts_ = false;
  MatrixX matrix_, symmetric_;
  mutable MatrixX jacobian_;          // (3, n), of sites: scratch
  MatrixX second_jacobian_, pulled_;  // (3, n), scratch
  linalg::LuFactor decomposed_, symmetric_factor_;
  linalg::SymmetricPivots pivots_;
  linalg::SymmetricSpectrum spectrum_;
  bool definite_wanted_ = true;
  bool is_symmetric_ = true;  // A of the last condensation
  bool iterating_ = false;
  bool projected_ = false;
  std::vector<SurfaceRow> surface_rows_, surface_rows_before_;
  std::vector<double> shares_;  // (columns,) shares in RowGroups; empty: all are 1
  // Columns in use: those of own_.rows, then of surface_rows_. The arrays may have more columns.
  Eigen::Index columns_ = 0;
  MatrixX rows_, moved_rows_;  // (n, columns): H^T, A^-1 H^T
  MatrixX soft_rows_;          // A_s^-1 H^T, with A_s the symmetric part of A
  VectorX free_motion_, effort_;
  // A column whose row is in the problem of the step: the column, its row there, and its share.
  struct ProblemRow {
    Eigen::Index column;
    int row;
    double share;
  };
  mutable std::vector<ProblemRow> problem_rows_;
  double force_scale_ = 1.0;
};

}  // namespace sinew::mechanics
