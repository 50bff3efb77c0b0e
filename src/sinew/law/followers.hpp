/// @file
/// Rows whose efforts follow from the other efforts by linear equations: held rows, curves of
/// drives and blocks of stiffness.
#pragma once

#include <span>
#include <vector>

#include "sinew/law/step_problem.hpp"
#include "sinew/linalg/dense_factor.hpp"

namespace sinew::law {

/// Eliminates rows d with the linearised law
///   delta_d + c lambda_d = m:
/// rows held at a motion m (c = 0), rows on a drive's curve lambda = e + s (delta - m_0), s < 0,
/// with c = -1/s and m = m_0 + c e, and blocks of stiffness (c = 1/stiffness, m the present
/// motion). With D all such rows and O the other unknown efforts,
///   (W_DD + C) lambda_D = m - delta_free_D - W_DO lambda_O.
/// Their elimination from delta = delta_free + W lambda leaves the others with the Schur complement
///   W_OO - W_OD (W_DD + C)^-1 W_DO.
/// It is positive definite if the robot with its drives is stable, even if the robot alone is not,
/// such as an inflated balloon beyond its pressure peak that is held at its volume.
///
/// W_DD + C is scaled to a unit diagonal. If rows are redundant (twin ties, an edge held twice) it
/// is singular, and the efforts of least norm are taken.
class Followers {
 public:
  void clear() { rows_.clear(); }
  void add_held(int row, double motion, double compliance = 0.0) {
    rows_.push_back({row, nullptr, 0.0, motion, compliance});
  }
  /// Adds a drive. @param block with a drive. @param motion at which its curve is first linearised.
  void add_curve(const ActuatorBlock& block, double motion) {
    rows_.push_back({block.row, &block, motion, 0.0, 0.0});
  }
  bool has_curves() const;

  /// Linearises the curves and eliminates the rows.
  /// @param problem of the step. @param free (rows,) m: delta for zero unknown efforts.
  /// @param others rows of the unknown efforts that remain.
  /// @param compliance (others, others) and @param motion (others,) of the reduced problem.
  void take_out(const StepProblem& problem, const VectorX& free, std::span<const int> others,
                Eigen::Ref<MatrixX> compliance, Eigen::Ref<VectorX> motion);
  /// Computes the efforts of the rows from those of the others. Curves are next linearised there.
  /// @param problem,free,others as for take_out().
  /// @param effort (rows,) N, those of the rows are written.
  /// @return largest distance of an effort from its curve, relative to the effort.
  double close(const StepProblem& problem, const VectorX& free, std::span<const int> others,
               std::span<double> effort);

 private:
  struct Row {
    int row;
    const ActuatorBlock* curve;  // null: held
    double at;                   // m, at which the curve is linearised
    double motion;               // m
    double compliance;           // c
  };

  void factorise(const StepProblem& problem);

  std::vector<Row> rows_;
  VectorX scale_;  // (followers,) 1/sqrt of the diagonal
  MatrixX own_;    // (followers, followers) scaled W_DD + C
  linalg::LuFactor factor_;
  bool singular_ = false;
  MatrixX inverse_;  // pseudoinverse, if singular_
  MatrixX right_, solved_;
};

}  // namespace sinew::law
