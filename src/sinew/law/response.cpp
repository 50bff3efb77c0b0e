#include "sinew/law/response.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sinew/linalg/dense.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::law {

namespace {

// Friction of a cable is at its limit if it is within this part of the tension.
constexpr double kSlides = 1e-7;
// Number of planes around a cone. They lie outside it by up to 8 %; the law decides where it slips.
constexpr int kPlanes = 8;
// Of the motion that the force causes at a point: less is rounding.
constexpr double kNoSlip = 1e-9;

// Friction chosen among many forces that hold a body may be at its limit without a slip.
bool is_rounding(const StepProblem& problem, const ContactBlock& block, const Vector3& force,
                 const Eigen::Vector2d& slip) {
  const double own = problem.compliance.diagonal().segment<3>(block.row).sum() / 3.0;
  return block.rigid && slip.norm() <= kNoSlip * own * force.norm();
}

}  // namespace

void Response::form(const StepProblem& problem, std::span<const double> effort, bool release) {
  release_ = release;
  keeps_ = false;
  form_pieces(problem, effort);
}

void Response::form_as(const StepProblem& problem, std::span<const double> effort,
                       std::span<const BlockState> states) {
  release_ = false;
  keeps_ = true;
  kept_.assign(states.begin(), states.end());
  form_pieces(problem, effort);
}

void Response::form_pieces(const StepProblem& problem, std::span<const double> effort) {
  decided_ = false;
  states_.swap(states_before_);
  states_.clear();
  controlled_.clear();
  controlled_rows_.clear();
  equations_.clear();
  effort_terms_.clear();
  motion_terms_.clear();
  guards_.clear();
  guard_ends_.clear();
  guard_efforts_.clear();
  guard_motions_.clear();
  holds_for_all_ = true;
  unsymmetric_ = bends_ = false;
  free_ = problem.delta_free;
  effort_.assign(effort.begin(), effort.end());
  collect(problem);
  const auto count = static_cast<Eigen::Index>(controlled_rows_.size());
  compliance_.resize(free_.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    compliance_.col(k) = problem.compliance.col(controlled_rows_[static_cast<std::size_t>(k)]);
  }
  solve(problem);
  form_guards();
}

void Response::collect(const StepProblem& problem) {
  for (std::size_t i = 0; i < problem.actuators.size(); ++i) {
    if (problem.actuators[i].row >= 0) collect_actuator(problem, static_cast<int>(i));
  }
  collect_capstans(problem);
  for (const BilateralBlock& block : problem.bilaterals) {
    if (problem.compliance(block.row, block.row) != 0.0) add_held(block.row, block.motion);
  }
  for (const StiffnessBlock& block : problem.stiffness) {
    if (block.stiffness == 0.0) continue;
    add_held(block.row, problem.delta[block.row], 1.0 / block.stiffness);
  }
  for (const ContactBlock& block : problem.contacts) collect_contact(problem, block);
}

// The state of the next block: the given one, or the one that was read.
BlockState Response::next_state(BlockState read) {
  const BlockState state = keeps_ ? kept_[states_.size()] : read;
  states_.push_back(state);
  return state;
}

double Response::motion_of(const StepProblem& problem, int row) const {
  const Eigen::Map<const VectorX> all(effort_.data(), static_cast<Eigen::Index>(effort_.size()));
  return problem.delta_free[row] + problem.compliance.row(row).dot(all);
}

