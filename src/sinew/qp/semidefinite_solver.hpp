/// @file
/// Convex quadratic programs whose Hessian is singular: the optimal point of least effort.
#pragma once

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::qp {

/// Solver of convex quadratic programs with a singular Hessian. With D^2 = diag G (1 where that is
/// zero), the program in y = D x has the Hessian D^-1 G D^-1 = U M U^T. N are the columns of U
/// whose eigenvalue is zero to rounding.
///
/// 1. Proximal steps in the null space only,
///      y_{k+1} = argmin f(y) + rho/2 |N^T (y - y_k)|^2   over the constraints,
///    converge to an optimal point (Rockafellar, SIAM J. Control Optim. 14 (1976) 877-898). Each is
///    a strictly convex program for QpSolver. If the objective is unbounded below, the steps become
///    a ray of the feasible set along which G does not change and g decreases.
/// 2. All optimal points share G y and g^T y (Mangasarian, Oper. Res. Lett. 7 (1988) 21-26), and
///    any multipliers of one are multipliers of all. The one with the least |y| among them is the
///    solution of another strictly convex program.
class SemidefiniteSolver {
 public:
  SemidefiniteSolver(int variables, int constraints, const QpSettings& settings);

  /// Solves a problem with finite data whose Hessian is not positive definite.
  /// @param problem of the solver's size.
  /// @param result is written: optimal, infeasible, unbounded (with the ray), not-convex,
  ///   iteration-limit. Allocates nothing.
  void solve(const QuadraticProgram& problem, QpResult* result);

 private:
  /// @returns whether the Hessian is positive semidefinite to working precision.
  bool split(const QuadraticProgram& problem);
  void load(const QuadraticProgram& problem);
  void load_weight(double weight);
  QpStatus take_step(double weight, double* stationarity);
  /// Converges to an optimal point, or returns why there is none.
  QpStatus approach();
  bool is_ray(const VectorX& direction) const;
  /// Moves point_ to the optimal point of least effort.
  void lessen_effort();
  void write(const QuadraticProgram& problem, QpStatus status, QpResult* result) const;

  int variables_ = 0, constraints_ = 0;
  linalg::SymmetricSpectrum eigen_;
  VectorX scale_;         ///< (n) D
  MatrixX scaled_;        ///< (n, n) D^-1 G D^-1
  int nullity_ = 0;       ///< number of eigenvalues that are zero to rounding; they come first
  double largest_ = 0.0;  ///< largest eigenvalue, 1 when G is zero
  VectorX gradient_;      ///< (n) D^-1 g without rounding errors in the null space
  bool falls_ = false;    ///< the gradient has a component in the null space
  VectorX point_, step_;  ///< (n) y and the last proximal step
  QuadraticProgram proximal_, least_;
  QpSolver proximal_solver_, least_solver_;
  QpResult found_;  ///< of the last proximal step
};

}  // namespace sinew::qp
