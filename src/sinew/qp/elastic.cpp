#include "sinew/qp/elastic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew::qp {

namespace {

/// Weight of the proximal term relative to the violation: steps reach 1/kElasticProximal times the
/// distance over which the steepest row would lose its violation.
constexpr double kElasticProximal = 1e-3;
/// After this many steps, four steps with an ever weaker term come between two steps with the full
/// one, to move far along a nearly level edge. Only full steps decide termination, since weak ones
/// have larger rounding errors.
constexpr int kFullSteps = 3;
constexpr int kCycle = 5;
/// A proximal step shorter than this, relative to that distance, ends the search.
constexpr double kStill = 1e-9;
/// Multipliers of the linear program below this, of one, are zero.
constexpr double kMultiplier = 1e-7;

double proximal_share(int step) {
  const int weaker = step < kFullSteps ? 0 : (step - kFullSteps + 1) % kCycle;
  return std::pow(0.1, weaker);
}

double excess(double value, double lower, double upper) {
  if (value < lower) return value - lower;
  return value > upper ? value - upper : 0.0;
}

}  // namespace

std::string_view elastic_status_name(ElasticStatus status) {
  constexpr std::array<std::string_view, 6> kNames = {
      "optimal", "relaxed", "unbounded", "not-convex", "not-finite", "iteration-limit"};
  return kNames.at(static_cast<std::size_t>(status));
}

/// The linear program has variables (x, t), with one t for `worst` and one per row for `sum`, and
/// 2 m rows w_i C_i x + t >= w_i lower_i and w_i C_i x - t <= w_i upper_i; frozen rows have no t.
struct ElasticSolver::Workspace {
  Workspace(int n, int m, const ElasticSettings& chosen);

  void solve(const QuadraticProgram& problem);
  void check_weights() const;

  int variables, constraints;
  ElasticSettings settings;
  VectorX weight;  ///< (m)
  QpSolver plain, linear, final_solver;
  ElasticResult result;

 private:
  ElasticStatus relax(const QuadraticProgram& problem);
  bool relax_worst(const QuadraticProgram& problem);
  bool relax_sum(const QuadraticProgram& problem);
  /// Minimises the violation of the rows that are not frozen, from `point` on; moves `point`.
  bool minimise_violation();
  void load_bounds(const QuadraticProgram& problem);
  void load_rows();
  void load_proximal_term(double share);
  double violation_at(const VectorX& x, int row) const;
  double worst_violation() const;
  double row_multiplier(int row) const;
  int slack(int row) const {
    return variables + (settings.measure == ElasticMeasure::sum ? row : 0);
  }
  void accept_point();
  void report(const QuadraticProgram& problem);

  QuadraticProgram program;  ///< the linear program with its proximal term
  QuadraticProgram target;   ///< the problem with relaxed limits
  VectorX scale;             ///< (n) sqrt(G_ii)
  VectorX point;             ///< (n) best point so far
  VectorX slacks;            ///< (1 or m) its t
  VectorX bound_multiplier, row_multipliers;
  std::vector<std::uint8_t> frozen;  ///< (m) 1: the row is in no further stage
  double steepest = 1.0;             ///< max |w_i D^-1 C_i|
  double violation_size = 1.0;       ///< worst violation at the start of the stage
};

ElasticSolver::Workspace::Workspace(int n, int m, const ElasticSettings& chosen)
    : variables(n),
      constraints(m),
      settings(chosen),
      plain(n, m, chosen.qp),
      linear(n + (chosen.measure == ElasticMeasure::sum ? m : 1), 2 * m, chosen.qp),
      final_solver(n, m, chosen.qp) {
  const int slack_count = chosen.measure == ElasticMeasure::sum ? m : 1;
  program = QuadraticProgram::sized(n + slack_count, 2 * m);
  target = QuadraticProgram::sized(n, m);
  weight.setOnes(m);
  scale.setOnes(n);
  point.setZero(n);
  slacks.setZero(slack_count);
  bound_multiplier.setZero(n + slack_count);
  row_multipliers.setZero(2 * m);
  frozen.assign(static_cast<std::size_t>(m), 0);
  result.violation.setZero(m);
  result.qp.x.setZero(n);
  result.qp.bound_multiplier.setZero(n);
  result.qp.row_multiplier.setZero(m);
  result.qp.ray.setZero(n);
}

