#include "sinew/step/response.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/linalg/dense.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::step {

namespace {

// Friction of a cable within this part of the tension of its limit is at it.
constexpr double kSlides = 1e-7;
// Of what two rows' own compliances allow: where others are held, less is rounding.
constexpr double kCoupled = 1e-10;

}  // namespace

void Response::form(const StepProblem& problem, std::span<const double> effort, bool release) {
  release_ = release;
  decided_ = false;
  states_.swap(states_before_);
  states_.clear();
  controlled_.clear();
  controlled_rows_.clear();
  equations_.clear();
  effort_terms_.clear();
  motion_terms_.clear();
  holds_for_all_ = true;
  unsymmetric_ = bends_ = false;
  free_ = problem.delta_free;
  collect(problem, effort);
  const auto count = static_cast<Eigen::Index>(controlled_rows_.size());
  compliance_.resize(free_.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    compliance_.col(k) = problem.compliance.col(controlled_rows_[static_cast<std::size_t>(k)]);
  }
  if (!equations_.empty()) solve(problem, effort);
}

void Response::collect(const StepProblem& problem, std::span<const double> effort) {
  for (std::size_t i = 0; i < problem.actuators.size(); ++i) {
    const int row = problem.actuators[i].row;
    if (row < 0) continue;
    collect_actuator(problem, static_cast<int>(i), effort);
  }
  collect_capstans(problem, effort);
  for (const BilateralBlock& block : problem.bilaterals) {
    if (problem.compliance(block.row, block.row) != 0.0) add_held(block.row, block.motion);
  }
  for (const StiffnessBlock& block : problem.stiffness) {
    if (block.stiffness == 0.0) continue;
    add_held(block.row, problem.delta[block.row], 1.0 / block.stiffness);
  }
  for (const ContactBlock& block : problem.contacts) collect_contact(problem, block, effort);
}

void Response::collect_actuator(const StepProblem& problem, int index,
                                std::span<const double> efforts) {
  const ActuatorBlock& block = problem.actuators[static_cast<std::size_t>(index)];
  const Eigen::Map<const VectorX> all(efforts.data(), static_cast<Eigen::Index>(efforts.size()));
  const double effort = all[block.row];
  if (block.owned) {
    controlled_.push_back(index);
    controlled_rows_.push_back(block.row);
    return;
  }
  const auto give = [&](char state) {
    states_.push_back(state);
    if (effort != 0.0) free_ += effort * problem.compliance.col(block.row);
  };
  if (problem.compliance(block.row, block.row) == 0.0) return give('-');
  if (block.drive != nullptr) {
    // The tangent where the efforts have taken it.
    const double motion =
        problem.delta_free[block.row] + problem.compliance.row(block.row).dot(all);
    const auto at = block.drive->respond(block.drive_step, motion);
    holds_for_all_ = false;
    if (!(at.slope < 0.0)) return give('-');
    bends_ = true;
    const double compliance = -1.0 / at.slope;
    return add_held(block.row, motion + compliance * at.effort, compliance);
  }
  const bool motion = block.kind == CommandKind::motion;
  if (!motion && std::isinf(block.motion_min) && std::isinf(block.motion_max)) return give('-');
  holds_for_all_ = false;
  if (!motion && effort == block.value) return give('=');
  if (effort <= block.effort_min) return give('<');
  if (effort >= block.effort_max) return give('>');
  if (decides(problem, block.row)) {
    decided_ = true;
    if (release_) {
      const double least = motion ? 0.0 : block.value;
      const double left = std::clamp(least, block.effort_min, block.effort_max);
      if (left != 0.0) free_ += left * problem.compliance.col(block.row);
      return states_.push_back('r');
    }
  }
  add_held(block.row, motion                   ? block.value
                      : (effort < block.value) ? block.motion_max
                                               : block.motion_min);
}

