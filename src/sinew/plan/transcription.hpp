/// @file
/// Transcriptions of motion onto knots. The equations of motion are enforced at stages. Position,
/// rate and acceleration of a stage, and the defects between two knots, are linear in the variables
/// of the knots, with weights that depend only on the interval h.
///
/// Backward Euler has knots (q, v): q1 = q0 + h v1, with one stage at the end of the interval,
/// where a = (v1 - v0)/h. The torque is constant over the interval, with the value at its end.
///
/// Radau IIA has three stages and order five (Hairer & Wanner, Solving Ordinary Differential
/// Equations II, 1996, IV.5, table 5.6). It is used in implicit form with knots (q, v, a). With
/// stages at c_i and accelerations a_1, a_2, and a_3 = a of the second knot,
///   v_i = v0 + h sum_j A_ij a_j,   q_i = q0 + c_i h v0 + h^2 sum_j (A A)_ij a_j,
/// where the last rows are the second knot. Since (A A)_3j = b_j (1 - c_j), the two equations
///   b_1 a_1 + b_2 a_2 = (v1 - v0)/h - b_3 a_3,
///   b_1 (1 - c_1) a_1 + b_2 (1 - c_2) a_2 = (q1 - q0 - h v0)/h^2,
/// determine a_1 and a_2. So all stages follow from the knots, there is no defect, and a knot has
/// as many unknowns as an interval has equations of motion. The mass matrix, which is nearly
/// singular for lumped masses, is never inverted. The torque is linear over the interval.
///
/// Radau IIA is stiffly accurate and L-stable: damped modes that are faster than the knots follow
/// the torque, as in reality. In methods whose stability function tends to 1, such as
/// Hermite-Simpson (Lobatto IIIA), a mode excited by a kink of the torque does not decay. An
/// optimiser exploits this, and its motion then differs from that of the arm, however fine the
/// knots are.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::plan {

enum class CollocationMethod { backward_euler, radau };
/// "backward-euler", "radau".
std::string_view method_name(CollocationMethod method);

/// A linear map of the variables of two knots, with its derivatives with respect to h. Columns are
/// the blocks of the first knot, then those of the second.
struct Weights {
  MatrixX value, slope, bend;  ///< (rows, 2 blocks): the map, d/dh, d2/dh2
};

/// A stage of an interval.
struct CollocationStage {
  Weights state;          ///< rows are position, rate, acceleration
  double time = 0.0;      ///< position in the interval, 0 to 1
  double fraction = 0.0;  ///< quadrature weight in the interval
};

/// The transcription of one interval.
struct Transcription {
  int blocks = 0;                        ///< per knot: 2 (q, v) or 3 (q, v, a)
  std::vector<CollocationStage> stages;  ///< of an interval
  Weights defect;                        ///< constrained to zero; one row or none

  /// @param method of the transcription. @param h interval, s, > 0.
  Transcription(CollocationMethod method, double h);
  int defects() const { return static_cast<int>(defect.value.rows()); }

 private:
  void set_euler(double h);
  void set_radau(double h);
};

}  // namespace sinew::plan