void ElasticSolver::Workspace::check_weights() const {
  if (weight.size() != constraints) {
    throw Error(ErrorKind::wrong_shape, {.item = "row_weight"},
                fmt::format("expected {} weights, got {}", constraints, weight.size()),
                "give one weight a row");
  }
  for (const double each : weight) {
    if (each > 0.0 && std::isfinite(each)) continue;
    throw Error(ErrorKind::out_of_range, {.item = "row_weight"},
                fmt::format("the weight {} is not positive and finite", each),
                "leave out rows that do not matter instead");
  }
}

void ElasticSolver::Workspace::solve(const QuadraticProgram& problem) {
  check_weights();
  result.programs = 1;
  result.qp = plain.solve(problem);
  switch (result.qp.status) {
    case QpStatus::optimal:
      result.status = ElasticStatus::optimal;
      break;
    case QpStatus::infeasible:
      result.status = relax(problem);
      break;
    case QpStatus::unbounded:
      result.status = ElasticStatus::unbounded;
      break;
    case QpStatus::not_convex:
      result.status = ElasticStatus::not_convex;
      break;
    case QpStatus::not_finite:
      result.status = ElasticStatus::not_finite;
      break;
    case QpStatus::iteration_limit:
      result.status = ElasticStatus::iteration_limit;
      break;
  }
  if (result.status == ElasticStatus::iteration_limit) {
    result.qp.x = result.qp.x.cwiseMax(problem.lower).cwiseMin(problem.upper);
  }
  report(problem);
}

ElasticStatus ElasticSolver::Workspace::relax(const QuadraticProgram& problem) {
  target.hessian = problem.hessian;
  target.gradient = problem.gradient;
  target.lower = problem.lower;
  target.upper = problem.upper;
  target.rows = problem.rows;
  target.row_lower = problem.row_lower;
  target.row_upper = problem.row_upper;
  scale = problem.hessian.diagonal().unaryExpr(
      [](double diagonal) { return diagonal > 0.0 ? std::sqrt(diagonal) : 1.0; });
  point = result.qp.x.cwiseMax(problem.lower).cwiseMin(problem.upper);
  std::fill(frozen.begin(), frozen.end(), std::uint8_t{0});
  load_bounds(problem);
  const bool worst = settings.measure == ElasticMeasure::worst;
  const bool found = worst ? relax_worst(problem) : relax_sum(problem);
  if (!found) {
    result.qp.x = point;
    return ElasticStatus::iteration_limit;
  }
  ++result.programs;
  const QpResult& relaxed = final_solver.solve(target);
  if (relaxed.status == QpStatus::optimal) {
    result.qp = relaxed;
    return ElasticStatus::relaxed;
  }
  result.qp.x = point;
  return relaxed.status == QpStatus::unbounded ? ElasticStatus::unbounded
                                               : ElasticStatus::iteration_limit;
}

// Rows with a multiplier are in conflict: no point is better in one without being worse in another.
// They keep this violation; the other rows go on to the next stage.
bool ElasticSolver::Workspace::relax_worst(const QuadraticProgram& problem) {
  double first = 0.0;
  for (int stage = 0; stage < constraints; ++stage) {
    if (!minimise_violation()) return false;
    const double worst = worst_violation();
    first = std::max(first, worst);
    if (worst <= settings.tolerance * first) break;
    bool any = false;
    for (int i = 0; i < constraints; ++i) {
      if (frozen[static_cast<std::size_t>(i)] || std::abs(row_multiplier(i)) <= kMultiplier)
        continue;
      const double value = problem.rows.row(i).dot(point);
      target.row_lower[i] = std::min(problem.row_lower[i], value);
      target.row_upper[i] = std::max(problem.row_upper[i], value);
      frozen[static_cast<std::size_t>(i)] = 1;
      any = true;
    }
    if (!any) return false;
  }
  accept_point();
  return true;
}

