/// @file
/// What is known of the efforts that a controller chose: whether all laws hold at them, whether the
/// laws have another solution there, and what kind of optimum they are.
#pragma once

#include <span>
#include <string_view>

#include "sinew/qp/cone_solver.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::step {

class Controller;

/// Of a mathematical program with complementarity constraints, by the multipliers gamma of the
/// limit of a block's state and nu of that of the state beyond, for blocks that are at both (a
/// contact with neither gap nor force). Source: H. Scheel and S. Scholtes, Math. Oper. Res. 25
/// (2000) 1-22, section 2; J. J. Ye, J. Math. Anal. Appl. 307 (2005) 350-369.
enum class Stationarity {
  none,          ///< the objective falls although all these blocks stay at both limits
  weak,          ///< W: it does not
  clarke,        ///< C: gamma nu >= 0
  mordukhovich,  ///< M: gamma and nu > 0, or gamma nu = 0
  strong,        ///< S: gamma and nu >= 0; then B-stationary
};
/// "none", "W", "C", "M" or "S".
std::string_view stationarity_name(Stationarity stationarity);

struct Certificate {
  double violation = 0.0;  ///< m, of all laws by efforts and motions, see violation()
  double stays = 0.0;      ///< m: by how much the direct law, started there, changes any motion
  /// m: the same of the direct law started without forces; more than rounding where the laws have
  /// several solutions at these efforts.
  double cold = 0.0;
  int between = 0;  ///< blocks at the limits of two states
  int pieces = 0;   ///< whose optima were compared; 0: there was no need
  Stationarity stationarity = Stationarity::none;
  /// B-stationary: no piece that meets there leads on. By strong stationarity, or because all
  /// 2^between pieces were compared (up to kMaxBetween). With friction, of the pieces at the
  /// directions of slip that were found.
  bool best_nearby = false;

  static constexpr int kMaxBetween = 10;
};

/// @param problem of the step. @param controller whose last choice `effort` is.
/// @param effort (rows,) N, after the law's solution. @param settings of the direct law.
Certificate certify(const StepProblem& problem, Controller& controller,
                    std::span<const double> effort, const qp::ConeSettings& settings);

}  // namespace sinew::step