void Response::collect_actuator(const StepProblem& problem, int index) {
  const ActuatorBlock& block = problem.actuators[static_cast<std::size_t>(index)];
  if (block.owned) {
    controlled_.push_back(index);
    controlled_rows_.push_back(block.row);
    return;
  }
  double& effort = effort_[static_cast<std::size_t>(block.row)];
  const BlockState state = next_state(actuator_state(problem, block));
  guard_actuator(problem, block, state);
  switch (state) {
    using enum BlockState;
    case curve: {
      // The tangent at the motion due to the efforts.
      const double motion = motion_of(problem, block.row);
      const auto at = block.drive->respond(block.drive_step, motion);
      const double compliance = -1.0 / at.slope;
      return add_held(block.row, motion + compliance * at.effort, compliance);
    }
    case holds:
      return add_held(block.row, block.value);
    case at_stop_max:
      return add_held(block.row, block.motion_max);
    case at_stop_min:
      return add_held(block.row, block.motion_min);
    case commanded:
      effort = block.value;
      break;
    case at_min:
      effort = block.effort_min;
      break;
    case at_max:
      effort = block.effort_max;
      break;
    case released: {
      const double least = block.kind == CommandKind::motion ? 0.0 : block.value;
      effort = std::clamp(least, block.effort_min, block.effort_max);
      break;
    }
    default:
      break;
  }
  if (effort != 0.0) free_ += effort * problem.compliance.col(block.row);
}

// Reads the state of an actuator from its effort.
BlockState Response::actuator_state(const StepProblem& problem, const ActuatorBlock& block) {
  using enum BlockState;
  const double effort = effort_[static_cast<std::size_t>(block.row)];
  if (problem.compliance(block.row, block.row) == 0.0) return given;
  if (block.drive != nullptr) {
    holds_for_all_ = false;
    const auto at = block.drive->respond(block.drive_step, motion_of(problem, block.row));
    if (!(at.slope < 0.0)) return given;
    bends_ = true;
    return curve;
  }
  const bool motion = block.kind == CommandKind::motion;
  if (!motion && std::isinf(block.motion_min) && std::isinf(block.motion_max)) return given;
  holds_for_all_ = false;
  if (!motion && effort == block.value) return commanded;
  if (effort <= block.effort_min) return at_min;
  if (effort >= block.effort_max) return at_max;
  if (decides(problem, block.row)) {
    decided_ = true;
    if (release_) return released;
  }
  if (motion) return holds;
  return effort < block.value ? at_stop_max : at_stop_min;
}

void Response::guard_actuator(const StepProblem& problem, const ActuatorBlock& block,
                              BlockState state) {
  using enum BlockState;
  const int row = block.row;
  const bool motion = block.kind == CommandKind::motion;
  switch (state) {
    case commanded:
      guard_motion(problem, row, -1.0, block.motion_max, at_stop_max);
      return guard_motion(problem, row, 1.0, block.motion_min, at_stop_min);
    case at_stop_max:
      guard_effort(problem, row, -1.0, block.value, commanded);
      return guard_effort(problem, row, 1.0, block.effort_min, at_min);
    case at_stop_min:
      guard_effort(problem, row, 1.0, block.value, commanded);
      return guard_effort(problem, row, -1.0, block.effort_max, at_max);
    case at_min:
      return guard_motion(problem, row, 1.0, motion ? block.value : block.motion_max,
                          motion ? holds : at_stop_max);
    case at_max:
      return guard_motion(problem, row, -1.0, motion ? block.value : block.motion_min,
                          motion ? holds : at_stop_min);
    case holds:
      guard_effort(problem, row, 1.0, block.effort_min, at_min);
      return guard_effort(problem, row, -1.0, block.effort_max, at_max);
    default:
      return;
  }
}

// Whether the motion of a row is determined by a controlled one: |W_ij|^2 = W_ii W_jj.
bool Response::decides(const StepProblem& problem, int row) {
  const double own = problem.compliance(row, row);
  return std::ranges::any_of(problem.actuators, [&](const ActuatorBlock& block) {
    if (!block.owned || block.row < 0) return false;
    const double both = problem.compliance(row, block.row);
    return both * both >= (1.0 - kCoupled) * own * problem.compliance(block.row, block.row) &&
           both != 0.0;
  });
}

