/// @file
/// Transcriptions of motion onto knots. Position, rate and acceleration at every stage at which the
/// equations of motion are enforced are linear in what the knots hold, with weights that depend on
/// the interval h alone; so are the defects that join two knots.
///
/// Backward Euler, knots (q, v): q1 = q0 + h v1, stage at the end with a = (v1 - v0)/h; torque
/// constant over the interval, that of its end.
///
/// Hermite-Simpson (Hargraves & Paris, J. Guidance 10, 1987; Kelly, SIAM Review 59, 2017, sec. 4)
/// in implicit form, knots (q, v, a): of its equations
///   v_c = (v0 + v1)/2 + h/8 (a0 - a1),   q_c = (q0 + q1)/2 + h/8 (v0 - v1),
///   v1 = v0 + h/6 (a0 + 4 a_c + a1),     q1 = q0 + h/6 (v0 + 4 v_c + v1)
/// the third is solved for a_c and the first put into the fourth, which leaves one linear defect
///   q1 = q0 + h/2 (v0 + v1) + h^2/12 (a0 - a1)
/// and the equations of motion at the knots and the middle. The mass matrix, nearly singular for
/// lumped masses, is never inverted. Torque is linear over the interval.
///
/// Its stability function tends to 1 for fast damped motion, which therefore must not be set off: a
/// start that is out of balance would stay so. Its first interval is one of Radau IIA, two stages
/// (Hairer & Wanner 1996, IV.5), which annihilates fast motion, in the same knots:
///   a_s = 4/(3h) (v1 - v0) - a1/3,   v_s = (4 v0 + 5 v1)/9 - 2/9 h a1,
///   q_s = q0 + h (5 v0 + 4 v1)/27 - 5/54 h^2 a1,   q1 = q0 + h (v0 + 2 v1)/3 - h^2/6 a1
/// with equations of motion at a third of the interval and at its end.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::plan {

enum class Method { backward_euler, hermite_simpson };
/// "backward-euler", "hermite-simpson".
std::string_view method_name(Method method);

/// A linear map of what two knots hold, with its derivatives by h. Columns: the blocks of the first
/// knot, then those of the second.
struct Weights {
  MatrixX value, slope, bend;  ///< (rows, 2 blocks): itself, d/dh, d2/dh2
};

struct Stage {
  Weights state;                   ///< rows: position, rate, acceleration
  std::array<double, 2> torque{};  ///< of the two knots'; the second: where in the interval it is
  double share = 0.0;              ///< of the interval in integrals over it
};

struct Transcription {
  int blocks = 0;             ///< a knot holds: q, v and, with 3, a
  std::vector<Stage> stages;  ///< of an interval
  Weights defect;             ///< one row, zero
  double begin_share = 0.0;   ///< as the stages', of the interval's begin

  /// @param method which one. @param h interval, s, > 0. @param first whether it is the first.
  Transcription(Method method, double h, bool first);

 private:
  void set_euler(double h);
  void set_hermite(double h);
  void set_radau(double h);
};

}  // namespace sinew::plan