// The points of least sum are those complementary to the multipliers (any of them): rows with a
// multiplier of one are at or beyond their limit, those with less are at it, those with zero
// within; variables with a multiplier do not change.
bool ElasticSolver::Workspace::relax_sum(const QuadraticProgram& problem) {
  if (!minimise_violation()) return false;
  for (int i = 0; i < constraints; ++i) {
    const double multiplier = row_multiplier(i);
    if (std::abs(multiplier) <= kMultiplier) continue;
    const double value = problem.rows.row(i).dot(point);
    const bool beyond = std::abs(multiplier) >= 1.0 - kMultiplier;
    target.row_lower[i] = multiplier > 0.0 && beyond ? -kInfinity : value;
    target.row_upper[i] = multiplier < 0.0 && beyond ? kInfinity : value;
    if (beyond && multiplier > 0.0) target.row_upper[i] = problem.row_lower[i];
    if (beyond && multiplier < 0.0) target.row_lower[i] = problem.row_upper[i];
  }
  for (int j = 0; j < variables; ++j) {
    if (std::abs(bound_multiplier[j]) <= kMultiplier * steepest * scale[j]) continue;
    target.lower[j] = target.upper[j] = point[j];
  }
  accept_point();
  return true;
}

// Rounding may leave the point just outside a limit; the target must admit it.
void ElasticSolver::Workspace::accept_point() {
  for (int i = 0; i < constraints; ++i) {
    const double value = target.rows.row(i).dot(point);
    target.row_lower[i] = std::min(target.row_lower[i], value);
    target.row_upper[i] = std::max(target.row_upper[i], value);
  }
}

void ElasticSolver::Workspace::load_bounds(const QuadraticProgram& problem) {
  program.lower.head(variables) = problem.lower;
  program.upper.head(variables) = problem.upper;
  program.lower.tail(slacks.size()).setZero();
  steepest = 0.0;
  for (int i = 0; i < constraints; ++i) {
    double length = 0.0;
    for (int j = 0; j < variables; ++j) {
      const double entry = weight[i] * problem.rows(i, j);
      program.rows(i, j) = program.rows(constraints + i, j) = entry;
      length = std::hypot(length, entry / scale[j]);
    }
    steepest = std::max(steepest, length);
  }
  if (steepest == 0.0) steepest = 1.0;
}

void ElasticSolver::Workspace::load_rows() {
  for (int i = 0; i < constraints; ++i) {
    const double share = frozen[static_cast<std::size_t>(i)] ? 0.0 : 1.0;
    program.rows(i, slack(i)) = share;
    program.rows(constraints + i, slack(i)) = -share;
    program.row_lower[i] = weight[i] * target.row_lower[i];
    program.row_upper[constraints + i] = weight[i] * target.row_upper[i];
  }
}

void ElasticSolver::Workspace::load_proximal_term(double share) {
  const double slack_stiffness = share * kElasticProximal / violation_size;
  const double stiffness = slack_stiffness * steepest * steepest;
  for (int j = 0; j < variables; ++j) {
    program.hessian(j, j) = stiffness * scale[j] * scale[j];
    program.gradient[j] = -program.hessian(j, j) * point[j];
  }
  for (Eigen::Index k = 0; k < slacks.size(); ++k) {
    program.hessian(variables + k, variables + k) = slack_stiffness;
    program.gradient[variables + k] = 1.0 - slack_stiffness * slacks[k];
  }
}

double ElasticSolver::Workspace::violation_at(const VectorX& x, int row) const {
  const double value = target.rows.row(row).dot(x);
  return weight[row] * std::abs(excess(value, target.row_lower[row], target.row_upper[row]));
}

