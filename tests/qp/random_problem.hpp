/// @file
/// Seeded random quadratic programs of several kinds, identical on every platform.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "sinew/core/types.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::qp {

enum class ProblemKind {
  well_scaled,
  badly_scaled,
  degenerate,
  equality_heavy,
  infeasible,
  semidefinite
};

inline const char* problem_kind_name(ProblemKind kind) {
  constexpr const char* kNames[] = {"well_scaled",    "badly_scaled", "degenerate",
                                    "equality_heavy", "infeasible",   "semidefinite"};
  return kNames[static_cast<int>(kind)];
}

/// SplitMix64, which is portable, unlike the distributions of standard libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1.0p-53;
  }
  int integer(int low, int high) {
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }
  MatrixX matrix(int rows, int columns) {
    return MatrixX::NullaryExpr(rows, columns, [this] { return uniform(-1.0, 1.0); });
  }
  VectorX vector(int size) { return matrix(size, 1); }

 private:
  std::uint64_t state_;
};

/// Orthonormalises columns by Gram-Schmidt, twice for accuracy (Giraud et al., Numer. Math. 101,
/// 2005).
inline MatrixX orthonormal(MatrixX a) {
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (int pass = 0; pass < 2; ++pass) {
      for (Eigen::Index i = 0; i < j; ++i) a.col(j) -= a.col(i).dot(a.col(j)) * a.col(i);
    }
    a.col(j).normalize();
  }
  return a;
}

/// A symmetric positive definite matrix with eigenvalues log-uniform in [1, condition].
inline MatrixX random_hessian(int n, double condition, Random& random) {
  const MatrixX q = orthonormal(random.matrix(n, n));
  VectorX values(n);
  for (int i = 0; i < n; ++i) values[i] = std::pow(condition, random.uniform(0.0, 1.0));
  values[0] = 1.0;
  values[n - 1] = condition;
  const MatrixX hessian = q * values.asDiagonal() * q.transpose();
  return 0.5 * (hessian + hessian.transpose());
}

/// Draws limits around a feasible value: some infinite, some tight (no slack), some equal.
inline void random_limits(double value, double equal, double tight, Random& random, double* lower,
                          double* upper) {
  const bool is_equal = random.chance(equal);
  const auto slack = [&] {
    if (is_equal || random.chance(tight)) return 0.0;
    return random.chance(0.2) ? kInfinity : random.uniform(0.0, 1.0) * (1.0 + std::abs(value));
  };
  *lower = value - slack();
  *upper = value + slack();
}

/// Makes a row that contradicts rows 0 .. 2: it is their combination, and its limits exclude that
/// value.
inline void contradict(QuadraticProgram& problem, const VectorX& feasible, Random& random) {
  const Eigen::Index i = problem.rows.rows() - 1;
  const Eigen::Index used = std::min<Eigen::Index>(3, i);
  problem.rows.row(i).setZero();
  double reach = 0.0;
  for (Eigen::Index k = 0; k < used; ++k) {
    const double factor = random.uniform(0.2, 2.0);
    problem.row_upper[k] = problem.rows.row(k).dot(feasible) + random.uniform(0.0, 0.5);
    problem.rows.row(i) += factor * problem.rows.row(k);
    reach += factor * problem.row_upper[k];
  }
  const double gap = random.chance(0.5) ? 1e-6 : random.uniform(0.05, 1.0);
  problem.row_lower[i] = reach + gap * (1.0 + std::abs(reach));
  problem.row_upper[i] = std::numeric_limits<double>::infinity();
}

/// Makes dependent limits: repeats rows, copies bounds into rows and adds sums of rows.
inline void make_dependent(QuadraticProgram& problem, Random& random) {
  const int m = static_cast<int>(problem.rows.rows());
  const int n = static_cast<int>(problem.rows.cols());
  for (int i = m / 2; i < m; ++i) {
    const int k = random.integer(0, m / 2 - 1);
    const int which = random.integer(0, 2);
    if (which == 0) {
      const double factor = random.chance(0.5) ? 1.0 : random.uniform(0.5, 2.0);
      problem.rows.row(i) = factor * problem.rows.row(k);
    } else if (which == 1) {
      problem.rows.row(i).setZero();
      problem.rows(i, random.integer(0, n - 1)) = 1.0;
    } else {
      problem.rows.row(i) = problem.rows.row(k) + problem.rows.row(random.integer(0, m / 2 - 1));
    }
  }
}

