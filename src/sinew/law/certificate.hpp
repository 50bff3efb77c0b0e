/// @file
/// Certificate of the efforts that a controller chose: whether they obey all laws, whether the laws
/// have another solution there, and the kind of optimum.
#pragma once

#include <span>
#include <string_view>

#include "sinew/law/step_problem.hpp"
#include "sinew/qp/cone_solver.hpp"

namespace sinew::law {

class Controller;

/// Stationarity of a mathematical program with complementarity constraints. It follows from the
/// multipliers gamma of the limit of a block's state and nu of that of the state beyond, for blocks
/// at the limits of two states (such as a contact with neither gap nor force). Source: H. Scheel
/// and S. Scholtes, Math. Oper. Res. 25 (2000) 1-22, section 2; J. J. Ye, J. Math. Anal. Appl. 307
/// (2005) 350-369.
enum class Stationarity {
  none,          ///< the objective decreases even if all these blocks stay at both limits
  weak,          ///< W: the objective does not decrease if they do
  clarke,        ///< C: gamma nu >= 0
  mordukhovich,  ///< M: gamma and nu > 0, or gamma nu = 0
  strong,        ///< S: gamma and nu >= 0; then B-stationary
};
/// "none", "W", "C", "M" or "S".
std::string_view stationarity_name(Stationarity stationarity);

/// Findings about a controller's choice.
struct Certificate {
  double violation = 0.0;  ///< m, largest violation of all laws, see violation()
  double stays = 0.0;      ///< m: largest change of a motion by the direct solver, started there
  /// m: the same for the direct solver started without forces. It exceeds rounding if the laws have
  /// several solutions at these efforts.
  double cold = 0.0;
  int between = 0;  ///< number of blocks at the limits of two states
  int pieces = 0;   ///< number of pieces whose optima were compared; 0: not needed
  Stationarity stationarity = Stationarity::none;
  /// B-stationary: no adjacent piece decreases the objective. It follows from strong stationarity,
  /// or from comparing all 2^between pieces (up to kMaxBetween). With friction, it holds for the
  /// pieces at the present directions of slip.
  bool best_nearby = false;

  static constexpr int kMaxBetween = 10;
};

/// Certifies a choice. @param problem of the step. @param controller that made the choice `effort`.
/// @param effort (rows,) N, after the law's solution. @param settings of the direct solver.
Certificate certify(const StepProblem& problem, Controller& controller,
                    std::span<const double> effort, const qp::ConeSettings& settings);

}  // namespace sinew::law