double ElasticSolver::Workspace::worst_violation() const {
  double worst = 0.0;
  for (int i = 0; i < constraints; ++i) {
    if (!frozen[static_cast<std::size_t>(i)]) worst = std::max(worst, violation_at(point, i));
  }
  return worst;
}

double ElasticSolver::Workspace::row_multiplier(int row) const {
  return row_multipliers[row] + row_multipliers[constraints + row];
}

bool ElasticSolver::Workspace::minimise_violation() {
  violation_size = worst_violation();
  row_multipliers.setZero();
  if (violation_size == 0.0) return true;
  slacks.setConstant(violation_size);
  if (settings.measure == ElasticMeasure::sum) {
    for (int i = 0; i < constraints; ++i) slacks[i] = violation_at(point, i);
  }
  load_rows();
  const double reach = violation_size / steepest;
  for (int step = 0; step < settings.max_proximal_steps; ++step) {
    const double share = proximal_share(step);
    load_proximal_term(share);
    ++result.programs;
    const QpResult& next = linear.solve(program);
    if (next.status != QpStatus::optimal) return false;
    double moved = 0.0;
    double size = 0.0;
    for (int j = 0; j < variables; ++j) {
      moved = std::max(moved, scale[j] * std::abs(next.x[j] - point[j]));
      size = std::max(size, scale[j] * std::abs(next.x[j]));
      point[j] = next.x[j];
    }
    double changed = 0.0;
    for (Eigen::Index k = 0; k < slacks.size(); ++k) {
      changed = std::max(changed, std::abs(slacks[k] - next.x[variables + k]));
      slacks[k] = next.x[variables + k];
    }
    bound_multiplier = next.bound_multiplier;
    row_multipliers = next.row_multiplier;
    const double rounding = 1e-12 * size;
    if (share == 1.0 && moved <= kStill * reach + rounding &&
        changed <= kStill * violation_size + rounding * steepest) {
      return true;
    }
  }
  return false;
}

void ElasticSolver::Workspace::report(const QuadraticProgram& problem) {
  result.violation.setZero();
  result.relaxed = 0;
  if (result.status == ElasticStatus::not_convex || result.status == ElasticStatus::not_finite)
    return;
  double worst = 0.0;
  for (int i = 0; i < constraints; ++i) {
    const double value = problem.rows.row(i).dot(result.qp.x);
    result.violation[i] = excess(value, problem.row_lower[i], problem.row_upper[i]);
    worst = std::max(worst, weight[i] * std::abs(result.violation[i]));
  }
  const bool none = result.status == ElasticStatus::optimal;
  for (int i = 0; i < constraints; ++i) {
    const double size = weight[i] * std::abs(result.violation[i]);
    if (none || size <= settings.tolerance * worst) result.violation[i] = 0.0;
    if (result.violation[i] != 0.0) ++result.relaxed;
  }
}

ElasticSolver::ElasticSolver(int variables, int constraints, ElasticSettings settings)
    : work_(std::make_unique<Workspace>(variables, constraints, settings)) {}
ElasticSolver::~ElasticSolver() = default;
ElasticSolver::ElasticSolver(ElasticSolver&&) noexcept = default;
ElasticSolver& ElasticSolver::operator=(ElasticSolver&&) noexcept = default;

const ElasticResult& ElasticSolver::solve(const QuadraticProgram& problem) {
  work_->weight.setOnes(work_->constraints);
  work_->solve(problem);
  return work_->result;
}

const ElasticResult& ElasticSolver::solve(const QuadraticProgram& problem,
                                          const VectorX& row_weight) {
  work_->weight = row_weight;
  work_->solve(problem);
  return work_->result;
}

void ElasticSolver::reset() {
  work_->plain.reset();
  work_->linear.reset();
  work_->final_solver.reset();
}

ElasticResult solve_elastic(const QuadraticProgram& problem, const ElasticSettings& settings) {
  const auto variables = static_cast<int>(problem.gradient.size());
  const auto constraints = static_cast<int>(problem.row_lower.size());
  return ElasticSolver(variables, constraints, settings).solve(problem);
}

}  // namespace sinew::qp
