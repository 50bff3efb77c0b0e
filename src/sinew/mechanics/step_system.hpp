/// @file
/// The equations of a body in a step: linearisation, condensation onto constraint rows, and motion.
///
/// One step, in the order of the calls:
///   begin_step   remembers q_start and v_start
///   linearise    A and b = p - f(q) - inertia - damping at the current q       (assembly)
///   take_rows    the body's part of H                                          (rows)
///   condense     factorises A bordered by H: W and H A^-1 b                    (factorisation)
///   solve_motion dq = A^-1 (b + H^T lambda)                                    (correction)
///   apply_motion q <- q_before (+) scale dq, with a report on the result
///   end_step     updates the velocities
/// linearise() and take_rows() may be repeated after a motion with renew() in place of condense():
/// the matrix A is then that of the last condensation (simplified Newton method).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"
#include "sinew/linalg/factor_status.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::mechanics {

/// Parameters of a linearisation.
struct LinearisationRequest {
  StepWeights weights;
  Tangent tangent = Tangent::corotated;
  /// The geometric stiffness of constraints will be added (add_geometric_stiffness()); needs a
  /// wider pattern.
  bool with_geometric_stiffness = false;
  /// Further linearisations of the same step may follow (Newton's iterations).
  bool iterating = false;
  /// Whether A is needed. If not, a body may evaluate b only; condense() must not follow.
  bool with_matrix = true;
  /// Weights of the bodies whose integrator starts afresh in this step, if there are any.
  std::optional<StepWeights> afresh = {};
};

/// Result of a condensation.
struct Inertia {
  linalg::FactorStatus status = linalg::FactorStatus::positive_definite;
  /// Negative eigenvalues of A; none: the solver does not count them, see at_least().
  std::optional<int> negative_pivots = 0;
  /// The linearisation has an unsymmetric part, which condense() omits and solve_motion() includes.
  /// The inertia of the factorised matrix is then not meaningful.
  bool unsymmetric = false;

  /// A lower bound of the number of negative eigenvalues: the number itself, or one if the solver
  /// only met some.
  int at_least() const {
    return negative_pivots.value_or(status == linalg::FactorStatus::indefinite ? 1 : 0);
  }
  /// Whether at_least() is the number itself. If not, nothing tells whether A is definite: a solver
  /// may meet negative curvature or not.
  bool is_counted() const { return negative_pivots.has_value(); }
};

/// The smallest ratio of deformed to rest volume of any element.
struct SmallestVolume {
  double ratio = 1.0;  ///< min det F; <= 0 means inverted
  int element = -1;    ///< the element with this ratio
};

/// The largest principal stretch of any element: length by length at rest.
struct LargestStretch {
  double value = 1.0;
  int element = -1;  ///< the element with this stretch
};
/// A larger stretch is no state of a robot: rubbers tear at 5 to 12.
inline constexpr double kSaneStretch = 50.0;

/// Result of a proposed motion.
struct MotionReport {
  bool finite = true;         ///< no NaN or infinity in the new state
  double largest_move = 0.0;  ///< largest change of any coordinate, m
  SmallestVolume volume;
};

/// Result of the step of a body. Work, in J, is that of the forces of the last linearisation.
struct StepEnd {
  double error = 0.0;  ///< m, an estimate of the largest error in any coordinate
  /// Work of loads, external forces and tethers, and of the base on the body, without gravity. The
  /// work of rows on what is fixed to the base is not included (HasBase::carried()).
  double external_work = 0.0;
  double damped = 0.0;   ///< energy dissipated by damping and drag
  double power = 0.0;    ///< W, that of `external_work` at the end of the step
  double damping = 0.0;  ///< W, dissipated by damping and drag at the end of the step
  /// The body was moved by something that the energy ledger does not count: its base, or a tether.
  bool moved_from_outside = false;
};

