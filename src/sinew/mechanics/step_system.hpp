/// @file
/// A body in a step: it linearises its equation of motion, condenses it onto constraint rows, and
/// moves.
///
/// One step, in the order of the calls:
///   begin_step   remembers q_start and v_start
///   linearise    A and b = p - f(q) - inertia - damping at the current q       (assembly)
///   take_rows    its part of H                                                 (rows)
///   condense     factorises A bordered by H: W and H A^-1 b                    (factorisation)
///   solve_motion dq = A^-1 (b + H^T lambda)                                    (correction)
///   apply_motion q <- q_before (+) scale dq, and says how well that went
///   end_step     velocities follow
#pragma once

#include <cstddef>
#include <span>

#include "sinew/core/types.hpp"
#include "sinew/linalg/factor_status.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::mechanics {

/// What a body looks at when it linearises.
struct LinearisationRequest {
  StepWeights weights;
  Tangent tangent = Tangent::corotated;
  /// Constraints' geometric stiffness will be added (see add_geometric_stiffness); costs a wider
  /// pattern.
  bool with_geometric_stiffness = false;
  /// Further linearisations of the same step may follow (Newton's iterations).
  bool iterating = false;
};

/// What a condensation found.
struct Inertia {
  linalg::FactorStatus status = linalg::FactorStatus::positive_definite;
  int negative_pivots = 0;
  /// The linearisation has an unsymmetric part, which condense() leaves out and solve_motion()
  /// takes into account: the inertia of what was factorised then says nothing.
  bool unsymmetric = false;
};

/// The least deformed volume of any element over its own.
struct SmallestVolume {
  double ratio = 1.0;  ///< min det F; <= 0 means inverted
  int element = -1;    ///< where
};

/// How a proposed motion turned out.
struct MotionReport {
  bool finite = true;         ///< no NaN or infinity in the new state
  double largest_move = 0.0;  ///< m, of any coordinate
  SmallestVolume volume;
};

/// What a body's step came to. Work is that of forces with the values they had when the step was
/// linearised last, J.
struct StepEnd {
  double error = 0.0;    ///< m, an estimate of the largest error made in any coordinate
  double outside = 0.0;  ///< work of loads and outside forces, but not of gravity
  double damped = 0.0;   ///< taken out by damping and drag
  /// Something that no ledger counts moved it: its base, a hand in the view.
  bool moved_from_outside = false;
};

/// Nothing allocates after construction.
class StepSystem {
 public:
  virtual ~StepSystem() = default;

  virtual void begin_step() = 0;
  /// The same for a look at the present state: its base goes nowhere.
  virtual void begin_query() { begin_step(); }
  virtual void linearise(const LinearisationRequest& request) = 0;
  /// Adds the geometric stiffness of a constraint's loads: A -= effort d2(delta)/dq2.
  /// Between linearise (with_geometric_stiffness) and condense. A linearisation to which nothing
  /// was added is taken up by the next one at the same state.
  virtual void add_geometric_stiffness(const StiffnessPair& pair) = 0;
  /// Takes this body's part of H for what follows.
  virtual void take_rows(const RowValues& rows) = 0;
  /// Takes which transient rows are active, and their directions, anew after condense(): what
  /// follows is as if take_rows() had done so before it.
  virtual void retake_rows(const RowValues& rows) = 0;
  /// Factorises A bordered by the rows taken.
  virtual Inertia condense() = 0;
  /// Adds this body's W and H A^-1 b to those of a step's problem. @param problem_row (all rows,)
  /// which each row is in the problem; rows that are not active have none. @param compliance (rows
  /// of the problem, rows of the problem). @param free_motion (rows of the problem,).
  virtual void add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                              VectorX& free_motion) const = 0;

  /// How many numbers dq has.
  virtual std::size_t size() const = 0;
  /// |b + H^T effort|, N: how far the current state is from satisfying the step's equation.
  /// @param effort (all rows,) N. @param imbalance (size(),) N, b + H^T effort; or empty.
  virtual double residual(std::span<const double> effort, std::span<double> imbalance) = 0;
  /// What residuals of the last linearisation are judged by, N: the sum of the norms of internal
  /// and outside forces, and the force of a negligible strain, so that it is not zero at rest.
  virtual double force_scale() const = 0;
  /// A bound on what rounding leaves of such a residual, N; takes a look at all of A. Coordinates
  /// are known to eps |q|, so that no state obeys its equation better than |A| eps |q| (Higham,
  /// Accuracy and Stability of Numerical Algorithms, 2002, sec. 12.1 and 25.2: the limiting
  /// residual).
  virtual double rounding_floor() const = 0;
  /// From the next linearisation on, b is lessened by a force: load stepping takes an imbalance
  /// away. @param force (size(),) N, copied; empty: nothing is taken away any more.
  virtual void lessen(std::span<const double> force) = 0;

  /// dq = A^-1 (b + H^T effort).
  virtual void solve_motion(std::span<const double> effort) = 0;
  /// A^-1 of any right side, of the last condensation. @param right,result (size(),).
  virtual void solve(std::span<const double> right, std::span<double> result) = 0;
  /// What the next apply_motion() takes in place of solve_motion()'s. @param motion (size(),).
  virtual void propose_motion(std::span<const double> motion) = 0;
  /// The same, `time_step` times the velocity of the step's start.
  virtual void propose_drift(double time_step) = 0;
  /// (3,) m: how far the proposed motion would move an attached point. Asked of bodies whose model
  /// leaves rows out (BodyModel::leaves_rows_out()), which have to say; others throw
  /// Error(internal).
  virtual Vector3 proposed_motion(int point) const;
  /// Moves the nodes of the body's surface as the proposed motion would. Asked of bodies that have
  /// one (HasSurface); others throw Error(internal). @param nodes (n, 3) m, in and out.
  virtual void add_proposed_motion(Points& nodes) const;
  /// State of the last linearisation moved by scale dq; may be called again with another scale.
  /// Leaves the report's volume to smallest_volume().
  virtual MotionReport apply_motion(double scale) = 0;
  /// Of the current state, which is finite; costs nothing where it is linearised.
  virtual SmallestVolume smallest_volume() { return {}; }
  virtual StepEnd end_step(const StepWeights& weights) = 0;
  /// Nothing is asked of the last condensation any more: other simulations may use its memory.
  virtual void release() {}

  /// Whether the second half of a step may repeat the motion of the first: not where a base moves
  /// or the material remembers its strain.
  virtual bool can_carry_on() const { return true; }
  /// Makes the step's motion longer or shorter, q <- q_start (+) factor (q - q_start): 2 is the
  /// second half of the midpoint rule.
  virtual void scale_motion(double factor) = 0;
  /// Changes the velocity at once: an impact. @param change (size(),) m/s.
  virtual void add_velocity(std::span<const double> change) = 0;
};

}  // namespace sinew::mechanics
