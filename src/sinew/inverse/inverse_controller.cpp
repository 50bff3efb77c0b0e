#include "sinew/inverse/inverse_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"

namespace sinew::inverse {

namespace {

using sim::ActuatorRange;
using sim::CommandKind;

// A limit is taken to bind when the solution comes this near, relative to its size.
constexpr double kActive = 1e-9;

bool near(double value, double limit) {
  return std::isfinite(limit) && std::abs(value - limit) <= kActive * (1.0 + std::abs(limit));
}

double infinity_norm(const MatrixX& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

}  // namespace

std::string_view inverse_status_name(InverseStatus status) {
  switch (status) {
    case InverseStatus::on_target:
      return "on-target";
    case InverseStatus::rate_limited:
      return "rate-limited";
    case InverseStatus::out_of_reach:
      return "out-of-reach";
    case InverseStatus::limits_conflict:
      return "limits-conflict";
  }
  return "unknown";
}

InverseController::InverseController(sim::Simulation& simulation, InverseSettings settings)
    : simulation_(simulation), settings_(std::move(settings)) {
  check_settings();
  const sim::Model& model = simulation_.model();
  std::vector<double> weights;
  for (const Task& task : settings_.tasks) {
    const auto& effector = model.effector(task.effector);
    for (int k = 0; k < effector.row_count(); ++k) {
      effector_rows_.push_back(effector.first_row() + k);
      const auto which = task.weights.size() == 1 ? 0 : static_cast<std::size_t>(k);
      weights.push_back(task.weights[which]);
    }
  }
  const auto rows = static_cast<Eigen::Index>(effector_rows_.size());
  const auto count = static_cast<Eigen::Index>(model.actuators().size());
  row_weights_ = Eigen::Map<VectorX>(weights.data(), rows);
  jacobian_.setZero(rows, count);
  weighted_.setZero(rows, count);
  residual_.setZero(rows);
  goal_.setZero(rows);
  scale_.setOnes(count);
  scaled_effort_.setZero(count);
  passive_.assign(static_cast<std::size_t>(count), Passive::held);
  program_ = qp::QuadraticProgram::sized(static_cast<int>(count), static_cast<int>(count));
  solver_ = qp::QpSolver(static_cast<int>(count), static_cast<int>(count));
  elastic_ = qp::ElasticSolver(static_cast<int>(count), static_cast<int>(count));
  efforts_.setZero(static_cast<Eigen::Index>(settings_.actuators.size()));
  simulation_.attach(*this, settings_.actuators);
  attached_ = true;
}

InverseController::~InverseController() { detach(); }

void InverseController::detach() {
  if (attached_) simulation_.detach(*this);
  attached_ = false;
}

void InverseController::check_settings() {
  const sim::Model& model = simulation_.model();
  if (settings_.tasks.empty()) {
    throw Error(ErrorKind::no_effectors, {.item = "controller"}, "there is no effector to steer",
                "name at least one effector and its target");
  }
  if (settings_.actuators.empty()) {
    for (std::size_t i = 0; i < model.actuators().size(); ++i) {
      if (model.actuators()[i].controllable()) settings_.actuators.push_back(static_cast<int>(i));
    }
  }
  if (settings_.actuators.empty()) {
    throw Error(ErrorKind::no_actuators, {.item = "controller"}, "the robot has no actuators",
                "add a cable");
  }
  for (const int index : settings_.actuators) {
    const auto& actuator = model.actuators().at(static_cast<std::size_t>(index));
    if (actuator.controllable()) continue;
    throw Error(ErrorKind::wrong_actuator_type, {.item = "actuator '" + actuator.name + "'"},
                "a spring's tension follows its stretch, a controller cannot choose it",
                "leave it out of the controller's actuators");
  }
  for (const double value : {settings_.epsilon, settings_.largest_step, settings_.tolerance}) {
    if (!(value > 0.0)) {
      throw Error(
          ErrorKind::out_of_range, {.item = "controller"},
          fmt::format("epsilon, largest_step and tolerance must be positive; one is {:g}", value),
          "leave it out for the default");
    }
  }
  for (const Task& task : settings_.tasks) {
    const auto& effector = model.effector(task.effector);
    const auto given = static_cast<int>(task.weights.size());
    if (given != 1 && given != effector.row_count()) {
      throw Error(ErrorKind::wrong_length, {.item = "weights of '" + effector.name() + "'"},
                  fmt::format("{} weights for {} directions", given, effector.row_count()),
                  "give one weight, or one for each direction");
    }
    for (const double weight : task.weights) {
      if (!(weight >= 0.0) || !std::isfinite(weight)) {
        throw Error(ErrorKind::out_of_range, {.item = "weights of '" + effector.name() + "'"},
                    fmt::format("a weight is {:g}", weight), "give zero or more");
      }
    }
  }
}

InverseStatus InverseController::step() {
  simulation_.step();
  return status_;
}

void InverseController::set_target(int task, Target target) {
  settings_.tasks.at(static_cast<std::size_t>(task)).target = std::move(target);
}

void InverseController::form_residual(const sim::LawProblem& problem) {
  Eigen::Index at = 0;
  for (const Task& task : settings_.tasks) {
    const auto& effector = problem.model.effector(task.effector);
    effector.target_delta(problem.placement, task.target.at(problem.time),
                          goal_.segment(at, effector.row_count()));
    at += effector.row_count();
  }
  // What is still to go from here, and how the free motion differs from here.
  double to_go = 0.0;
  for (Eigen::Index k = 0; k < residual_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    const double gap = goal_[k] - problem.delta[row];
    if (row_weights_[k] > 0.0) to_go += gap * gap;
  }
  const double most = settings_.largest_step * problem.model.size();
  const double share = std::sqrt(to_go) > most ? most / std::sqrt(to_go) : 1.0;
  shortened_ = share < 1.0;
  for (Eigen::Index k = 0; k < residual_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    const double step_goal = problem.delta[row] + share * (goal_[k] - problem.delta[row]);
    residual_[k] = problem.delta_free[row] - step_goal;
  }
}

void InverseController::form_objective(const sim::LawProblem& problem,
                                       std::span<const double> effort) {
  const auto& ranges = problem.actuators;
  const auto count = static_cast<Eigen::Index>(ranges.size());
  for (Eigen::Index j = 0; j < count; ++j) {
    const ActuatorRange& range = ranges[static_cast<std::size_t>(j)];
    const double own = problem.compliance(range.row, range.row);
    const double limit = std::max(std::abs(range.effort_min), std::abs(range.effort_max));
    scale_[j] = std::isfinite(limit) && limit > 0.0 ? limit
                : own > 0.0 ? problem.model.size() / (range.motion_scale * own)
                            : 1.0;
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    const int column = ranges[static_cast<std::size_t>(j)].row;
    for (Eigen::Index i = 0; i < count; ++i) {
      const int row = ranges[static_cast<std::size_t>(i)].row;
      program_.rows(i, j) = scale_[j] * problem.compliance(row, column);
    }
    for (Eigen::Index k = 0; k < residual_.size(); ++k) {
      const int row = effector_rows_[static_cast<std::size_t>(k)];
      jacobian_(k, j) = scale_[j] * problem.compliance(row, column);
      weighted_(k, j) = row_weights_[k] * jacobian_(k, j);
    }
  }
  auto& hessian = program_.hessian;
  hessian.noalias() = jacobian_.transpose() * weighted_;
  program_.gradient.noalias() = weighted_.transpose() * residual_;
  double regular_norm = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    double sum = 0.0;
    for (Eigen::Index j = 0; j < count; ++j) sum += std::abs(scale_[i] * program_.rows(i, j));
    regular_norm = std::max(regular_norm, sum);
  }
  const double eps =
      regular_norm > 0.0 ? settings_.epsilon * infinity_norm(hessian) / regular_norm : 1.0;
  const bool change = settings_.regularisation == Regularisation::change;
  const double keep = change ? 1.0 - settings_.relaxation : 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      const double regular = eps * scale_[i] * program_.rows(i, j);
      const double before =
          effort[static_cast<std::size_t>(ranges[static_cast<std::size_t>(j)].row)] / scale_[j];
      hessian(i, j) += regular;
      program_.gradient[i] -= keep * regular * before;
    }
  }
}