/// Resultant of forces: their sum, and the sum of their moments about a point.
struct Wrench {
  Vector3 force = Vector3::Zero();   ///< N
  Vector3 moment = Vector3::Zero();  ///< N m

  Wrench& operator+=(const Wrench& other) {
    force += other.force;
    moment += other.moment;
    return *this;
  }
};

/// An entry of a sparse matrix, as Eigen takes it.
using MatrixEntry = Eigen::Triplet<double>;

/// The equations of one body in a step. A step does not allocate memory, unless it needs more than
/// any step before.
class StepSystem {
 public:
  virtual ~StepSystem() = default;

  virtual void begin_step() = 0;
  /// Begins a query of the current state: like begin_step(), but the base does not move.
  virtual void begin_query() { begin_step(); }
  virtual void linearise(const LinearisationRequest& request) = 0;
  /// Adds the geometric stiffness of a loaded constraint: A -= effort d2(delta)/dq2. Call it
  /// between linearise() (with_geometric_stiffness) and condense(). A linearisation to which
  /// nothing was added may be reused by the next one at the same state.
  virtual void add_geometric_stiffness(const StiffnessPair& pair) = 0;
  /// Takes this body's part of H for the following calls.
  virtual void take_rows(const RowValues& rows) = 0;
  /// Updates the active transient rows and their directions after condense(). The result is the
  /// same as if take_rows() had been called with them before condense().
  virtual void retake_rows(const RowValues& rows) = 0;
  /// Factorises A bordered by the rows taken.
  virtual Inertia condense() = 0;
  /// Appends the entries of A of the last condensation, of both triangles; none in the rows and
  /// columns of coordinates that a region holds. @param first added to the numbers of coordinates.
  /// @param entries receives them.
  virtual void add_matrix(int first, std::vector<MatrixEntry>& entries) const = 0;
  /// Adds this body's part of W and of H A^-1 b to the problem of a step. @param problem_row (all
  /// rows,) number of each row in the problem; inactive rows have none. @param compliance (rows of
  /// the problem, rows of the problem). @param free_motion (rows of the problem,).
  virtual void add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                              VectorX& free_motion) const = 0;

  /// Size of dq.
  virtual std::size_t size() const = 0;
  /// Residual |b + H^T effort| of the equation of the step at the current state, N.
  /// @param effort (all rows,) N. @param imbalance (size(),) N, b + H^T effort; or empty.
  virtual double residual(std::span<const double> effort, std::span<double> imbalance) = 0;
  /// Resultant of the residual b + H^T effort. Internal forces cancel in it, so at rest it is what
  /// the reactions of fixed nodes lack to balance all loads, contacts and joints. Zero for bodies
  /// whose coordinates are not displacements, which are held as a whole. @param effort (all rows,)
  /// N. @param about (3,) m, the point of the moment.
  virtual Wrench unbalanced([[maybe_unused]] std::span<const double> effort,
                            [[maybe_unused]] const Vector3& about) {
    return {};
  }
  /// Scale of the residual of the last linearisation, N: the sum of the norms of internal and
  /// external forces, plus the force of a negligible strain, so that it is not zero at rest.
  virtual double force_scale() const = 0;
  /// A bound on the residual that rounding leaves, N; costs a pass over A. Coordinates are known to
  /// eps |q|, so no state satisfies its equation better than |A| eps |q| (Higham, Accuracy and
  /// Stability of Numerical Algorithms, 2002, sec. 12.1 and 25.2: the limiting residual).
  virtual double rounding_floor() const = 0;
  /// From the next linearisation on, subtracts a force from b, the homotopy residual of load
  /// stepping. @param force (size(),) N, copied; empty: subtracts nothing.
  virtual void subtract_residual(std::span<const double> force) = 0;

  /// Uses the last factorisation with the b and H of the present linearisation. After it,
  /// solve_motion() computes dq = A^-1 (b + H^T effort + H^T (effort' - effort)) for other efforts
  /// effort'; the last H may be that of the factorisation. Overwrites the proposed motion.
  /// @param effort (all rows,) N, of the present state.
  /// @param turned whether A is turned with the material since the factorisation, where a body
  ///   deforms: closer to the present A, and no longer the one of which the bound of a distance is
  ///   an estimate.
  virtual void renew(std::span<const double> effort, bool turned) = 0;
  /// Adds H A^-1 (b + H^T effort) of the last renew() to the motions of the problem's rows.
  /// @param problem_row see add_compliance(). @param row_motion (rows of the problem,).
  virtual void add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const = 0;
  /// Computes the proposed motion dq = A^-1 (b + H^T effort).
  virtual void solve_motion(std::span<const double> effort) = 0;
  /// Largest change of any coordinate in the proposed motion, m, as in MotionReport.
  virtual double proposed_move() const = 0;
  /// Solves for any right-hand side with the A of the last condensation. @param right,result
  /// (size(),).
  virtual void solve(std::span<const double> right, std::span<double> result) = 0;
  /// Solves A^T x = right with the A of the last condensation, including the unsymmetric part of
  /// the last linearisation (Inertia::unsymmetric): the adjoint of solve_motion() without efforts,
  /// as gradients need it. Zero at coordinates that a region holds. May allocate.
  /// @param right,result (size(),).
  virtual void solve_transposed(std::span<const double> right, std::span<double> result) = 0;
  /// Sets the proposed motion, in place of solve_motion(). @param motion (size(),).
  virtual void propose_motion(std::span<const double> motion) = 0;
  /// Sets the proposed motion to `time_step` times the velocity at the start of the step.
  virtual void propose_drift(double time_step) = 0;
  /// (3,) m: displacement of an attached point in the proposed motion. Required of bodies whose
  /// model leaves rows out (BodyModel::leaves_rows_out()); others may throw Error(internal).
  virtual Vector3 proposed_motion(int point) const;
  /// Moves surface nodes by the proposed motion. Required of bodies with a surface (HasSurface);
  /// others throw Error(internal). @param nodes (n, 3) m, in and out.
  virtual void add_proposed_motion(Points& nodes) const;
  /// Sets q to that of the last linearisation moved by scale dq; may be called again with another
  /// scale. Does not fill in MotionReport::volume; see smallest_volume().
  virtual MotionReport apply_motion(double scale) = 0;
  /// Smallest volume ratio of the current state, which must be finite; costs nothing if it is
  /// linearised.
  virtual SmallestVolume smallest_volume() { return {}; }
  /// The largest stretch in the current state, or an upper bound of it that is at most
  /// kSaneStretch.
  virtual LargestStretch largest_stretch() { return {}; }
  /// The acceleration at the end of the step. Call before end_step(). @param weights of the step.
  /// @param acceleration (size(),) m/s^2, overwritten.
  virtual void find_acceleration(const StepWeights& weights, std::span<double> acceleration) = 0;
  /// M times a motion, with M at the current state. @param motion,result (size(),).
  virtual void apply_mass(std::span<const double> motion, std::span<double> result) = 0;
  virtual StepEnd end_step(const StepWeights& weights) = 0;
  /// Whether a linearisation at the end of a step with iterations serves the next step, so that it
  /// costs nothing to evaluate the matrix there.
  virtual bool keeps_linearisation() const { return true; }
  /// Called when the last condensation is no longer needed; other simulations may then use its
  /// memory.
  virtual void release() {}

  /// Whether the second half of a step may repeat the motion of the first. It may not if a base
  /// moves or the material has memory.
  virtual bool can_carry_on() const { return true; }
  /// Scales the motion of the step, q <- q_start (+) factor (q - q_start); factor 2 completes a
  /// step of the midpoint rule.
  virtual void scale_motion(double factor) = 0;
  /// Adds a sudden change of velocity: an impact. @param change (size(),) m/s.
  virtual void add_velocity(std::span<const double> change) = 0;
};

}  // namespace sinew::mechanics
