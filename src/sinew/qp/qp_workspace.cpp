#include "sinew/qp/qp_workspace.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/core/types.hpp"
#include "sinew/qp/padded_columns.hpp"

namespace sinew::qp {

namespace {

/// A constraint is dependent on the active ones if its normal has a smaller share than this outside
/// their span; its square is compared with squares.
constexpr double kDependent = 1e-11;
/// The same for a constraint of the last active set, which costs little to leave out.
constexpr double kWarmDependent = 1e-7;
/// An exchange coefficient below this, normals scaled to one, is rounding error.
constexpr double kPivot = 1e-12;
/// A multiplier of the wrong sign by no more than this, relative, is zero.
constexpr double kWrongSign = 1e-12;

enum State : std::uint8_t { kIdle, kActive, kMet };

}  // namespace

double QpSolver::Workspace::active_limit(const ActiveConstraint& entry) const {
  return entry.side < 0 ? constraints.upper(entry.constraint) : constraints.lower(entry.constraint);
}

void QpSolver::Workspace::project(int c) {
  if (constraints.is_bound(c)) {
    factors.project_unit(c);
  } else {
    factors.project(constraints.normal(c));
  }
  factors.compute_directions();
}

void QpSolver::Workspace::activate(int c, int side, double multiplier) {
  factors.add();
  multipliers[static_cast<Eigen::Index>(active.size())] = multiplier;
  active.push_back({c, constraints.is_equality(c) ? 0 : side});
  state[static_cast<std::size_t>(c)] = kActive;
}

void QpSolver::Workspace::deactivate(int position) {
  const auto at = static_cast<std::size_t>(position);
  state[static_cast<std::size_t>(active[at].constraint)] = kIdle;
  factors.drop(position);
  for (std::size_t k = at; k + 1 < active.size(); ++k) {
    active[k] = active[k + 1];
    multipliers[static_cast<Eigen::Index>(k)] = multipliers[static_cast<Eigen::Index>(k + 1)];
  }
  active.pop_back();
}

void QpSolver::Workspace::start_from_last_set() {
  std::fill(state.begin(), state.end(), std::uint8_t{kIdle});
  const std::size_t last = settings.warm_start ? active.size() : 0;
  for (std::size_t k = 0; k < last; ++k) last_set[k] = active[k];
  active.clear();
  for (std::size_t k = 0; k < last; ++k) {
    const ActiveConstraint entry = last_set[k];
    const int side = entry.side == 0 ? 1 : entry.side;
    if (!std::isfinite(active_limit({entry.constraint, side}))) continue;
    project(entry.constraint);
    const double threshold = kWarmDependent * kWarmDependent * factors.whole_part();
    if (factors.independent_part() > threshold) activate(entry.constraint, side, 0.0);
  }
}

void QpSolver::Workspace::solve_subproblem() {
  for (std::size_t k = 0; k < active.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] = active_limit(active[k]);
  }
  factors.solve_equality(gradient.data(), values.data(), x.data(), multipliers.data());
}

// One step of iterative refinement: the residuals of G x + g = N u and N^T x = b become the data of
// the same solve. It makes up for the growth of rounding errors in J and in the steps.
void QpSolver::Workspace::refine_subproblem(const QuadraticProgram& problem) {
  const int n = variables;
  residual = gradient;
  for (int j = 0; j < n; ++j) {
    const double* column = problem.hessian.data() + j * problem.hessian.outerStride();
    residual[j] += column[j] * x[j] + dot(column + j + 1, x.data() + j + 1, n - j - 1);
    add_scaled(residual.data() + j + 1, x[j], column + j + 1, n - j - 1);
  }
  for (std::size_t k = 0; k < active.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    constraints.add_normal(active[k].constraint, -multipliers[at], residual.data());
    values[at] = active_limit(active[k]) - constraints.value(active[k].constraint, x.data());
  }
  factors.solve_equality(residual.data(), values.data(), correction.data(),
                         multiplier_correction.data());
  x += correction;
  const auto count = static_cast<Eigen::Index>(active.size());
  multipliers.head(count) += multiplier_correction.head(count);
}

void QpSolver::Workspace::settle(const QuadraticProgram& problem, bool refine) {
  do {
    solve_subproblem();
    measure_iterate();
    if (refine) refine_subproblem(problem);
  } while (drop_worst_multiplier());
}

bool QpSolver::Workspace::drop_worst_multiplier() {
  double worst = kWrongSign * iterate_size;
  int position = -1;
  for (std::size_t k = 0; k < active.size(); ++k) {
    const double multiplier = multipliers[static_cast<Eigen::Index>(k)];
    const double size = -active[k].side * multiplier / constraints.weight(active[k].constraint);
    if (size > worst) {
      worst = size;
      position = static_cast<int>(k);
    }
  }
  if (position < 0) return false;
  ++iterations;
  deactivate(position);
  return true;
}

void QpSolver::Workspace::measure_iterate() {
  double largest = 0.0;
  for (int i = 0; i < variables; ++i) {
    const double size = std::abs(x[i]) * constraints.variable_scale(i);
    if (!(size <= largest)) largest = size;
  }
  iterate_size = objective_size + largest;
}

