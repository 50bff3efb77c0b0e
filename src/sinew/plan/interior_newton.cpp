// The program in scaled unknowns is min f(x), with c(x) = b for equations and c(x) - s = 0 with
// bounds on s for the other rows. z are the multipliers of bounds, and S_x and S_s the diagonals
// z/(distance from the bound). After elimination of s and z, a step solves
//   [ H + S_x + d I   J^T  ] [dx]      [ grad f + J^T y - mu/(x - l) + mu/(u - x) ]
//   [ J              -1/S_s ] [dy] = - [ c - s + r_s/S_s, r_s = -y - mu/(s - l) + mu/(u - s) ]
// (c - b, and no 1/S_s, for equations), with d >= 0 such that the matrix has as many negative
// eigenvalues as it has rows of J.
#include "sinew/plan/interior_newton.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sinew/linalg/frontal_factorisation.hpp"

namespace sinew::plan {

namespace {

constexpr int kMaxSteps = 30;
/// Initial distance from bounds, relative to the bound and to the distance between bounds, and
/// minimum of the initial multipliers.
constexpr double kInside = 1e-3;
constexpr double kMinBarrier = 1e-11;
/// Increase of the error at which the solver gives up.
constexpr double kLost = 1e6;

/// Values between bounds, with the multipliers of the bounds.
struct Bounded {
  /// Minimum distance from a bound, so that rounding never reaches it (Waechter & Biegler 2006,
  /// sec. 3.5).
  static double gap(double bound) {
    static const double small = std::pow(std::numeric_limits<double>::epsilon(), 0.75);
    return small * std::max(1.0, std::abs(bound));
  }

  VectorX value, lower, upper, lower_multiplier, upper_multiplier;

  Eigen::Index size() const { return value.size(); }
  bool has_lower(Eigen::Index i) const { return lower[i] > -kNoBound; }
  bool has_upper(Eigen::Index i) const { return upper[i] < kNoBound; }

  void push_inside() {
    for (Eigen::Index i = 0; i < size(); ++i) {
      const double between = upper[i] - lower[i];
      if (has_lower(i)) {
        value[i] = std::max(
            value[i],
            lower[i] + std::min(kInside * std::max(1.0, std::abs(lower[i])), kInside * between));
      }
      if (has_upper(i)) {
        value[i] = std::min(
            value[i],
            upper[i] - std::min(kInside * std::max(1.0, std::abs(upper[i])), kInside * between));
      }
      lower_multiplier[i] = has_lower(i) ? std::max(lower_multiplier[i], kInside) : 0.0;
      upper_multiplier[i] = has_upper(i) ? std::max(upper_multiplier[i], kInside) : 0.0;
    }
  }
  /// Contributions of bounds to the diagonal, and to the gradient: -mu/(x - l) + mu/(u - x).
  double stiffness(Eigen::Index i) const {
    return (has_lower(i) ? lower_multiplier[i] / (value[i] - lower[i]) : 0.0) +
           (has_upper(i) ? upper_multiplier[i] / (upper[i] - value[i]) : 0.0);
  }
  double push(Eigen::Index i, double barrier) const {
    return (has_lower(i) ? -barrier / (value[i] - lower[i]) : 0.0) +
           (has_upper(i) ? barrier / (upper[i] - value[i]) : 0.0);
  }
  /// Calls visit(distance, multiplier, change of each along a step) for each bound.
  template <typename Visit>
  void each_bound(const VectorX& step, double barrier, const Visit& visit) const {
    for (Eigen::Index i = 0; i < size(); ++i) {
      if (has_lower(i)) {
        const double distance = value[i] - lower[i], z = lower_multiplier[i];
        visit(distance, z, step[i], (barrier - z * step[i]) / distance - z);
      }
      if (has_upper(i)) {
        const double distance = upper[i] - value[i], z = upper_multiplier[i];
        visit(distance, z, -step[i], (barrier + z * step[i]) / distance - z);
      }
    }
  }
  void move(const VectorX& step, double barrier, double along, double along_multipliers) {
    for (Eigen::Index i = 0; i < size(); ++i) {
      if (has_lower(i)) {
        double& z = lower_multiplier[i];
        z += along_multipliers * ((barrier - z * step[i]) / (value[i] - lower[i]) - z);
      }
      if (has_upper(i)) {
        double& z = upper_multiplier[i];
        z += along_multipliers * ((barrier + z * step[i]) / (upper[i] - value[i]) - z);
      }
      value[i] += along * step[i];
      if (has_lower(i)) value[i] = std::max(value[i], lower[i] + gap(lower[i]));
      if (has_upper(i)) value[i] = std::min(value[i], upper[i] - gap(upper[i]));
    }
  }
};

class Solver {
 public:
  Solver(NonlinearProgram& program, const ProgramPoint& start);
  bool run(const SolverSettings& settings);
  ProgramResult result() const;

