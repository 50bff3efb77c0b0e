/// @file
/// Estimates external forces from sensors: the first inverse problem of a high-rate loop.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/high_rate/high_rate_settings.hpp"
#include "sinew/high_rate/touch_law.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::high_rate {

/// Estimator of the unknown forces f. C is the Jacobian of the sensors' rows with respect to f
/// (with contacts and hands responding by their laws), y the readings, m the model's motions
/// without f, N the noise and P the prior:
///   min  1/2 |C f + m - y|^2 / N^2 + 1/2 |f|^2 / P^2   s.t.  limits on f.
/// These are the most likely forces for Gaussian noise and a Gaussian prior of mean zero
/// (Tarantola, Inverse Problem Theory, SIAM 2005, sec. 3.2). Their covariance is (C^T N^-2
/// C + P^-2)^-1; a deviation near that of the prior means that no sensor sees the force. Model
/// errors (such as a wrong stiffness, or the drift of a sensor) are taken for forces.
class ForceEstimate {
 public:
  /// @param settings must outlive this object.
  explicit ForceEstimate(const HighRateSettings& settings);

  /// Estimates the forces; allocates nothing. @param law at the present positions of the hands.
  /// @param driven (driven,) N, the efforts that acted when the sensors were read.
  /// @param readings (sensors,) m or rad; not finite: not measured.
  /// @param unknown (unknown,) N: gets the forces. @return false if the program failed; `unknown`
  ///   is then unchanged.
  bool solve(const TouchLaw& law, const VectorX& driven, const VectorX& readings,
             Eigen::Ref<VectorX> unknown);
  /// The objective by the present law. @param law,driven,readings as in solve().
  /// @param unknown (unknown,) N.
  double misfit(const TouchLaw& law, const VectorX& driven, const VectorX& readings,
                const VectorX& unknown) const;
  /// Standard deviations of the last solve(), (unknown,) N, as if no limit were active.
  const VectorX& deviation() const { return deviation_; }

 private:
  const HighRateSettings& settings_;
  qp::QuadraticProgram program_;
  qp::QpSolver solver_;
  linalg::CholeskyFactor factor_;
  VectorX column_, deviation_;  // (unknown,)
};

}  // namespace sinew::high_rate
