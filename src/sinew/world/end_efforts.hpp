/// @file
/// Efforts of held motions at the end of a step.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/direct_solver.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/integrator.hpp"

namespace sinew::world {

class World;

/// A held row (a joint, a weld, a motor or cable of commanded motion, a stop) has whatever effort
/// its motion takes. In two formulas, the effort in the equation of a step is not that of the
/// step's end, by an error of first order:
///
/// - Backward Euler holds positions at the end, but its acceleration a_n = (q_n - 2 q_{n-1} +
///   q_{n-2})/h^2 along held rows is that of a step before. With A and W of the step, the inertia
///   of the change of acceleration since the last step takes the efforts y of the held rows H,
///     W y = H A^-1 M (a_n - a_{n-1}),   W = H A^-1 H^T,
///   so that they remain held. Along motions that are not held, a_n is that of the forces at the
///   end, and A^-1 M (a_n - a_{n-1}) acts on no effort. y approximates the effort that is lacking
///   up to O(h^2).
/// - The effort of the midpoint rule is that of the middle of the step: y = h/2 lambda'.
///
/// The difference between the last two steps is used with a limiter, as slopes beside shocks (Roe,
/// Annu. Rev. Fluid Mech. 18, 1986, 337, `minmod`): of two successive y of one sign the smaller,
/// otherwise zero, and also zero if one is several times the other, as in the steps after an
/// impact. The reported effort is then of second order where efforts are smooth, and does not
/// overshoot where they jump: at impacts, jumps of commands and loads, and contacts that open. It
/// is not part of the solution, and motion, laws and energy do not depend on it.
class EndEfforts {
 public:
  EndEfforts();

  /// After the solution of a step of backward Euler and before its end. @param world,effort (rows,)
  /// of the solution. @param weights of the step. @param step_before s, the previous step; 0: none.
  void follow_backward_euler(World& world, std::span<const double> effort,
                             const mechanics::StepWeights& weights, double step_before);
  /// After a step of the midpoint rule. @param world,effort (rows,) at its end.
  /// @param effort_before (rows,) of the previous step. @param step,step_before s.
  void follow_midpoint(const World& world, std::span<const double> effort,
                       std::span<const double> effort_before, double step, double step_before);
  /// After a step of another formula, and where a run starts afresh: the efforts at the end are
  /// those of the equation.
  void clear() { formula_ = Formula::other; }

  /// N or Pa: what the effort of a row of the model is at the end of the step beyond that of its
  /// equation.
  double change(int row) const {
    return formula_ == Formula::other ? 0.0 : change_[static_cast<std::size_t>(row)];
  }

  /// N or Pa: the effort of a row at the end of the step. @param effort (rows,) of its equation.
  /// @param row of the model.
  double at_end(std::span<const double> effort, int row) const {
    return effort[static_cast<std::size_t>(row)] + change(row);
  }

  /// Writes the state; empty after clear().
  void save(std::vector<double>& numbers) const;
  /// @param numbers from save(). @param rows of the model. @param coordinates of all bodies.
  void load(std::span<const double> numbers, std::size_t rows, std::size_t coordinates);
  /// Whether save() of the same model may have written as many numbers.
  static bool is_size(std::size_t numbers, std::size_t rows, std::size_t coordinates);

 private:
  enum class Formula { other, backward_euler, midpoint };
  // A held row: in the problem and in the model, and the limits of its effort.
  struct Held {
    int row, model_row;
    double motion_scale, min, max;
  };
  void begin(Formula formula, std::size_t rows);
  void list_held(const World& world, std::span<const double> effort);
  bool solve_law(World& world);
  void take(const Held& held, double effort, double rate, double reach);

  Formula formula_ = Formula::other;  // of the last step
  std::vector<double> change_;        // (rows,) N
  std::vector<double> rate_;          // (rows,) N, y of the last step; N/s by the midpoint rule
  std::vector<double> rate_before_;   // (rows,)
  VectorX acceleration_;              // (all bodies' size(),) m/s^2, of backward Euler

  // Work space.
  std::vector<Held> held_;
  std::vector<int> rows_;  // of the problem, those of law_
  VectorX now_, force_, motion_, row_motion_;
  law::StepProblem law_;  // of the held rows
  law::DirectSolver solver_;
  linalg::AlignedNumbers lacking_;  // (held and stiff rows,) N
};

}  // namespace sinew::world
