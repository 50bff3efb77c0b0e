#include <cmath>
#include <memory>
#include <utility>

#include "sinew/qp/qp_workspace.hpp"

namespace sinew::qp {

QpSolver::QpSolver() : QpSolver(0, 0) {}
QpSolver::QpSolver(int variables, int constraints, QpSettings settings)
    : work_(std::make_unique<Workspace>(variables, constraints, settings)) {}
QpSolver::~QpSolver() = default;
QpSolver::QpSolver(QpSolver&&) noexcept = default;
QpSolver& QpSolver::operator=(QpSolver&&) noexcept = default;

const QpResult& QpSolver::solve(const QuadraticProgram& problem) {
  work_->solve(problem);
  return work_->result;
}

void QpSolver::reset() { work_->reset(); }

QpSolver::Workspace::Workspace(int n, int m, QpSettings chosen)
    : variables(n), settings(chosen), constraints(n, m), factors(n) {
  result.x.setZero(n);
  result.bound_multiplier.setZero(n);
  result.row_multiplier.setZero(m);
  result.ray.setZero(n);
  active.reserve(static_cast<std::size_t>(n));
  last_set.resize(static_cast<std::size_t>(n));
  state.assign(static_cast<std::size_t>(n + m), 0);
  for (VectorX* vector :
       {&x, &gradient, &multipliers, &values, &residual, &correction, &multiplier_correction}) {
    vector->setZero(factors.stride());
  }
  iteration_limit = settings.max_iterations > 0 ? settings.max_iterations : 10 * (n + m) + 100;
}

void QpSolver::Workspace::solve(const QuadraticProgram& problem) {
  iterations = 0;
  QpStatus status = load_and_factorise(problem);
  if (status == QpStatus::not_convex) return solve_semidefinite(problem);
  if (status != QpStatus::optimal) {
    reset();
    x.setZero();
    write_result(status);
    return;
  }
  const bool warm = settings.warm_start && !active.empty();
  start_from_last_set();
  status = run(problem);
  if (status == QpStatus::iteration_limit && warm) {
    reset();
    factors.factorise(problem.hessian);
    start_from_last_set();
    status = run(problem);
  }
  write_result(status);
}

void QpSolver::Workspace::solve_semidefinite(const QuadraticProgram& problem) {
  reset();
  if (!semidefinite) {
    semidefinite =
        std::make_unique<SemidefiniteSolver>(variables, constraints.count() - variables, settings);
  }
  semidefinite->solve(problem, &result);
}

// Returns not_convex if the Hessian is not positive definite; it may still be semidefinite.
QpStatus QpSolver::Workspace::load_and_factorise(const QuadraticProgram& problem) {
  if (!constraints.load(problem)) return QpStatus::not_finite;
  if (!factors.factorise(problem.hessian)) {
    for (int j = 0; j < variables; ++j) {
      for (int i = j; i < variables; ++i) {
        if (!std::isfinite(problem.hessian(i, j))) return QpStatus::not_finite;
      }
    }
    return QpStatus::not_convex;
  }
  gradient.head(variables) = problem.gradient;
  objective_size = factors.dual_norm(gradient.data());
  return QpStatus::optimal;
}

QpStatus QpSolver::Workspace::run(const QuadraticProgram& problem) {
  iterations = 0;
  settle(problem, false);
  bool refined = false;
  while (true) {
    measure_iterate();
    if (!std::isfinite(iterate_size)) return QpStatus::not_finite;
    int side = 0;
    const int c = most_violated(&side);
    if (c < 0 && refined) return QpStatus::optimal;
    if (iterations >= iteration_limit) return QpStatus::iteration_limit;
    if (c < 0) {
      settle(problem, true);
      refined = true;
      continue;
    }
    switch (add_constraint(c, side)) {
      case Addition::infeasible:
        return QpStatus::infeasible;
      case Addition::out_of_iterations:
        return QpStatus::iteration_limit;
      case Addition::redundant:
        settle(problem, false);
        break;
      case Addition::added:
        break;
    }
    refined = false;
  }
}

void QpSolver::Workspace::write_result(QpStatus status) {
  result.status = status;
  result.iterations = iterations;
  result.active = static_cast<int>(active.size());
  result.x = x.head(variables);
  result.bound_multiplier.setZero();
  result.row_multiplier.setZero();
  for (std::size_t k = 0; k < active.size(); ++k) {
    const ActiveConstraint& entry = active[k];
    double multiplier = multipliers[static_cast<Eigen::Index>(k)];
    if (entry.violates(multiplier)) multiplier = 0.0;
    if (constraints.is_bound(entry.constraint)) {
      result.bound_multiplier[entry.constraint] = multiplier;
      if (status == QpStatus::optimal) result.x[entry.constraint] = active_limit(entry);
    } else {
      result.row_multiplier[entry.constraint - variables] = multiplier;
    }
  }
  if (status != QpStatus::optimal) return;
  for (int i = 0; i < variables; ++i) {
    result.x[i] = std::fmin(std::fmax(result.x[i], constraints.lower(i)), constraints.upper(i));
  }
}

}  // namespace sinew::qp
