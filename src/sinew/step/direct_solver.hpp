/// @file
/// Efforts of a step in which every block obeys its law: direct simulation.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/quadratic_program.hpp"
#include "sinew/step/contact_problem.hpp"
#include "sinew/step/followers.hpp"
#include "sinew/step/law_status.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::step {

/// Solves all blocks of a StepProblem together, from the last efforts, by three nested iterations
/// of which each runs only where a block asks for it:
///
/// 1. Capstans. With the limits of friction given, a capstan is a box that the solver below treats
///    exactly, stick and slip (Tresca's friction); the limits then follow the tensions that came
///    out, until they stay (the fixed point of Necas, Jarusek & Haslinger 1980). For a cable whose
///    length is held the iteration contracts about as A/(2 pi), A = mu times its wrap; one under a
///    given tension ends after as many rounds as points.
/// 2. Drives. Curves are linearised and taken out of the problem together with the rows that are
///    held (Followers), and linearised anew where they came out: Newton's method on falling curves.
/// 3. Boxes and cones in what is left of W. Boxes alone are a quadratic program,
///      min 1/2 lambda^T W lambda + (delta_free - p)^T lambda,  lower <= lambda <= upper,
///    whose semidefinite W of redundant cables is made definite by 1e-12 of its diagonal; with
///    contacts it is a cone complementarity problem (qp::ConeSolver). A commanded effort between
///    limits of its motion is one of two boxes, at or below the command and above it; branches are
///    switched until the motions agree.
///
/// Owned actuators keep the efforts that they have. What moves nothing gets the least effort, or,
/// where its motion is asked to be another, the effort at its limit.
/// Blocks of stiffness are followers.
class DirectSolver {
 public:
  explicit DirectSolver(const qp::ConeSettings& settings = {});

  /// Called before each step: what helped to solve the last one is forgotten, so that a step
  /// follows from state and inputs alone.
  void begin_step();
  /// @param problem of the step. @param effort (rows,) N: where to start from, on return the
  /// solution. Rows without a block keep theirs.
  LawStatus solve(const StepProblem& problem, std::span<double> effort);
  /// The contacts of the last problem. Drives that it has are linearised where they came out.
  ContactProblem contact_problem() const;
  /// The actuator of the last problem that is asked for another motion than it has, which no effort
  /// of its own changes and no limit ends; -1: none.
  int unreachable() const { return unreachable_; }
  /// Of the last problem with contacts.
  const qp::ConeResult& contact_result() const { return cone_solver_.result(); }

 private:
  struct Box {
    int row;
    int actuator;  // -1: a capstan
    double lower, upper, motion;
    // Of a commanded effort: the motion may not go beyond `motion` upwards (1: the command is
    // `upper`) or downwards (-1: it is `lower`).
    int stop = 0;
    double rounding = 0.0;  // m/N, of what held rows leave of its compliance
    bool decided = false;   // by what is held, see settle_decided()
    bool waits = false;     // it has its command, since its stop is not reached

    bool is_given() const { return lower == upper || waits; }
  };
  enum class Branch : char { pull, hold };  // an effort at or below its command, or above it

  void sort(const StepProblem& problem, std::span<double> effort);
  void sort_actuator(const StepProblem& problem, int index, std::span<double> effort);
  Box box_of(const ActuatorBlock& block, int index) const;
  static double idle_effort(const Box& box, double gap);
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
  bool switch_branches(const StepProblem& problem, const Eigen::Map<const MatrixX>& compliance);

  Followers followers_;
  std::vector<Box> boxes_;            // of actuators, then of capstans
  std::size_t first_capstan_ = 0;     // of boxes_
  std::vector<qp::ConeBlock> cones_;  // rows among the unknowns
  std::vector<int> unknown_;          // rows of boxes, then of cones
  std::vector<Branch> branch_;        // (actuators,)
  int unreachable_ = -1;              // see unreachable()
  VectorX free_;                      // (rows,) delta where unknowns and followers are zero
  linalg::ScratchMatrix compliance_;  // (unknowns, unknowns)
  linalg::ScratchMatrix motion_;      // (unknowns, 1)
  linalg::AlignedNumbers x_;          // (unknowns,)
  std::vector<std::array<double, 2>> limits_;  // (capstans,) N, that follow from the tensions

  qp::QuadraticProgram program_;
  qp::QpSolver qp_solver_;
  VectorX scale_;  // (boxes,)
  std::vector<qp::BoxBlock> cone_boxes_;
  qp::ConeSolver cone_solver_;
};

}  // namespace sinew::step
