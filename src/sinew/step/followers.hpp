/// @file
/// Rows whose efforts follow from those of all others, by linear equations: held rows, drives'
/// curves and blocks of stiffness.
#pragma once

#include <span>
#include <vector>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::step {

/// A row d whose linearised law is
///   delta_d + c lambda_d = m,
/// held at a motion m (c = 0), on a drive's curve lambda = e + s (delta - m_0), s < 0, where
/// c = -1/s and m = m_0 + c e, or of a block of stiffness (c = 1/stiffness, m where the row is).
/// Over all such rows D, with those of the other unknown efforts O,
///   (W_DD + C) lambda_D = m - delta_free_D - W_DO lambda_O,
/// and taken out of delta = delta_free + W lambda they leave the others with
///   W_OO - W_OD (W_DD + C)^-1 W_DO.
/// What remains is positive definite where the robot with its drives is stable, even if the robot
/// alone is not: an inflated balloon beyond its pressure's peak, held at its volume.
///
/// W_DD + C is scaled to a diagonal of one. Where rows repeat each other (twin ties, an edge held
/// twice) it is singular, and the efforts of least norm are taken.
class Followers {
 public:
  void clear() { rows_.clear(); }
  void add_held(int row, double motion, double compliance = 0.0) {
    rows_.push_back({row, nullptr, 0.0, motion, compliance});
  }
  /// @param block with a drive. @param motion where its curve is linearised first.
  void add_curve(const ActuatorBlock& block, double motion) {
    rows_.push_back({block.row, &block, motion, 0.0, 0.0});
  }
  bool has_curves() const;

  /// Linearises the curves and takes the rows out.
  /// @param problem of the step. @param free (rows,) m: delta where all unknown efforts are zero.
  /// @param others rows of the unknown efforts that stay.
  /// @param compliance (others, others), @param motion (others,): what these then see.
  void take_out(const StepProblem& problem, const VectorX& free, std::span<const int> others,
                Eigen::Ref<MatrixX> compliance, Eigen::Ref<VectorX> motion);
  /// Efforts of the rows from those of the others; curves are linearised there next.
  /// @param problem,free,others as for take_out(). @param effort (rows,) N, those of the rows are
  /// written. @return the farthest that a curve was left, relative to the effort.
  double close(const StepProblem& problem, const VectorX& free, std::span<const int> others,
               std::span<double> effort);

 private:
  struct Row {
    int row;
    const ActuatorBlock* curve;  // null: held
    double at;                   // m, where the curve is linearised
    double motion;               // m
    double compliance;           // c
  };

  void factorise(const StepProblem& problem);

  std::vector<Row> rows_;
  VectorX scale_;  // (followers,) 1/sqrt of the diagonal
  MatrixX own_;    // (followers, followers) scaled W_DD + C
  linalg::LuFactor factor_;
  bool singular_ = false;
  MatrixX inverse_;  // where it is
  MatrixX right_, solved_;
};

}  // namespace sinew::step
