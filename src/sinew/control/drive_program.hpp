/// @file
/// From force or motion to actuation: the second inverse problem of a high-rate loop.
#pragma once

#include "sinew/control/high_rate_settings.hpp"
#include "sinew/control/touch_law.hpp"
#include "sinew/core/types.hpp"
#include "sinew/qp/elastic.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::control {

/// With J how tasks follow from the driven efforts a (hands and contacts answering by their laws),
/// e the tasks without them, less what is asked, and Q the weights,
///   min  1/2 |J a + e|_Q^2 + eps/2 |a - a_0|_R^2   s.t. limits on efforts, their rates and
///   motions,
/// where a_0 are the last efforts, R is W_aa with a millionth of its diagonal added, and
/// eps = epsilon |J^T Q J|_inf / |R|_inf: the program of inverse::InverseController (Coevoet,
/// Escande & Duriez, IEEE RA-L 2(3), 2017, section III-C) with Regularisation::change.
/// Motions' limits give way where they contradict those of efforts (qp::ElasticSolver).
class DriveProgram {
 public:
  /// @param settings outlive it.
  explicit DriveProgram(const HighRateSettings& settings);

  /// Where tasks are without driven efforts, and what is asked of them.
  struct Asked {
    const Snapshot& snapshot;
    const TouchLaw& law;
    const VectorX& unknown;  ///< (unknown,) N
    const VectorX& before;   ///< (driven,) N, a_0
    const VectorX& targets;  ///< (tasks,) m, rad or N; not finite: nothing is asked
  };
  enum class Status { solved, limits_conflict, failed };
  /// Allocates nothing. @param asked see there. @param driven (driven,) N gets the efforts, unless
  /// it failed.
  Status solve(const Asked& asked, Eigen::Ref<VectorX> driven);
  /// 1/2 |tasks - targets|_Q^2 by the law as it is now, of targets as the last solve() shortened
  /// them. @param asked see there. @param driven (driven,) N.
  double missed(const Asked& asked, const VectorX& driven) const;
  /// Whether efforts keep the limits of the last solve(), those of motions included.
  bool keeps_limits(const VectorX& driven) const;

 private:
  template <typename Visit>
  void for_each_task(const Asked& asked, Visit&& visit) const;
  void form_tasks(const Asked& asked);
  void shorten(const Asked& asked);
  void regularise(const Asked& asked);
  void form_limits(const Asked& asked);

  const HighRateSettings& settings_;
  VectorX scale_;     // (driven,) N: unknowns are efforts over these
  MatrixX jacobian_;  // (tasks, driven) of scaled efforts
  MatrixX weighted_;  // Q J
  VectorX residual_;  // (tasks,) e
  VectorX goal_;      // (tasks,) targets, shortened
  VectorX weight_;    // (tasks,) of those that are asked
  qp::QuadraticProgram program_;
  qp::QpSolver solver_;
  qp::ElasticSolver elastic_;
};

}  // namespace sinew::control
