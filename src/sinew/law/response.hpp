/// @file
/// Response of a robot to the efforts of a controller while everything else on it obeys its own
/// law.
#pragma once

#include <span>
#include <vector>

#include "sinew/law/step_problem.hpp"
#include "sinew/linalg/dense_factor.hpp"

namespace sinew::law {

/// The state of a block, which determines the equation of its effort.
enum class BlockState : char {
  given,        ///< a fixed effort
  commanded,    ///< the commanded effort, with the motion within its limits
  at_min,       ///< the smallest effort
  at_max,       ///< the largest effort
  holds,        ///< a commanded motion is held, or a cable sticks at a guide
  at_stop_min,  ///< a commanded effort whose motion is at its lower limit
  at_stop_max,  ///< a commanded effort whose motion is at its upper limit
  released,     ///< held the motion of a controlled actuator, and releases it
  curve,        ///< on a drive's curve
  slides_low,   ///< a cable slides at a guide, with the effort at its lower limit
  slides_high,  ///< the same, with the effort at its upper limit
  open,         ///< a contact without a force
  sticks,
  slips,
};

/// The border of a block's state: slack = offset + slope . lambda_c is >= 0 within the state;
/// beyond it the block is in another state.
struct Guard {
  int block = -1;  ///< index in Response::states()
  BlockState beyond = BlockState::given;
  double offset = 0.0;  ///< sqrt(N m): motions are divided by sqrt(W_ii), efforts multiplied by it
  bool tight = false;   ///< see Response::tighten()
};

/// Affine response delta = free + compliance lambda_c to the efforts lambda_c that a controller
/// chooses. Every other block keeps its state: a held row stays held, a slack cable slack, a drive
/// on the tangent of its curve; open contacts stay open, sticking ones stick, and sliding ones
/// slide in the same direction; cables keep sticking or sliding at their guides. The efforts s of
/// these rows obey linear equations
///   delta_s = m               if a motion is held: held rows, sticking points, every normal,
///   delta_s + c lambda_s = m  on a drive's curve, and for a block of stiffness,
///   lambda_s = sum k lambda   if friction is at its limit.
/// With delta = delta_free + W lambda these give the efforts as an affine function of lambda_c.
/// Sliding makes the function unsymmetric: `compliance` of the controlled rows is then not the
/// inverse of a stiffness.
class Response {
 public:
  /// Forms the response. @param problem of the step.
  /// @param effort (rows,) N, which determine the states of all blocks, see DirectSolver.
  /// @param release releases actuators that hold the motion of a controlled one, as if the
  ///   controlled one had taken over their load: see decides().
  void form(const StepProblem& problem, std::span<const double> effort, bool release = false);
  /// The same with given states. `effort` must lie on the border of these states.
  /// @param problem,effort as above. @param states (blocks,) of all blocks that have one.
  void form_as(const StepProblem& problem, std::span<const double> effort,
               std::span<const BlockState> states);

  /// Indices of the controlled actuators in problem.actuators, ascending.
  const std::vector<int>& controlled() const { return controlled_; }
  const MatrixX& compliance() const { return compliance_; }  ///< (rows, controlled) m/N
  const VectorX& free() const { return free_; }              ///< (rows,) m
  /// Whether the response holds for all efforts, since nothing else on the robot responds to them.
  bool holds_for_all() const { return holds_for_all_; }
  /// Whether the response is only a tangent: the curve of a drive, or the direction in which a
  /// point slides, changes with the efforts.
  bool bends() const { return bends_; }
  /// Whether an actuator holds the motion of a controlled one (a commanded cable on the same line,
  /// the stop of a motor's joint), whose effort then moves nothing.
  bool has_decided() const { return decided_; }
  /// Whether other efforts follow from those of the controlled actuators.
  bool has_unknowns() const { return !equations_.empty(); }
  /// Whether the controlled rows' part of `compliance` may be unsymmetric.
  bool is_unsymmetric() const { return unsymmetric_; }
  /// Whether the last two calls of form() found the same states of all blocks.
  bool same_states() const { return states_ == states_before_; }
  /// States of all blocks that have one: actuators that are not controlled, capstans, contacts.
  std::span<const BlockState> states() const { return states_; }
  /// Whether the effort of a row follows from those of the controlled actuators.
  /// @param row of the problem.
  bool follows(int row) const {
    return !unknown_of_.empty() && unknown_of_[static_cast<std::size_t>(row)] >= 0;
  }
  /// Adds a multiple of a row's effort, which is offset + slope . lambda_c.
  /// @param row of the problem. @param factor of the effort. @param offset N. @param slope
  /// (controlled,) 1.
  void add_effort(int row, double factor, double& offset,
                  Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> slope) const;
  /// The borders of the present states.
  std::span<const Guard> guards() const { return guards_; }
  /// Marks the guards that are reached. @param own (controlled,) N.
  /// @param slack sqrt(N m), at or below which a guard is tight.
  void tighten(std::span<const double> own, double slack);
  /// Derivative of a guard's slack with respect to the controlled efforts, (controlled,) sqrt(N
  /// m)/N.
  Eigen::Map<const VectorX> guard_slope(std::size_t guard) const {
    const auto count = static_cast<std::size_t>(controlled_.size());
    return {slopes_.data() + guard * count, static_cast<Eigen::Index>(count)};
  }