// Whether the motion of a row is that of a controlled one: |W_ij|^2 = W_ii W_jj.
bool Response::decides(const StepProblem& problem, int row) {
  const double own = problem.compliance(row, row);
  return std::ranges::any_of(problem.actuators, [&](const ActuatorBlock& block) {
    if (!block.owned || block.row < 0) return false;
    const double both = problem.compliance(row, block.row);
    return both * both >= (1.0 - kCoupled) * own * problem.compliance(block.row, block.row) &&
           both != 0.0;
  });
}

void Response::collect_capstans(const StepProblem& problem, std::span<const double> effort) {
  for_each_guide(problem, effort, [&](const CapstanBlock& block, const GuideTension& tension) {
    // Before the guide: the cable's effort less what was lost so far.
    if (tension.first) {
      tension_.assign(1, {problem.actuators[static_cast<std::size_t>(block.cable)].row, 1.0});
    }
    holds_for_all_ = false;
    const double lost = effort[static_cast<std::size_t>(block.row)];
    const double blur = kSlides * tension.largest();
    const bool at_upper = lost >= tension.upper(block) - blur;
    if (at_upper || lost <= tension.lower(block) + blur) {
      // lost = grip tension, or -grip behind = -grip/(1 - grip) tension.
      const double factor = at_upper ? block.grip : -block.grip / (1.0 - block.grip);
      for (const Term& term : tension_) {
        effort_terms_.push_back({term.row, -factor * term.factor});
      }
      effort_terms_.push_back({block.row, 1.0});
      end_equation(block.row, 0.0);
      states_.push_back(at_upper ? '>' : '<');
      unsymmetric_ = true;
    } else {
      add_held(block.row, block.held);
    }
    tension_.push_back({block.row, -1.0});
  });
}

void Response::collect_contact(const StepProblem& problem, const ContactBlock& block,
                               std::span<const double> effort) {
  holds_for_all_ = false;
  const int row = block.row;
  const double* force = effort.data() + row;
  if (!(force[0] > 0.0)) return states_.push_back('o');
  add_held(row, 0.0);
  const double across = std::hypot(force[1], force[2]), limit = block.friction * force[0];
  double travel = 0.0;
  if (qp::slides(Eigen::Map<const Vector3>(force), block.friction)) {
    const Eigen::Map<const VectorX> all(effort.data(), static_cast<Eigen::Index>(effort.size()));
    for (int c = 1; c < 3; ++c) {
      travel = std::hypot(travel,
                          problem.delta_free[row + c] + problem.compliance.row(row + c).dot(all));
    }
  }
  if (!(travel > 0.0)) {
    add_held(row + 1, 0.0);
    add_held(row + 2, 0.0);
    return;
  }
  const double e[2] = {limit > 0.0 ? -force[1] / across : 1.0,
                       limit > 0.0 ? -force[2] / across : 0.0};
  effort_terms_.insert(effort_terms_.end(),
                       {{row, block.friction}, {row + 1, e[0]}, {row + 2, e[1]}});
  end_equation(row + 1, 0.0);
  const double turn = limit / travel;
  effort_terms_.insert(effort_terms_.end(), {{row + 1, -e[1]}, {row + 2, e[0]}});
  motion_terms_.insert(motion_terms_.end(), {{row + 1, -turn * e[1]}, {row + 2, turn * e[0]}});
  end_equation(row + 2, 0.0);
  states_.push_back('s');
  unsymmetric_ = true;
  if (limit > 0.0) bends_ = true;
}

void Response::add_held(int row, double motion, double compliance) {
  motion_terms_.push_back({row, 1.0});
  if (compliance != 0.0) effort_terms_.push_back({row, compliance});
  end_equation(row, motion);
  states_.push_back('h');
}

void Response::end_equation(int unknown, double constant) {
  equations_.push_back({unknown, constant, static_cast<int>(effort_terms_.size()),
                        static_cast<int>(motion_terms_.size())});
}