void Response::collect_capstans(const StepProblem& problem) {
  using enum BlockState;
  for_each_guide(problem, effort_, [&](const CapstanBlock& block, const GuideTension& tension) {
    // Tension before the guide: the cable's effort minus the losses so far.
    if (tension.first) {
      tension_.assign(1, {problem.actuators[static_cast<std::size_t>(block.cable)].row, 1.0});
    }
    holds_for_all_ = false;
    const double lost = effort_[static_cast<std::size_t>(block.row)];
    const double blur = kSlides * tension.largest();
    const BlockState state = next_state(lost >= tension.upper(block) - blur   ? slides_high
                                        : lost <= tension.lower(block) + blur ? slides_low
                                                                              : holds);
    if (state == holds) {
      // -grip behind <= lost <= grip before, behind = before - lost.
      const double scale = std::sqrt(problem.compliance(block.row, block.row));
      const auto add = [&](double own, double before, BlockState beyond) {
        guard_efforts_.push_back({block.row, scale * own});
        for (const Term& term : tension_) {
          guard_efforts_.push_back({term.row, scale * before * term.factor});
        }
        end_guard(beyond, 0.0);
      };
      add(-1.0, block.grip, slides_high);
      add(1.0 - block.grip, block.grip, slides_low);
      add_held(block.row, block.held);
    } else {
      const bool high = state == slides_high;
      guard_motion(problem, block.row, high ? -1.0 : 1.0, block.held, holds);
      // lost = grip tension, or -grip behind = -grip/(1 - grip) tension.
      const double factor = high ? block.grip : -block.grip / (1.0 - block.grip);
      for (const Term& term : tension_) {
        effort_terms_.push_back({term.row, -factor * term.factor});
      }
      effort_terms_.push_back({block.row, 1.0});
      end_equation(block.row, 0.0);
      unsymmetric_ = true;
    }
    tension_.push_back({block.row, -1.0});
  });
}

// With e the direction of its slip, s = |u_t| and mu its coefficient, a slipping point obeys
//   mu r_n + e.r_t = 0,   s (r_t across e) + mu r_n (u_t across e) = 0.
// The second equation turns friction with the slip.
void Response::collect_contact(const StepProblem& problem, const ContactBlock& block) {
  using enum BlockState;
  holds_for_all_ = false;
  const int row = block.row;
  const Vector3 force = Vector3::Map(effort_.data() + row);
  const double limit = block.friction * std::max(force[0], 0.0);
  BlockState read = open;
  Eigen::Vector2d slip = Eigen::Vector2d::Zero();
  const bool may_slip = keeps_ || (force[0] > 0.0 && qp::slides(force, block.friction));
  if (may_slip) slip = {motion_of(problem, row + 1), motion_of(problem, row + 2)};
  if (is_rounding(problem, block, force, slip)) slip.setZero();
  if (force[0] > 0.0) {
    const bool slipping = block.friction == 0.0 || (may_slip && slip.squaredNorm() > 0.0);
    read = slipping ? slips : sticks;
  }
  const BlockState state = next_state(read);
  const double across = force.tail<2>().norm(), travel = slip.norm();
  Eigen::Vector2d along(1.0, 0.0);
  if (limit > 0.0 && across > 0.0) {
    along = -force.tail<2>() / across;
  } else if (block.friction > 0.0 && travel > 0.0) {
    along = slip / travel;
  }
  guard_contact(problem, block, state, along);
  if (state == open) return;
  add_held(row, 0.0);
  if (state == sticks) {
    add_held(row + 1, 0.0);
    return add_held(row + 2, 0.0);
  }
  effort_terms_.insert(effort_terms_.end(),
                       {{row, block.friction}, {row + 1, along[0]}, {row + 2, along[1]}});
  end_equation(row + 1, 0.0);
  const bool turns = limit > 0.0;
  if (travel > 0.0 || !turns) {
    effort_terms_.insert(effort_terms_.end(), {{row + 1, -along[1]}, {row + 2, along[0]}});
  }
  const double turn = !turns ? 0.0 : travel > 0.0 ? limit / travel : 1.0;
  if (turns) {
    motion_terms_.insert(motion_terms_.end(),
                         {{row + 1, -turn * along[1]}, {row + 2, turn * along[0]}});
  }
  end_equation(row + 2, 0.0);
  unsymmetric_ = true;
  if (turns) bends_ = true;
}