  /// Relative to what the compliances of two rows allow: below this, a coupling is rounding if
  /// other rows are held.
  static constexpr double kCoupled = 1e-10;

 private:
  struct Term {
    int row = -1;
    double factor = 0.0;
  };
  // Sum of factor lambda_row over the effort terms plus factor delta_row over the motion
  // terms = constant; one equation per unknown effort.
  struct Equation {
    int unknown = -1;  // row
    double constant = 0.0;
    int efforts_end = 0, motions_end = 0;  // in the lists of terms
  };

  void form_pieces(const StepProblem& problem, std::span<const double> effort);
  void collect(const StepProblem& problem);
  void collect_actuator(const StepProblem& problem, int index);
  BlockState actuator_state(const StepProblem& problem, const ActuatorBlock& block);
  void guard_actuator(const StepProblem& problem, const ActuatorBlock& block, BlockState state);
  void collect_capstans(const StepProblem& problem);
  void collect_contact(const StepProblem& problem, const ContactBlock& block);
  void guard_contact(const StepProblem& problem, const ContactBlock& block, BlockState state,
                     const Eigen::Vector2d& along);
  BlockState next_state(BlockState read);
  double motion_of(const StepProblem& problem, int row) const;
  static bool decides(const StepProblem& problem, int row);
  void add_held(int row, double motion, double compliance = 0.0);
  void end_equation(int unknown, double constant);
  void guard_motion(const StepProblem& problem, int row, double sense, double limit,
                    BlockState beyond);
  void guard_effort(const StepProblem& problem, int row, double sense, double limit,
                    BlockState beyond);
  void end_guard(BlockState beyond, double constant);
  void form_guards();
  void form_equations(const StepProblem& problem);
  void solve(const StepProblem& problem);
  void solve_redundant(const StepProblem& problem);
  void weigh_efforts(const StepProblem& problem);
  void clear_rounding(const StepProblem& problem);

  std::vector<int> controlled_;
  std::vector<int> controlled_rows_;
  std::vector<Equation> equations_;
  std::vector<Term> effort_terms_, motion_terms_, tension_;
  std::vector<BlockState> states_, states_before_;
  std::vector<BlockState> kept_;  // given ones, of form_as()
  bool keeps_ = false;
  std::vector<double> effort_;  // (rows,) N: where it is formed
  struct GuardEnd {
    int efforts = 0, motions = 0;
  };
  std::vector<Guard> guards_;
  std::vector<GuardEnd> guard_ends_;
  std::vector<Term> guard_efforts_, guard_motions_;
  std::vector<double> slopes_;                   // (guards, controlled) row by row
  std::vector<int> unknown_of_, controlled_of_;  // (rows,) position or -1
  bool holds_for_all_ = true, unsymmetric_ = false, bends_ = false;
  bool release_ = false, decided_ = false;
  MatrixX compliance_, system_, right_, solved_;
  VectorX free_, scale_, row_scale_;
  VectorX weight_;  // (rows,) newtons per effort in the norm of redundant ones; 0: held rows
  linalg::LuFactor factor_;
};

}  // namespace sinew::law