/// A matrix of rank below n, with equal columns and sometimes a variable without curvature.
inline MatrixX random_semidefinite_hessian(int n, Random& random) {
  const int rank = random.integer(0, n - 1);
  MatrixX root = random.matrix(rank, n);
  for (int i = 1; i < n; ++i) {
    if (random.chance(0.2)) root.col(i) = root.col(random.integer(0, i - 1));
    if (random.chance(0.1)) root.col(i).setZero();
  }
  return root.transpose() * root;
}

/// A multiplier that is admissible at an optimum with this value and these limits.
inline double random_multiplier(double value, double lower, double upper, Random& random) {
  if (!random.chance(0.5)) return 0.0;
  if (lower == upper) return random.uniform(-1.0, 1.0);
  if (value == lower) return random.uniform(0.0, 1.0);
  return value == upper ? random.uniform(-1.0, 0.0) : 0.0;
}

/// Sets the gradient such that `point` is optimal and the objective is bounded.
inline void make_optimal(QuadraticProgram& problem, const VectorX& point, Random& random) {
  problem.gradient = -problem.hessian * point;
  for (Eigen::Index i = 0; i < point.size(); ++i) {
    problem.gradient[i] += random_multiplier(point[i], problem.lower[i], problem.upper[i], random);
  }
  for (Eigen::Index i = 0; i < problem.rows.rows(); ++i) {
    const double value = problem.rows.row(i).dot(point);
    const double multiplier =
        random_multiplier(value, problem.row_lower[i], problem.row_upper[i], random);
    problem.gradient += multiplier * problem.rows.row(i).transpose();
  }
}

/// A problem with n variables and m >= 4 rows. All kinds except `infeasible` have a feasible point.
inline QuadraticProgram random_problem(ProblemKind kind, int n, int m, Random& random) {
  const bool bad = kind == ProblemKind::badly_scaled;
  const bool degenerate = kind == ProblemKind::degenerate;
  QuadraticProgram problem = QuadraticProgram::sized(n, m);
  const bool singular = kind == ProblemKind::semidefinite;
  problem.hessian = singular ? random_semidefinite_hessian(n, random)
                             : random_hessian(n, bad ? 1e8 : 10.0, random);
  problem.rows = random.matrix(m, n);
  VectorX unit = VectorX::Ones(n);
  if (bad) {
    for (int i = 0; i < n; ++i) unit[i] = std::pow(10.0, random.uniform(-3.0, 3.0));
    for (int i = 0; i < m; ++i) problem.rows.row(i) *= std::pow(10.0, random.uniform(-2.0, 2.0));
    problem.hessian = (unit.asDiagonal() * problem.hessian * unit.asDiagonal()).eval();
    problem.rows = (problem.rows * unit.asDiagonal()).eval();
  }
  if (degenerate || kind == ProblemKind::equality_heavy) make_dependent(problem, random);
  const VectorX feasible = random.vector(n).cwiseQuotient(unit);
  const VectorX wanted = 3.0 * random.vector(n).cwiseQuotient(unit);
  problem.gradient = -problem.hessian * wanted;
  const double equal = kind == ProblemKind::equality_heavy ? 0.5 : (degenerate ? 0.1 : 0.02);
  const double tight = degenerate || singular ? 0.5 : 0.05;
  for (int i = 0; i < n; ++i) {
    random_limits(feasible[i], degenerate ? 0.1 : 0.0, tight, random, &problem.lower[i],
                  &problem.upper[i]);
  }
  for (int i = 0; i < m; ++i) {
    random_limits(problem.rows.row(i).dot(feasible), equal, tight, random, &problem.row_lower[i],
                  &problem.row_upper[i]);
  }
  if (kind == ProblemKind::infeasible) contradict(problem, feasible, random);
  if (singular) make_optimal(problem, feasible, random);
  return problem;
}

}  // namespace sinew::qp