 private:
  std::vector<linalg::SparseEntry> places();
  void evaluate();
  double error() const;
  bool factor();
  void step(double barrier);
  /// Mean of distance times multiplier after a fraction of the step.
  double complementarity_after(double barrier, double along, double along_multipliers) const;
  /// Largest steps of values and multipliers that use at most a fraction of the distance to their
  /// bounds.
  std::pair<double, double> longest(double barrier, double fraction) const;

  NonlinearProgram& program_;
  VectorX all_;                            // unscaled, including fixed variables
  std::vector<int> free_;                  // unknown of each variable; -1: fixed
  std::vector<int> variable_;              // variable of each unknown
  std::vector<Eigen::Index> bounded_row_;  // rows that are not equations
  VectorX row_scale_, variable_scale_;
  double objective_scale_;

  Bounded x_, s_;
  VectorX y_, target_;    // multipliers of rows; right-hand sides of equations
  VectorX c_, gradient_;  // scaled; grad f + J^T y
  VectorX row_error_;
  std::vector<double> jacobian_, hessian_, values_;
  std::vector<std::size_t> hessian_taken_,
      jacobian_taken_;  // entries of the patterns between free variables
  linalg::FrontalFactorisation factorisation_;
  VectorX right_, solution_, product_, dx_, ds_;
  double regularisation_ = 0.0;
  int steps_ = 0;
};

std::vector<linalg::SparseEntry> Solver::places() {
  std::vector<linalg::SparseEntry> result;
  const auto& hessian = program_.hessian_pattern();
  for (std::size_t e = 0; e < hessian.size(); ++e) {
    const int i = free_[static_cast<std::size_t>(hessian[e].row)],
              j = free_[static_cast<std::size_t>(hessian[e].column)];
    if (i < 0 || j < 0) continue;
    hessian_taken_.push_back(e);
    result.push_back({i, j});
  }
  const auto unknowns = static_cast<int>(variable_.size());
  const auto& jacobian = program_.jacobian_pattern();
  for (std::size_t e = 0; e < jacobian.size(); ++e) {
    const int j = free_[static_cast<std::size_t>(jacobian[e].column)];
    if (j < 0) continue;
    jacobian_taken_.push_back(e);
    result.push_back({unknowns + jacobian[e].row, j});
  }
  const auto size = unknowns + static_cast<int>(program_.constraint_bounds().lower.size());
  for (int i = 0; i < size; ++i) result.push_back({i, i});
  return result;
}

Solver::Solver(NonlinearProgram& program, const ProgramPoint& start)
    : program_(program),
      all_(start.x),
      row_scale_(program.constraint_scale()),
      objective_scale_(program.objective_scale()),
      factorisation_([&] {
        const Bounds& bounds = program.variable_bounds();
        for (Eigen::Index i = 0; i < all_.size(); ++i) {
          const bool fixed = bounds.lower[i] == bounds.upper[i];
          if (fixed) all_[i] = bounds.lower[i];
          free_.push_back(fixed ? -1 : static_cast<int>(variable_.size()));
          if (!fixed) variable_.push_back(static_cast<int>(i));
        }
        std::vector<linalg::SparseEntry> entries = places();
        const int size = static_cast<int>(variable_.size()) +
                         static_cast<int>(program.constraint_bounds().lower.size());
        return linalg::FrontalFactorisation(size, std::move(entries));
      }()) {
  const auto scaled = [](const VectorX& values, const VectorX& scale) {
    return VectorX(
        (values.array().abs() >= kNoBound).select(values.array(), values.array() / scale.array()));
  };
  const auto pick = [&](const VectorX& from) { return VectorX(from(variable_)); };
  const Bounds& bounds = program.variable_bounds();
  variable_scale_ = pick(program.variable_scale());
  x_ = {pick(all_).cwiseQuotient(variable_scale_), scaled(pick(bounds.lower), variable_scale_),
        scaled(pick(bounds.upper), variable_scale_),
        pick(start.lower_multipliers).cwiseProduct(variable_scale_) / objective_scale_,
        pick(start.upper_multipliers).cwiseProduct(variable_scale_) / objective_scale_};
  x_.push_inside();
  y_ = start.constraint_multipliers.cwiseProduct(row_scale_) / objective_scale_;
  const Bounds& rows = program.constraint_bounds();
  target_ = rows.lower.cwiseQuotient(row_scale_);
  for (Eigen::Index i = 0; i < rows.lower.size(); ++i) {
    if (rows.lower[i] != rows.upper[i]) bounded_row_.push_back(i);
  }
  evaluate();
  s_ = {c_(bounded_row_), scaled(rows.lower, row_scale_)(bounded_row_),
        scaled(rows.upper, row_scale_)(bounded_row_), -y_(bounded_row_), y_(bounded_row_)};
  s_.push_inside();
}

void Solver::evaluate() {
  for (std::size_t k = 0; k < variable_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    all_[variable_[k]] = x_.value[i] * variable_scale_[i];
  }
  program_.constraints(all_, c_);
  c_ = c_.cwiseQuotient(row_scale_);
  VectorX slope;
  program_.gradient(all_, slope);
  gradient_ = VectorX(slope(variable_)).cwiseProduct(variable_scale_) / objective_scale_;
  jacobian_.resize(program_.jacobian_pattern().size());
  program_.jacobian(all_, jacobian_.data());
  // Scales entries in the order of places(). The Hessian and the diagonal are set in factor().
  values_.resize(hessian_taken_.size());
  const auto& pattern = program_.jacobian_pattern();
  for (const std::size_t e : jacobian_taken_) {
    const auto& [row, column] = pattern[e];
    const double value = jacobian_[e] * program_.variable_scale()[column] / row_scale_[row];
    values_.push_back(value);
    gradient_[free_[static_cast<std::size_t>(column)]] += y_[row] * value;
  }
}

double Solver::error() const {
  // Error of the scaled optimality conditions (Waechter & Biegler 2006, eq. 5 and 6).
  double sum = y_.lpNorm<1>(), bounds = 0.0, count = 0.0, complementarity = 0.0;
  const auto visit = [&](double distance, double z, double, double) {
    bounds += z;
    count += 1.0;
    complementarity = std::max(complementarity, distance * z);
  };
  x_.each_bound(VectorX::Zero(x_.size()), 0.0, visit);
  s_.each_bound(VectorX::Zero(s_.size()), 0.0, visit);
  sum += bounds;
  constexpr double kMaxMultiplier = 100.0;
  const double dual_scale =
      std::max(kMaxMultiplier, sum / (static_cast<double>(y_.size()) + std::max(count, 1.0))) /
      kMaxMultiplier;
  const double bound_scale =
      std::max(kMaxMultiplier, bounds / std::max(count, 1.0)) / kMaxMultiplier;
  double dual = (gradient_ - x_.lower_multiplier + x_.upper_multiplier).lpNorm<Eigen::Infinity>();
  if (s_.size() > 0) {
    dual = std::max(dual, (-VectorX(y_(bounded_row_)) - s_.lower_multiplier + s_.upper_multiplier)
                              .lpNorm<Eigen::Infinity>());
  }
  return std::max(
      {dual / dual_scale, row_error_.lpNorm<Eigen::Infinity>(), complementarity / bound_scale});
}

bool Solver::factor() {
  hessian_.resize(program_.hessian_pattern().size());
  program_.hessian(all_, 1.0 / objective_scale_, y_.cwiseQuotient(row_scale_), hessian_.data());
  for (std::size_t k = 0; k < hessian_taken_.size(); ++k) {
    const std::size_t e = hessian_taken_[k];
    const auto& [i, j] = program_.hessian_pattern()[e];
    values_[k] = hessian_[e] * program_.variable_scale()[i] * program_.variable_scale()[j];
  }
  const auto unknowns = x_.size(), rows = y_.size();
  const std::size_t diagonal = hessian_taken_.size() + jacobian_taken_.size();
  values_.resize(diagonal + static_cast<std::size_t>(unknowns + rows));
  const auto set = [&](Eigen::Index i, double value) {
    values_[diagonal + static_cast<std::size_t>(i)] = value;
  };
  for (Eigen::Index i = 0; i < rows; ++i) set(unknowns + i, 0.0);
  for (Eigen::Index i = 0; i < s_.size(); ++i) {
    set(unknowns + bounded_row_[static_cast<std::size_t>(i)], -1.0 / s_.stiffness(i));
  }
  // Inertia correction (Waechter & Biegler 2006, algorithm IC), but without handling of dependent
  // equations.
  double trial = 0.0;
  for (int k = 0; k < 20; ++k) {
    for (Eigen::Index i = 0; i < unknowns; ++i) set(i, x_.stiffness(i) + trial);
    if (factorisation_.factor(values_) && factorisation_.negative() == rows) {
      if (trial > 0.0) regularisation_ = trial;
      return true;
    }
    if (trial == 0.0) {
      trial = regularisation_ > 0.0 ? std::max(1e-20, regularisation_ / 3.0) : 1e-4;
    } else {
      trial *= regularisation_ > 0.0 ? 8.0 : 100.0;
    }
  }
  return false;
}

void Solver::step(double barrier) {
  const auto unknowns = x_.size(), rows = y_.size();
  right_.resize(unknowns + rows);
  for (Eigen::Index i = 0; i < unknowns; ++i) right_[i] = -gradient_[i] - x_.push(i, barrier);
  right_.tail(rows) = -row_error_;
  for (Eigen::Index i = 0; i < s_.size(); ++i) {
    const Eigen::Index row = bounded_row_[static_cast<std::size_t>(i)];
    right_[unknowns + row] -= (s_.push(i, barrier) - y_[row]) / s_.stiffness(i);
  }
  solution_ = right_;
  factorisation_.solve(solution_);
  // One step of iterative refinement.
  factorisation_.multiply(values_, solution_, product_);
  product_ = right_ - product_;
  factorisation_.solve(product_);
  solution_ += product_;
  dx_ = solution_.head(unknowns);
  ds_.resize(s_.size());
  for (Eigen::Index i = 0; i < s_.size(); ++i) {
    const Eigen::Index row = bounded_row_[static_cast<std::size_t>(i)];
    ds_[i] = (solution_[unknowns + row] - (s_.push(i, barrier) - y_[row])) / s_.stiffness(i);
  }
}

double Solver::complementarity_after(double barrier, double along, double along_multipliers) const {
  double sum = 0.0, count = 0.0;
  const auto visit = [&](double distance, double z, double d_distance, double dz) {
    sum += (distance + along * d_distance) * (z + along_multipliers * dz);
    count += 1.0;
  };
  x_.each_bound(dx_, barrier, visit);
  s_.each_bound(ds_, barrier, visit);
  return count > 0.0 ? sum / count : 0.0;
}

std::pair<double, double> Solver::longest(double barrier, double fraction) const {
  double along = 1.0, along_multipliers = 1.0;
  const auto visit = [&](double distance, double z, double d_distance, double dz) {
    if (d_distance < 0.0) along = std::min(along, -fraction * distance / d_distance);
    if (dz < 0.0) along_multipliers = std::min(along_multipliers, -fraction * z / dz);
  };
  x_.each_bound(dx_, barrier, visit);
  s_.each_bound(ds_, barrier, visit);
  return {along, along_multipliers};
}

bool Solver::run(const SolverSettings& settings) {
  double least = std::numeric_limits<double>::infinity();
  const int most = std::min(kMaxSteps, settings.max_iterations);
  for (;; ++steps_) {
    row_error_ = c_ - target_;
    row_error_(bounded_row_) = c_(bounded_row_) - s_.value;
    const double now = error();
    if (!std::isfinite(now) || now > kLost * least) return false;
    if (now <= settings.tolerance) return true;
    least = std::min(least, now);
    if (steps_ == most || !factor()) return false;
    // The barrier follows from the complementarity after a probing step to the bounds.
    step(0.0);
    const double mean = complementarity_after(0.0, 0.0, 0.0);
    double barrier = 0.0;
    if (mean > 0.0) {
      const auto [along, along_multipliers] = longest(0.0, 1.0);
      const double after = complementarity_after(0.0, along, along_multipliers);
      barrier = std::max(kMinBarrier, std::min(std::pow(after / mean, 3), 100.0) * mean);
      step(barrier);
    }
    const auto [along, along_multipliers] = longest(barrier, std::max(0.99, 1.0 - barrier));
    y_ += along * solution_.tail(y_.size());
    x_.move(dx_, barrier, along, along_multipliers);
    s_.move(ds_, barrier, along, along_multipliers);
    evaluate();
    if (!c_.allFinite()) return false;
  }
}

ProgramResult Solver::result() const {
  ProgramResult result;
  result.status = Status::solved;
  const auto spread = [&](const VectorX& multipliers) {
    VectorX all = VectorX::Zero(all_.size());
    all(variable_) = multipliers.cwiseQuotient(variable_scale_) * objective_scale_;
    return all;
  };
  result.point = {all_, y_.cwiseQuotient(row_scale_) * objective_scale_,
                  spread(x_.lower_multiplier), spread(x_.upper_multiplier)};
  result.objective = program_.objective(all_);
  const Bounds& bounds = program_.constraint_bounds();
  const VectorX c = c_.cwiseProduct(row_scale_);
  result.violation = std::max(0.0, (bounds.lower - c).cwiseMax(c - bounds.upper).maxCoeff());
  result.iterations = steps_;
  return result;
}

}  // namespace

std::optional<ProgramResult> solve_nearby(NonlinearProgram& program, const ProgramPoint& start,
                                          const SolverSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  Solver solver(program, start);
  if (!solver.run(settings)) return std::nullopt;
  ProgramResult result = solver.result();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sinew::plan
