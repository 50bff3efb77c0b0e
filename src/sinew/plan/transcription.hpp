/// @file
/// Transcriptions of motion onto knots. Position, rate and acceleration at every stage at which the
/// equations of motion are enforced are linear in what the knots hold, with weights that depend on
/// the interval h alone; so are the defects that join two knots.
///
/// Backward Euler, knots (q, v): q1 = q0 + h v1, stage at the end with a = (v1 - v0)/h; torque
/// constant over the interval, that of its end.
///
/// Radau IIA of three stages, order five (Hairer & Wanner, Solving Ordinary Differential Equations
/// II, 1996, IV.5, table 5.6), in implicit form, knots (q, v, a): with stages at c_i and
/// accelerations a_1, a_2, a_3 = a of the second knot,
///   v_i = v0 + h sum_j A_ij a_j,   q_i = q0 + c_i h v0 + h^2 sum_j (A A)_ij a_j,
/// whose last rows are the second knot. As (A A)_3j = b_j (1 - c_j), these two,
///   b_1 a_1 + b_2 a_2 = (v1 - v0)/h - b_3 a_3,
///   b_1 (1 - c_1) a_1 + b_2 (1 - c_2) a_2 = (q1 - q0 - h v0)/h^2,
/// give a_1 and a_2, so that all stages follow from the knots, there is no defect, and a knot has
/// as many unknowns as an interval has equations of motion. The mass matrix, nearly singular for
/// lumped masses, is never inverted. Torque is linear over the interval.
///
/// The method is stiffly accurate and L-stable: the arm's damped modes that are faster than the
/// knots follow the torque, as they do in truth. Methods whose stability function tends to 1, such
/// as Hermite-Simpson (Lobatto IIIA), keep what a kink of torque sets off in them; an optimiser
/// finds that out, and its motion is then not the arm's, however fine the knots.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::plan {

enum class CollocationMethod { backward_euler, radau };
/// "backward-euler", "radau".
std::string_view method_name(CollocationMethod method);

/// A linear map of what two knots hold, with its derivatives by h. Columns: the blocks of the first
/// knot, then those of the second.
struct Weights {
  MatrixX value, slope, bend;  ///< (rows, 2 blocks): itself, d/dh, d2/dh2
};

struct CollocationStage {
  Weights state;          ///< rows: position, rate, acceleration
  double time = 0.0;      ///< where in the interval it is, 0 to 1
  double fraction = 0.0;  ///< of the interval in integrals over it
};

struct Transcription {
  int blocks = 0;                        ///< a knot holds: q, v and, with 3, a
  std::vector<CollocationStage> stages;  ///< of an interval
  Weights defect;                        ///< zero; one row or none

  /// @param method which one. @param h interval, s, > 0.
  Transcription(CollocationMethod method, double h);
  int defects() const { return static_cast<int>(defect.value.rows()); }

 private:
  void set_euler(double h);
  void set_radau(double h);
};

}  // namespace sinew::plan
