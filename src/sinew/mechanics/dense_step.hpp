/// @file
/// A body of few coordinates in a step.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mechanics/own_rows.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::mechanics {

/// A is dense and may be unsymmetric. Rows on sites that stay are all taken, also those that are
/// left out elsewhere; of those on the body's surface, the active ones. What the body's equation
/// is, how its sites move, and what a motion does to its state is said by those who derive from it.
class DenseStep : public StepSystem {
 public:
  void linearise(const LinearisationRequest& request) final;
  void add_geometric_stiffness(const StiffnessPair& pair) final;
  void take_rows(const RowValues& rows) final;
  void retake_rows(const RowValues& rows) final;
  Inertia condense() final;
  void add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                      VectorX& free_motion) const final;

  std::size_t size() const final { return static_cast<std::size_t>(motion_.size()); }
  double residual(std::span<const double> effort, std::span<double> imbalance) final;
  double force_scale() const final { return force_scale_; }
  void lessen(std::span<const double> force) final;

  void solve_motion(std::span<const double> effort) final;
  Vector3 proposed_motion(int site) const final;
  void solve(std::span<const double> right, std::span<double> result) final;
  void propose_motion(std::span<const double> motion) final;
  void propose_drift(double time_step) final;

  virtual std::size_t bytes() const;

 protected:
  /// @param coordinates n. @param own,memory must outlive this.
  DenseStep(Eigen::Index coordinates, const OwnRows& own, RowMemory& memory);

  /// Writes b and A of the present state. @param request which A, for what step.
  /// @param right (n,). @param matrix (n, n).
  /// @return force_scale().
  virtual double form(const LinearisationRequest& request, VectorX& right, MatrixX& matrix) = 0;
  /// A -= sum over entries of effort direction . d2(motion of the site)/dq2, at the efforts and
  /// directions remembered, and those of surface_rows().
  virtual void add_row_stiffness(MatrixX& matrix) = 0;
  /// The motion of a site for each coordinate. @param site its number on the body.
  /// @param result (3, n).
  virtual void site_jacobian(int site, MatrixX& result) const = 0;
  /// The same of a point of the surface. Asked of bodies that have one; others throw
  /// Error(internal).
  virtual void patch_jacobian(const Patch& patch, MatrixX& result) const;
  /// The softest that a corotated tangent lets a direction be: see Tangent.
  virtual double softest() const = 0;
  /// The motion proposed next starts from the present state.
  virtual void depart() = 0;
  /// (n,) of the rates.
  virtual void drift(double time_step, VectorX& motion) const = 0;

  const VectorX& motion() const { return motion_; }
  const MatrixX& matrix() const { return matrix_; }
  /// Whether further linearisations of this step may follow.
  bool iterating() const { return iterating_; }
  /// A row on the surface as it was taken last.
  struct SurfaceRow {
    std::int32_t row = 0;  // of the world's
    Vector3 direction = Vector3::Zero();
    Patch patch;
    double effort = 0.0;  // N, as known last in this step
  };
  /// The active ones, ascending.
  const std::vector<SurfaceRow>& surface_rows() const { return surface_rows_; }
  /// When a step begins, since their points are found anew.
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
  VectorX lessening_;
  VectorX gross_;  // of a row: the sum of what its entries could be at most
  bool lessens_ = false;
  MatrixX matrix_, symmetric_;
  mutable MatrixX jacobian_;          // (3, n), of sites: scratch
  MatrixX second_jacobian_, pulled_;  // likewise
  linalg::LuFactor decomposed_, symmetric_factor_;
  linalg::SymmetricPivots pivots_;
  linalg::SymmetricSpectrum spectrum_;
  bool definite_wanted_ = true;
  bool is_symmetric_ = true;  // A, of the last condensation
  bool iterating_ = false;
  std::vector<SurfaceRow> surface_rows_, surface_rows_before_;
  std::vector<double> shares_;  // (columns,) of their efforts in groups; empty: all are 1
  // Columns in use: those of the own rows that stay, then of surface_rows_. There is room for more.
  Eigen::Index columns_ = 0;
  MatrixX rows_, moved_rows_;  // (n, columns): H^T, A^-1 H^T
  MatrixX soft_rows_;          // the same of the symmetric part of A
  VectorX free_motion_, effort_;
  // Of the columns that are in a step's problem: which, and where there.
  struct ProblemRow {
    Eigen::Index column;
    int row;
    double share;
  };
  mutable std::vector<ProblemRow> problem_rows_;
  double force_scale_ = 1.0;
};

}  // namespace sinew::mechanics