// Planes around the cone keep a sticking point in it. One of them touches the cone nearest to the
// force.
void Response::guard_contact(const StepProblem& problem, const ContactBlock& block,
                             BlockState state, const Eigen::Vector2d& along) {
  using enum BlockState;
  const int row = block.row;
  const BlockState pressed = block.friction > 0.0 ? sticks : slips;
  if (state == open) return guard_motion(problem, row, 1.0, 0.0, pressed);
  const double scale = std::sqrt(problem.compliance(row, row));
  if (state == slips) {
    guard_effort(problem, row, 1.0, 0.0, open);
    if (!(block.friction > 0.0)) return;
    for (int c = 0; c < 2; ++c) guard_motions_.push_back({row + 1 + c, along[c] / scale});
    return end_guard(sticks, 0.0);
  }
  for (int k = 0; k < kPlanes; ++k) {
    const Eigen::Rotation2Dd turn(2.0 * M_PI * k / kPlanes);
    const Eigen::Vector2d out = turn * Eigen::Vector2d(-along);
    guard_efforts_.push_back({row, scale * block.friction});
    for (int c = 0; c < 2; ++c) guard_efforts_.push_back({row + 1 + c, -scale * out[c]});
    const bool loaded = effort_[static_cast<std::size_t>(row)] > 0.0;
    end_guard(loaded ? slips : open, 0.0);
  }
}

// Guard on the motion of a block's row: sense (delta - limit) >= 0.
void Response::guard_motion(const StepProblem& problem, int row, double sense, double limit,
                            BlockState beyond) {
  const double own = problem.compliance(row, row);
  if (std::isinf(limit) || !(own > 0.0)) return;
  const double factor = sense / std::sqrt(own);
  guard_motions_.push_back({row, factor});
  end_guard(beyond, -factor * limit);
}

// Guard on the effort of a block's row: sense (lambda - limit) >= 0.
void Response::guard_effort(const StepProblem& problem, int row, double sense, double limit,
                            BlockState beyond) {
  const double own = problem.compliance(row, row);
  if (std::isinf(limit) || !(own > 0.0)) return;
  const double factor = sense * std::sqrt(own);
  guard_efforts_.push_back({row, factor});
  end_guard(beyond, -factor * limit);
}

void Response::end_guard(BlockState beyond, double constant) {
  guards_.push_back({static_cast<int>(states_.size()) - 1, beyond, constant});
  guard_ends_.push_back(
      {static_cast<int>(guard_efforts_.size()), static_cast<int>(guard_motions_.size())});
}

// Expresses the guards in the controlled efforts.
void Response::form_guards() {
  const std::size_t count = controlled_rows_.size();
  slopes_.assign(guards_.size() * count, 0.0);
  auto effort_term = guard_efforts_.begin();
  auto motion_term = guard_motions_.begin();
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    Guard& guard = guards_[g];
    Eigen::Map<VectorX> slope(slopes_.data() + g * count, static_cast<Eigen::Index>(count));
    for (; effort_term != guard_efforts_.begin() + guard_ends_[g].efforts; ++effort_term) {
      const auto row = static_cast<std::size_t>(effort_term->row);
      const int unknown = unknown_of_[row], input = controlled_of_[row];
      if (unknown >= 0) {
        const double factor = effort_term->factor * scale_[unknown];
        guard.offset += factor * solved_(unknown, 0);
        slope += factor * solved_.row(unknown).tail(static_cast<Eigen::Index>(count)).transpose();
      } else if (input >= 0) {
        slope[input] += effort_term->factor;
      } else {
        guard.offset += effort_term->factor * effort_[row];
      }
    }
    for (; motion_term != guard_motions_.begin() + guard_ends_[g].motions; ++motion_term) {
      guard.offset += motion_term->factor * free_[motion_term->row];
      slope += motion_term->factor * compliance_.row(motion_term->row).transpose();
    }
  }
}

void Response::tighten(std::span<const double> own, double slack) {
  const Eigen::Map<const VectorX> given(own.data(), std::ssize(own));
  for (std::size_t g = 0; g < guards_.size(); ++g) {
    guards_[g].tight = guards_[g].offset + guard_slope(g).dot(given) <= slack;
  }
}