// system_ (unknown efforts over scale_), right_ (1, lambda_c): rows are scaled to a largest entry
// of one, columns by 1/sqrt(W), so that efforts of different units compare.
void Response::form_equations(const StepProblem& problem, std::span<const double> effort) {
  const auto count = static_cast<Eigen::Index>(equations_.size());
  const auto inputs = static_cast<Eigen::Index>(controlled_rows_.size());
  const auto rows = static_cast<std::size_t>(free_.size());
  unknown_of_.assign(rows, -1);
  controlled_of_.assign(rows, -1);
  scale_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int row = equations_[static_cast<std::size_t>(i)].unknown;
    unknown_of_[static_cast<std::size_t>(row)] = static_cast<int>(i);
    const double own = problem.compliance(row, row);
    scale_[i] = own > 0.0 ? 1.0 / std::sqrt(own) : 1.0;
  }
  for (Eigen::Index k = 0; k < inputs; ++k) {
    const int row = controlled_rows_[static_cast<std::size_t>(k)];
    controlled_of_[static_cast<std::size_t>(row)] = static_cast<int>(k);
  }
  system_.setZero(count, count);
  right_.setZero(count, 1 + inputs);
  auto effort_term = effort_terms_.begin();
  auto motion_term = motion_terms_.begin();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Equation& equation = equations_[static_cast<std::size_t>(i)];
    right_(i, 0) = equation.constant;
    for (; effort_term != effort_terms_.begin() + equation.efforts_end; ++effort_term) {
      const auto row = static_cast<std::size_t>(effort_term->row);
      const int unknown = unknown_of_[row], input = controlled_of_[row];
      if (unknown >= 0) system_(i, unknown) += effort_term->factor * scale_[unknown];
      if (input >= 0) right_(i, 1 + input) -= effort_term->factor;
      if (unknown < 0 && input < 0) right_(i, 0) -= effort_term->factor * effort[row];
    }
    for (; motion_term != motion_terms_.begin() + equation.motions_end; ++motion_term) {
      for (Eigen::Index j = 0; j < count; ++j) {
        const int column = equations_[static_cast<std::size_t>(j)].unknown;
        system_(i, j) +=
            motion_term->factor * scale_[j] * problem.compliance(motion_term->row, column);
      }
      right_(i, 0) -= motion_term->factor * free_[motion_term->row];
      for (Eigen::Index k = 0; k < inputs; ++k) {
        right_(i, 1 + k) -= motion_term->factor * compliance_(motion_term->row, k);
      }
    }
    const double largest = system_.row(i).cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) continue;
    system_.row(i) /= largest;
    right_.row(i) /= largest;
  }
}

// Where rows repeat each other, the efforts of least norm are taken.
void Response::solve(const StepProblem& problem, std::span<const double> effort) {
  form_equations(problem, effort);
  const Eigen::Index count = system_.rows(), inputs = right_.cols() - 1;
  factor_.compute(system_);
  if (factor_.is_singular()) {
    solved_ = linalg::pseudo_inverse(system_) * right_;
  } else {
    solved_.resize(count, 1 + inputs);
    factor_.solve_columns(right_, solved_);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto column = problem.compliance.col(equations_[static_cast<std::size_t>(i)].unknown);
    free_ += scale_[i] * solved_(i, 0) * column;
    for (Eigen::Index k = 0; k < inputs; ++k) {
      compliance_.col(k) += scale_[i] * solved_(i, 1 + k) * column;
    }
  }
  clear_rounding(problem);
}

// The motor of a joint at its stop moves nothing, nor does a torque against cables that stick. A
// choice of efforts must see zeros there, or rounding chooses.
void Response::clear_rounding(const StepProblem& problem) {
  scale_ = problem.compliance.diagonal().cwiseAbs().cwiseSqrt();
  for (Eigen::Index k = 0; k < compliance_.cols(); ++k) {
    const double least = kCoupled * scale_[controlled_rows_[static_cast<std::size_t>(k)]];
    for (Eigen::Index row = 0; row < scale_.size(); ++row) {
      double& own = compliance_(row, k);
      if (std::abs(own) <= least * scale_[row]) own = 0.0;
    }
  }
}

}  // namespace sinew::step