// The limit that c violates by more than tolerance and rounding: +1 lower, -1 upper, 0 none.
int QpSolver::Workspace::violated_side(int c, double* violation) const {
  const double value = constraints.value(c, x.data());
  const double below = constraints.lower(c) - value;
  const double above = value - constraints.upper(c);
  const int side = below > above ? 1 : -1;
  *violation = side > 0 ? below : above;
  if (!(*violation > 0.0)) return 0;
  const double noise = 8.0 * kEpsilon * variables * iterate_size;
  if (*violation * constraints.weight(c) <= noise) return 0;
  const double limit = std::abs(active_limit({c, side}));
  if (*violation <= settings.tolerance * limit) return 0;
  if (*violation <= settings.tolerance * constraints.magnitude(c, x.data())) return 0;
  return side;
}

// Equalities come first, since they are never dropped; then the largest weighted violation.
int QpSolver::Workspace::most_violated(int* side) const {
  double worst = 0.0;
  int chosen = -1;
  bool equality = false;
  for (int c = 0; c < constraints.count(); ++c) {
    if (state[static_cast<std::size_t>(c)] != kIdle) continue;
    double violation = 0.0;
    const int violated = violated_side(c, &violation);
    if (violated == 0) continue;
    const bool is_equality = constraints.is_equality(c);
    const double size = violation * constraints.weight(c);
    if (equality && !is_equality) continue;
    if (size <= worst && equality == is_equality) continue;
    worst = size;
    chosen = c;
    *side = violated;
    equality = is_equality;
  }
  return chosen;
}

QpSolver::Workspace::Addition QpSolver::Workspace::add_constraint(int c, int side) {
  const double limit = active_limit({c, side});
  double multiplier = 0.0;
  while (iterations++ < iteration_limit) {
    project(c);
    const double independent = factors.independent_part();
    const bool dependent = independent <= kDependent * kDependent * factors.whole_part();
    double dual_step = kInfinity;
    const int blocking = blocking_multiplier(c, side, &dual_step);
    if (dependent && blocking < 0) {
      if (is_contradiction(c, side)) return Addition::infeasible;
      state[static_cast<std::size_t>(c)] = kMet;
      return Addition::redundant;
    }
    const double gap = side * (limit - constraints.value(c, x.data()));
    const double full_step = dependent ? kInfinity : std::max(gap, 0.0) / independent;
    const double step = side * std::min(full_step, dual_step);
    if (!dependent) add_scaled(x.data(), step, factors.direction(), factors.stride());
    add_scaled(multipliers.data(), -step, factors.exchange(), factors.active());
    multiplier += step;
    if (full_step <= dual_step) {
      activate(c, side, multiplier);
      return Addition::added;
    }
    deactivate(blocking);
  }
  return Addition::out_of_iterations;
}

// The first active inequality whose multiplier reaches zero as that of c grows; among ties, the one
// with the largest coefficient, which keeps R well conditioned.
int QpSolver::Workspace::blocking_multiplier(int c, int side, double* step) const {
  constexpr double kTie = 1e-12;
  int blocking = -1;
  double best_pivot = 0.0;
  for (std::size_t k = 0; k < active.size(); ++k) {
    const ActiveConstraint& entry = active[k];
    const double rate = side * entry.side * factors.exchange()[k];
    const double pivot = rate * constraints.weight(c) / constraints.weight(entry.constraint);
    if (!(pivot > kPivot)) continue;
    const double signed_multiplier = entry.side * multipliers[static_cast<Eigen::Index>(k)];
    const double ratio = std::max(signed_multiplier, 0.0) / rate;
    const bool sooner = ratio < *step * (1.0 - kTie);
    const bool tie = !sooner && ratio <= *step * (1.0 + kTie) && pivot > best_pivot;
    if (!sooner && !tie) continue;
    *step = ratio;
    best_pivot = pivot;
    blocking = static_cast<int>(k);
  }
  return blocking;
}

// Farkas' lemma: the normal of c is a combination N r of active normals, with signs such that their
// limits keep normal . x away from the limit of c. The gap between the two must exceed what
// rounding of the limits and the remainder of the normal outside N r can explain.
bool QpSolver::Workspace::is_contradiction(int c, int side) {
  residual.setZero();
  constraints.add_normal(c, 1.0, residual.data());
  double reach = active_limit({c, side});
  double size = std::abs(reach);
  for (std::size_t k = 0; k < active.size(); ++k) {
    const double coefficient = factors.exchange()[k];
    constraints.add_normal(active[k].constraint, -coefficient, residual.data());
    const double term = coefficient * active_limit(active[k]);
    reach -= term;
    size += std::abs(term);
  }
  double missed = 0.0;
  for (int j = 0; j < variables; ++j) missed += std::abs(residual[j] * x[j]);
  const double noise = 8.0 * kEpsilon * variables * iterate_size / constraints.weight(c);
  return side * reach > settings.tolerance * size + 10.0 * missed + noise;
}

}  // namespace sinew::qp
