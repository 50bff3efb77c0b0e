/// @file
/// How a robot answers to the efforts of a controller while everything else on it obeys its own
/// law.
#pragma once

#include <span>
#include <vector>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::step {

/// What a block does, and with it the equation that its effort obeys.
enum class BlockState : char {
  given,        ///< an effort that nothing changes
  commanded,    ///< the commanded effort, the motion within its limits
  at_min,       ///< the least effort
  at_max,       ///< the largest one
  holds,        ///< a commanded motion, or that of a cable which sticks at a guide
  at_stop_min,  ///< a commanded effort that the least motion holds
  at_stop_max,  ///< one that the largest motion holds
  released,     ///< what held a controlled actuator's motion, and lets go of it
  curve,        ///< on a drive's curve
  slides_low,   ///< a cable at a guide, the effort at its lower limit
  slides_high,  ///< and at its upper one
  open,         ///< a contact without a force
  sticks,
  slips,
};

/// Where a block leaves its state: slack = offset + slope . lambda_c >= 0 as long as it has it, and
/// beyond that it is in another one.
struct Guard {
  int block = -1;  ///< position in Response::states()
  BlockState beyond = BlockState::given;
  double offset = 0.0;  ///< sqrt(N m): motions over sqrt(W_ii), efforts times that
  bool tight = false;   ///< see Response::tighten()
};

/// delta = free + compliance lambda_c over the efforts lambda_c that a controller chooses, as long
/// as every other block keeps the state that it has: a held row stays held, a slack cable slack, a
/// drive on the tangent of its curve; of contacts the open ones stay open, sticking ones stick, and
/// sliding ones slide in the same direction; cables keep sticking or sliding at their guides. The
/// efforts s of these rows obey linear equations
///   delta_s = m               where a motion is held: held rows, sticking points, every normal,
///   delta_s + c lambda_s = m  on a drive's curve, and of a block of stiffness,
///   lambda_s = sum k lambda   where friction is at its limit,
/// which with delta = delta_free + W lambda give them as an affine function of lambda_c. Sliding
/// makes that unsymmetric: `compliance` of the controlled rows is then no stiffness's inverse.
class Response {
 public:
  /// @param problem of the step. @param effort (rows,) N: efforts and with them the states of all
  /// blocks, see DirectSolver. @param release lets go of actuators that hold the very motion of a
  /// controlled one, as if that had taken their place: see decides().
  void form(const StepProblem& problem, std::span<const double> effort, bool release = false);
  /// The same with states that are given, from `effort` on, which is on the border of them.
  /// @param problem,effort as above. @param states (blocks,) of all that have one.
  void form_as(const StepProblem& problem, std::span<const double> effort,
               std::span<const BlockState> states);

  /// Positions in problem.actuators of the controlled ones, ascending.
  const std::vector<int>& controlled() const { return controlled_; }
  const MatrixX& compliance() const { return compliance_; }  ///< (rows, controlled) m/N
  const VectorX& free() const { return free_; }              ///< (rows,) m
  /// Whether it holds for all efforts: nothing else on the robot answers to them.
  bool holds_for_all() const { return holds_for_all_; }
  /// Whether it is a tangent alone: a drive's curve, or the direction in which a point slides,
  /// bends away from it.
  bool bends() const { return bends_; }
  /// Whether an actuator holds the very motion of a controlled one (a commanded cable on the same
  /// line, the stop of a motor's joint), whose effort then moves nothing.
  bool has_decided() const { return decided_; }
  /// Whether there are other efforts that follow.
  bool has_unknowns() const { return !equations_.empty(); }
  /// Whether the controlled rows' part of `compliance` may be unsymmetric.
  bool is_unsymmetric() const { return unsymmetric_; }
  /// Whether the last two calls of form() found the same states of all blocks.
  bool same_states() const { return states_ == states_before_; }
  /// Of all blocks that have one: actuators that are not controlled, capstans, contacts.
  std::span<const BlockState> states() const { return states_; }
  /// Whether the effort of a row follows those of the controlled ones. @param row of the problem.
  bool follows(int row) const {
    return !unknown_of_.empty() && unknown_of_[static_cast<std::size_t>(row)] >= 0;
  }
  /// Adds a multiple of a row's effort, which is offset + slope . lambda_c.
  /// @param row of the problem. @param factor of the effort. @param offset N. @param slope
  /// (controlled,) 1.
  void add_effort(int row, double factor, double& offset,
                  Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> slope) const;
  /// Where blocks leave their states.
  std::span<const Guard> guards() const { return guards_; }
  /// Marks the guards that are reached. @param own (controlled,) N. @param slack sqrt(N m), less of
  /// it is none.
  void tighten(std::span<const double> own, double slack);
  /// (controlled,) sqrt(N m)/N: how the slack of a guard follows the controlled efforts.
  Eigen::Map<const VectorX> guard_slope(std::size_t guard) const {
    const auto count = static_cast<std::size_t>(controlled_.size());
    return {slopes_.data() + guard * count, static_cast<Eigen::Index>(count)};
  }

  /// Of what two rows' own compliances allow: where others are held, less is rounding.
  static constexpr double kCoupled = 1e-10;

 private:
  struct Term {
    int row = -1;
    double factor = 0.0;
  };
  // sum of factor lambda_row over the effort terms, and of factor delta_row over the motion terms,
  // = constant; one for each unknown effort.
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
  linalg::LuFactor factor_;
};

}  // namespace sinew::step