void Response::add_effort(int row, double factor, double& offset,
                          Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> slope) const {
  const auto at = static_cast<std::size_t>(row);
  if (!follows(row)) {
    offset += factor * effort_[at];
    return;
  }
  const int unknown = unknown_of_[at];
  const double unit = factor * scale_[unknown];
  offset += unit * solved_(unknown, 0);
  slope += unit * solved_.row(unknown).tail(slope.size());
}

void Response::add_held(int row, double motion, double compliance) {
  motion_terms_.push_back({row, 1.0});
  if (compliance != 0.0) effort_terms_.push_back({row, compliance});
  end_equation(row, motion);
}

void Response::end_equation(int unknown, double constant) {
  equations_.push_back({unknown, constant, static_cast<int>(effort_terms_.size()),
                        static_cast<int>(motion_terms_.size())});
}

// system_ (unknown efforts over scale_) = right_ (1, lambda_c). Rows are scaled to a largest entry
// of one, columns by 1/sqrt(W), so that efforts of different units compare.
void Response::form_equations(const StepProblem& problem) {
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
      if (unknown < 0 && input < 0) right_(i, 0) -= effort_term->factor * effort_[row];
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

// Newtons per effort, as DirectSolver chooses efforts: those of held rows follow from the others.
void Response::weigh_efforts(const StepProblem& problem) {
  weight_.setZero(free_.size());
  for (const ActuatorBlock& block : problem.actuators) {
    if (block.row < 0 || block.owned || block.drive != nullptr || block.holds_motion()) continue;
    weight_[block.row] = 1.0 / block.motion_scale;
  }
  for (const CapstanBlock& block : problem.capstans) weight_[block.row] = 1.0;
  for (const ContactBlock& block : problem.contacts) {
    weight_.segment<3>(block.row).setConstant(1.0);
  }
}

// With N the null space of the system, s = s_0 + N t solves it for all t. The t of least norm of
// the weighted efforts is taken, and among those, as the efforts of held rows, the least s.
void Response::solve_redundant(const StepProblem& problem) {
  solved_ = linalg::pseudo_inverse(system_) * right_;
  const linalg::Svd svd = linalg::svd(system_, linalg::SingularVectors::full_v);
  const Eigen::Index count = system_.cols();
  Eigen::Index rank = 0;
  while (rank < count && svd.values[rank] > kCoupled * svd.values[0]) ++rank;
  if (rank == count) return;
  weigh_efforts(problem);
  MatrixX null_space = svd.v.rightCols(count - rank), weighted = null_space, efforts = solved_;
  for (Eigen::Index i = 0; i < count; ++i) {
    const int row = equations_[static_cast<std::size_t>(i)].unknown;
    weighted.row(i) *= scale_[i] * weight_[row];
    efforts.row(i) *= scale_[i] * weight_[row];
  }
  if (!(weighted.cwiseAbs().maxCoeff() > 0.0)) return;
  solved_ -= null_space * (linalg::pseudo_inverse(weighted) * efforts);
}

// For redundant rows, takes the efforts of least norm.
void Response::solve(const StepProblem& problem) {
  form_equations(problem);
  if (equations_.empty()) return;
  const Eigen::Index count = system_.rows(), inputs = right_.cols() - 1;
  factor_.compute(system_);
  if (factor_.is_singular()) {
    solve_redundant(problem);
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

// Sets entries at rounding level to zero. The motor of a joint at its stop moves nothing, nor does
// a torque against sticking cables; a choice of efforts must see zeros there, or rounding would
// choose.
void Response::clear_rounding(const StepProblem& problem) {
  row_scale_ = problem.compliance.diagonal().cwiseAbs().cwiseSqrt();
  for (Eigen::Index k = 0; k < compliance_.cols(); ++k) {
    const double least = kCoupled * row_scale_[controlled_rows_[static_cast<std::size_t>(k)]];
    for (Eigen::Index row = 0; row < row_scale_.size(); ++row) {
      double& own = compliance_(row, k);
      if (std::abs(own) <= least * row_scale_[row]) own = 0.0;
    }
  }
}

}  // namespace sinew::law
