/// @file
/// From sensors to outside forces: the first inverse problem of a high-rate loop.
#pragma once

#include "sinew/control/high_rate_settings.hpp"
#include "sinew/control/touch_law.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::control {

/// With C how the sensors' rows follow from the unknown forces f (contacts and hands answering by
/// their laws), y the readings, m the model's motions without f, N the noise and P the prior,
///   min  1/2 |C f + m - y|^2 / N^2 + 1/2 |f|^2 / P^2   s.t.  limits on f:
/// the most likely forces for normal noise and a normal prior of mean zero (Tarantola, Inverse
/// Problem Theory, SIAM 2005, sec. 3.2). Their covariance is (C^T N^-2 C + P^-2)^-1; a deviation
/// near the prior's says that no sensor sees the force. What the model does not know (another
/// stiffness, drift of a sensor) is taken for force.
class ForceEstimate {
 public:
  /// @param settings outlive it.
  explicit ForceEstimate(const HighRateSettings& settings);

  /// Allocates nothing. @param law at the present hands. @param driven (driven,) N, that acted when
  /// the sensors were read. @param readings (sensors,) m or rad; not finite: not measured.
  /// @param unknown (unknown,) N: gets the forces. False where the program failed, which then is
  /// left as it was.
  bool solve(const TouchLaw& law, const VectorX& driven, const VectorX& readings,
             Eigen::Ref<VectorX> unknown);
  /// The objective by the law as it is now. @param law,driven,readings as in solve().
  /// @param unknown (unknown,) N.
  double misfit(const TouchLaw& law, const VectorX& driven, const VectorX& readings,
                const VectorX& unknown) const;
  /// (unknown,) N: standard deviations of the last solve(), as if no limit bound.
  const VectorX& deviation() const { return deviation_; }

 private:
  const HighRateSettings& settings_;
  qp::QuadraticProgram program_;
  qp::QpSolver solver_;
  linalg::CholeskyFactor factor_;
  VectorX column_, deviation_;  // (unknown,)
};

}  // namespace sinew::control
