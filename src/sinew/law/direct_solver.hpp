/// @file
/// Direct simulation: efforts of a step in which every block obeys its law.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sinew/law/contact_problem.hpp"
#include "sinew/law/followers.hpp"
#include "sinew/law/law_status.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/force_choice.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::law {

/// Solves all blocks of a StepProblem together, starting from the last efforts, by three nested
/// iterations. Each runs only if a block requires it:
///
/// 1. Capstans. For given limits of friction, a capstan is a box that the solver below treats
///    exactly, stick and slip (Tresca friction). The limits then follow the resulting tensions
///    until they converge (the fixed point of Necas, Jarusek & Haslinger 1980). For a cable of held
///    length the iteration contracts by about A/(2 pi), A = mu times its wrap; for a cable under a
///    given tension it ends after as many rounds as points.
/// 2. Drives. Curves are linearised and eliminated together with the held rows (Followers), and
///    linearised again at the result: Newton's method on decreasing curves.
/// 3. Boxes and cones in the remaining W. Boxes alone are a quadratic program,
///      min 1/2 lambda^T W lambda + (delta_free - p)^T lambda,  lower <= lambda <= upper,
///    where W, semidefinite for redundant cables, is made definite by 1e-12 of its diagonal. With
///    contacts it is a cone complementarity problem (qp::ConeSolver). A commanded effort with
///    limits of its motion is one of two boxes, at or below the command and at or above it;
///    branches are switched until the motions agree.
///
/// Owned actuators keep their efforts. A row that moves nothing gets the least effort, or, if
/// another motion than its present one is commanded, the effort at its limit. Blocks of stiffness
/// are followers.
class DirectSolver {
 public:
  explicit DirectSolver(const qp::ConeSettings& settings = {});

  /// Called before each step. Discards all warm starts of the last step, so that a step is
  /// determined by state and inputs alone.
  void begin_step();
  /// Solves a step. @param problem of the step.
  /// @param effort (rows,) N: initial guess; on return the solution. Rows without a block keep
  ///   theirs.
  LawStatus solve(const StepProblem& problem, std::span<double> effort);
  /// The contact problem of the last solve(). Its drives are linearised at the solution.
  ContactProblem contact_problem() const;
  /// The actuator of the last problem whose commanded motion differs from its motion, although its
  /// effort cannot change the motion and no limit allows the difference; -1: none.
  int unreachable() const { return unreachable_; }
  /// Result of the cone solver for the last problem with contacts.
  const qp::ConeResult& contact_result() const { return cone_solver_.result(); }

 private:
  struct Box {
    int row;
    int actuator;  // -1: a capstan
    double lower, upper, motion;
    // For a commanded effort: the motion may not exceed `motion` upwards (1: the command is
    // `upper`) or downwards (-1: it is `lower`).
    int stop = 0;
    double rounding = 0.0;  // m/N, rounding of the compliance that held rows leave
    bool decided = false;   // held rows decide its motion, see settle_decided()
    bool waits = false;     // its effort is the command, since its stop is not reached

    bool is_given() const { return lower == upper || waits; }
  };
  enum class Branch : char { pull, hold };  // an effort at or below its command, or at or above it

  void sort(const StepProblem& problem, std::span<double> effort);
  void sort_actuator(const StepProblem& problem, int index, std::span<double> effort);
  Box box_of(const ActuatorBlock& block, int index) const;
  static double idle_effort(const Box& box, double gap);
  static bool braces_hold(const StepProblem& problem, std::span<const double> effort);
  LawStatus solve_with_friction(const StepProblem& problem, std::span<double> effort);
  bool follow_tensions(const StepProblem& problem, std::span<const double> effort, double share);
  LawStatus solve_with_drives(const StepProblem& problem, std::span<double> effort);
  void unite_twins(const StepProblem& problem, Eigen::Map<MatrixX> compliance,
                   Eigen::Map<MatrixX> motion);
  void settle_decided(const StepProblem& problem, Eigen::Map<MatrixX> compliance,
                      Eigen::Map<MatrixX> motion);
  LawStatus solve_blocks(const StepProblem& problem);
  LawStatus solve_boxes(const Eigen::Map<const MatrixX>& compliance);
  LawStatus solve_program(const Eigen::Map<const MatrixX>& compliance);
  void solve_rounded_program();
  LawStatus solve_cones(const Eigen::Map<const MatrixX>& compliance);
  LawStatus solve_cones(const qp::ConeProblem& problem);
  void lessen_boxes(const Eigen::Map<const MatrixX>& compliance);
  void list_boxes();
  void list_scales(const StepProblem& problem);
  bool switch_branches(const StepProblem& problem, const Eigen::Map<const MatrixX>& compliance);

  Followers followers_;
  std::vector<Box> boxes_;                     // of actuators, then of capstans
  std::size_t first_capstan_ = 0;              // index in boxes_
  std::vector<qp::ConeBlock> cones_;           // rows among the unknowns
  std::vector<int> unknown_;                   // rows of boxes, then of cones
  std::vector<Branch> branch_;                 // (actuators,)
  int unreachable_ = -1;                       // see unreachable()
  VectorX free_;                               // (rows,) delta for zero unknowns and followers
  linalg::ScratchMatrix compliance_;           // (unknowns, unknowns)
  linalg::ScratchMatrix motion_;               // (unknowns, 1)
  linalg::AlignedNumbers x_;                   // (unknowns,)
  std::vector<std::array<double, 2>> limits_;  // (capstans,) N, limits by the tensions

  qp::QuadraticProgram program_;
  qp::QpSolver qp_solver_;
  VectorX scale_;  // (boxes,)
  std::vector<qp::BoxBlock> cone_boxes_;
  qp::ConeSolver cone_solver_;
  qp::ForceChoice choice_;
  qp::ForceScales scales_;
  std::vector<double> unit_, alone_;  // (unknowns,) see qp::ForceScales
  std::vector<char> rigid_;           // (cones,)
};

}  // namespace sinew::law
