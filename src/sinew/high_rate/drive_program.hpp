/// @file
/// Finds the actuation for requested motions or forces: the second inverse problem of a high-rate
/// loop.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/high_rate/high_rate_settings.hpp"
#include "sinew/high_rate/touch_law.hpp"
#include "sinew/qp/elastic.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::high_rate {

/// The quadratic program for the driven efforts a. J is the Jacobian of the tasks with respect to a
/// (with hands and contacts responding by their laws), e the value of the tasks without a, minus
/// the targets, and Q the weights:
///   min  1/2 |J a + e|_Q^2 + eps/2 |a - a_0|_R^2   s.t. limits on efforts, their rates and
///   motions,
/// where a_0 are the last efforts, R is W_aa with a millionth of its diagonal added, and
/// eps = epsilon |J^T Q J|_inf / |R|_inf. It is the program of control::InverseController (Coevoet,
/// Escande & Duriez, IEEE RA-L 2(3), 2017, section III-C) with Regularisation::change. If limits of
/// motions contradict those of efforts, the limits of motions give way (qp::ElasticSolver).
class DriveProgram {
 public:
  /// @param settings must outlive this object.
  explicit DriveProgram(const HighRateSettings& settings);

  /// The state of the model and the targets of the tasks.
  struct Asked {
    const Snapshot& snapshot;
    const TouchLaw& law;
    const VectorX& unknown;  ///< (unknown,) N
    const VectorX& before;   ///< (driven,) N, a_0
    const VectorX& targets;  ///< (tasks,) m, rad or N; not finite: no target
  };
  enum class Status { solved, limits_conflict, failed };
  /// Solves the program; allocates nothing. @param asked model and targets.
  /// @param driven (driven,) N, gets the efforts unless it failed.
  Status solve(const Asked& asked, Eigen::Ref<VectorX> driven);
  /// 1/2 |tasks - targets|_Q^2 by the present law, for the targets as shortened by the last
  /// solve().
  /// @param asked model and targets. @param driven (driven,) N.
  double missed(const Asked& asked, const VectorX& driven) const;
  /// Whether efforts meet the limits of the last solve(), including those of motions.
  bool keeps_limits(const VectorX& driven) const;

 private:
  template <typename Visit>
  void for_each_task(const Asked& asked, Visit&& visit) const;
  void form_tasks(const Asked& asked);
  void shorten(const Asked& asked);
  void regularise(const Asked& asked);
  void form_limits(const Asked& asked);

  const HighRateSettings& settings_;
  VectorX scale_;     // (driven,) N: the unknowns are efforts divided by these
  MatrixX jacobian_;  // (tasks, driven) of scaled efforts
  MatrixX weighted_;  // Q J
  VectorX residual_;  // (tasks,) e
  VectorX goal_;      // (tasks,) targets, shortened
  VectorX weight_;    // (tasks,) weights; 0 without a target
  qp::QuadraticProgram program_;
  qp::QpSolver solver_;
  qp::ElasticSolver elastic_;
};

}  // namespace sinew::high_rate