void InverseController::form_limits(const sim::LawProblem& problem) {
  for (std::size_t k = 0; k < problem.actuators.size(); ++k) {
    const ActuatorRange& range = problem.actuators[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double free = problem.delta_free[range.row];
    double low = range.effort_min;
    double high = range.effort_max;
    double from = range.motion_min;
    double to = range.motion_max;
    if (!range.owned) {
      const bool held = range.kind == CommandKind::motion && passive_[k] == Passive::held;
      const double given = range.kind == CommandKind::effort  ? range.value
                           : passive_[k] == Passive::at_least ? range.effort_min
                                                              : range.effort_max;
      low = held ? -INFINITY : given;
      high = held ? INFINITY : given;
      from = held ? range.value : -INFINITY;
      to = held ? range.value : INFINITY;
    }
    program_.lower[i] = low / scale_[i];
    program_.upper[i] = high / scale_[i];
    program_.row_lower[i] = from - free;
    program_.row_upper[i] = to - free;
  }
}

sim::LawStatus InverseController::solve_program(const sim::LawProblem& problem) {
  sim::LawStatus status = sim::LawStatus::solved;
  for (std::size_t round = 0; round <= 2 * passive_.size(); ++round) {
    form_limits(problem);
    const qp::QpResult& result = solver_.solve(program_);
    if (result.status == qp::QpStatus::infeasible) {
      const qp::ElasticResult& nearest = elastic_.solve(program_);
      const bool usable = nearest.status == qp::ElasticStatus::optimal ||
                          nearest.status == qp::ElasticStatus::relaxed;
      if (!usable) return sim::LawStatus::failed;
      scaled_effort_ = nearest.qp.x;
      status = sim::LawStatus::limits_conflict;
    } else if (result.status != qp::QpStatus::optimal) {
      return sim::LawStatus::failed;
    } else {
      scaled_effort_ = result.x;
    }
    if (!settle_passive_rows(problem)) break;
  }
  return status;
}

// A row that nobody owns and whose motion is commanded is held there whatever effort that takes;
// where it takes more than there is, the effort stays at its limit (a slack cable, a stalled drive)
// and the row moves, until it would move against that limit.
bool InverseController::settle_passive_rows(const sim::LawProblem& problem) {
  bool changed = false;
  for (std::size_t k = 0; k < passive_.size(); ++k) {
    const ActuatorRange& range = problem.actuators[k];
    if (range.owned || range.kind != CommandKind::motion) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const double effort = scale_[i] * scaled_effort_[i];
    const double motion =
        problem.delta_free[range.row] + program_.rows.row(i).dot(scaled_effort_) - range.value;
    const double nothing = kActive * problem.model.size() / range.motion_scale;
    const double negligible = kActive * scale_[i];
    const Passive before = passive_[k];
    if (before == Passive::held && effort < range.effort_min - negligible) {
      passive_[k] = Passive::at_least;
    } else if (before == Passive::held && effort > range.effort_max + negligible) {
      passive_[k] = Passive::at_most;
    } else if ((before == Passive::at_least && motion < -nothing) ||
               (before == Passive::at_most && motion > nothing)) {
      passive_[k] = Passive::held;
    }
    changed = changed || passive_[k] != before;
  }
  return changed;
}

sim::LawStatus InverseController::solve(const sim::LawProblem& problem, std::span<double> effort) {
  form_residual(problem);
  form_objective(problem, effort);
  std::ranges::fill(passive_, Passive::held);
  const sim::LawStatus status = solve_program(problem);
  if (status == sim::LawStatus::failed) return status;
  for (std::size_t k = 0; k < problem.actuators.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    effort[static_cast<std::size_t>(problem.actuators[k].row)] = scale_[i] * scaled_effort_[i];
  }
  for (std::size_t k = 0; k < settings_.actuators.size(); ++k) {
    const auto& range = problem.actuators[static_cast<std::size_t>(settings_.actuators[k])];
    efforts_[static_cast<Eigen::Index>(k)] = effort[static_cast<std::size_t>(range.row)];
  }
  judge(problem, status);
  return status;
}

void InverseController::judge(const sim::LawProblem& problem, sim::LawStatus law) {
  double left = 0.0;
  for (Eigen::Index k = 0; k < residual_.size(); ++k) {
    if (!(row_weights_[k] > 0.0)) continue;
    const double gap = residual_[k] + jacobian_.row(k).dot(scaled_effort_);
    left += gap * gap;
  }
  predicted_error_ = std::sqrt(left);
  if (law == sim::LawStatus::limits_conflict) {
    status_ = InverseStatus::limits_conflict;
    return;
  }
  if (predicted_error_ <= settings_.tolerance) {
    status_ = shortened_ ? InverseStatus::rate_limited : InverseStatus::on_target;
    return;
  }
  bool rate_binds = false;
  for (const int index : settings_.actuators) {
    const auto k = static_cast<std::size_t>(index);
    const ActuatorRange& range = problem.actuators[k];
    const auto& model = problem.model.actuators()[k];
    const auto i = static_cast<Eigen::Index>(index);
    const double lambda = scale_[i] * scaled_effort_[i];
    const double delta = problem.delta_free[range.row] + program_.rows.row(i).dot(scaled_effort_);
    rate_binds = rate_binds ||
                 (range.effort_max < model.effort.max && near(lambda, range.effort_max)) ||
                 (range.effort_min > model.effort.min && near(lambda, range.effort_min)) ||
                 (range.motion_max < model.motion.max && near(delta, range.motion_max)) ||
                 (range.motion_min > model.motion.min && near(delta, range.motion_min));
  }
  status_ = rate_binds ? InverseStatus::rate_limited : InverseStatus::out_of_reach;
}

double InverseController::violation(const sim::LawProblem&, std::span<const double>) const {
  return 0.0;
}

void InverseController::reset() {
  solver_.reset();
  elastic_.reset();
}

double InverseController::error(int task) const {
  const Task& asked = settings_.tasks.at(static_cast<std::size_t>(task));
  const auto& effector = simulation_.model().effector(asked.effector);
  const auto& placement = simulation_.world().placement();
  VectorX goal(effector.row_count());
  effector.target_delta(placement, asked.target.at(simulation_.time()), goal);
  double sum = 0.0;
  for (int k = 0; k < effector.row_count(); ++k) {
    const double gap = goal[k] - simulation_.world().delta()[effector.first_row() + k];
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

double InverseController::error() const {
  double worst = 0.0;
  for (std::size_t k = 0; k < settings_.tasks.size(); ++k) {
    worst = std::max(worst, error(static_cast<int>(k)));
  }
  return worst;
}

}  // namespace sinew::inverse
