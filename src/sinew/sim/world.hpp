/// @file
/// All bodies of a simulation and the rows between them, as one linear system a step.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/constraint/configuration.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/sim/bodies.hpp"
#include "sinew/sim/contact_rows.hpp"
#include "sinew/sim/geometric_stiffness.hpp"
#include "sinew/sim/homotopy.hpp"
#include "sinew/sim/joint_rows.hpp"
#include "sinew/sim/row_numbering.hpp"
#include "sinew/step/law_status.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::step {
class Controller;
class StepSolver;
}  // namespace sinew::step

namespace sinew::sim {

class StageClock;

/// Data of one simulation below the level of commands and laws. Nothing allocates after
/// construction, but for the first use of geometric stiffness.
class World {
 public:
  /// @param model shared. @param pool must outlive the world.
  World(std::shared_ptr<const Model> model, ThreadPool& pool);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// @param from,to s, when the step begins and ends: where surfaces stand then. @param effort
  ///   (rows,) N of the last step, in and out: points with a force are near, whatever their gap,
  ///   and those that are found anew take it to other rows.
  /// @param reach m: points that are nearer than this to their surface are near, too.
  void begin_step(double from, double to, std::span<double> effort, double reach = 0.0);
  /// For a look at the present state, which moves no base: those contact points take part that a
  /// step from here would begin with. @param at s, when surfaces are looked at.
  /// @param effort (rows,) N, see begin_step().
  void begin_query(double at, std::span<double> effort);
  /// The same with every contact point that a step could have a use for.
  void begin_query(double at);
  /// The same for a look within an event-driven step, for which contacts that strike find their
  /// points. @param at s. @param effort (rows,) N, see begin_step().
  void begin_look(double at, std::span<double> effort);
  /// For an impact at the present state, after begin_look(): the closed points of contacts that
  /// strike, and no others, are in the problem.
  void take_closed_points();
  /// Assembly: every body at its current state.
  void linearise(const mechanics::LinearisationRequest& request);
  /// H and delta at the current configuration, handed to the bodies. condense() adds the geometric
  /// stiffness of the constraints `geometric` at `effort`, see GeometricStiffness.
  void form_rows(std::span<const double> effort, std::span<const int> geometric);
  /// W and delta_free of the step's problem. The worst status of any body.
  linalg::FactorStatus condense();
  /// Efforts that obey all blocks, and dq of all bodies, which Bodies::apply_motion() takes. As
  /// long as that motion shows that contacts were guessed wrong (see ContactRows::correct()), this
  /// is mended and the problem solved again, of the same factorisation.
  /// @param solver,controller see step::StepSolver. @param effort (rows,) N, in and out. @param
  /// clock gets the times of the law and of the motion.
  step::LawStatus solve_step(step::StepSolver& solver, step::Controller* controller,
                             std::span<double> effort, StageClock& clock);

  /// Of all bodies, at the last condensation.
  const mechanics::Inertia& inertia() const { return inertia_; }
  /// Whether the robot is stable with its drives and held rows, as far as its linearisation tells.
  bool is_stable() const;
  /// Whether a majorant of the geometric stiffness stands in A, which is then no derivative.
  bool has_majorant() const { return stiffness_.has_majorant(); }

  /// m: how far `effort` and the present configuration are from obeying all laws, points that are
  /// left out included; see step::violation(). @param effort (rows,) N. @param law how it was
  /// found.
  double violation(std::span<const double> effort, step::LawStatus law);

  /// The step's problem, see RowNumbering for its rows. Actuators are the caller's to write;
  /// capstans' grip, joints, contacts and all numbers of rows are the world's.
  step::StepProblem& problem() { return problem_; }
  const step::StepProblem& problem() const { return problem_; }
  /// What last_linearisation() reads.
  struct Solved {
    step::StepProblem problem;
    RowNumbering numbering;
    VectorX delta;  // (rows,) m
    mechanics::Inertia inertia;
    bool is_present = false;
  };
  /// Whether problem(), numbering() and inertia() are those that led to the present state: not of
  /// a query or an impact, nor of another state that was left since.
  bool has_solved() const { return has_solved_; }
  void forget_solved() { has_solved_ = false; }
  /// For a query, which puts it back when it has put back the state.
  Solved keep_solved() const { return {problem_, numbering_, rows_.delta, inertia_, has_solved_}; }
  void put_back(Solved solved);

  /// Of the step that was solved last, see ContactRows. @param time_step s.
  bool turns_back(double time_step) const {
    return contacts_.turns_back(problem_, numbering_, problem_effort_, time_step);
  }
  const RowNumbering& numbering() const { return numbering_; }
  /// From where cables stick to their guides in this step, and joints to their friction.
  void hold_friction();
  const VectorX& delta() const { return rows_.delta; }  ///< (rows,) m, as last formed
  /// delta at the current configuration, without forming the rows anew for the bodies.
  const VectorX& measure_delta();
  const mechanics::RowValues& rows() const { return rows_; }

  const ContactRows& contacts() const { return contacts_; }
  ContactRows& contacts() { return contacts_; }
  const JointRows& joints() const { return joints_; }
  JointRows& joints() { return joints_; }
  const constraint::Configuration& configuration() const { return configuration_; }
  Homotopy& homotopy() { return homotopy_; }
  const Model& model() const { return *model_; }
  Bodies& bodies() { return bodies_; }
  const Bodies& bodies() const { return bodies_; }

  /// All bodies at rest and surfaces where they are at the start, as after construction.
  void restart();
  std::size_t bytes() const;

 private:
  void place_contacts(double from, double to);
  bool correct_contacts();
  void number_rows();
  void form_compliance();

  std::shared_ptr<const Model> model_;
  Bodies bodies_;
  Homotopy homotopy_;
  constraint::Configuration configuration_;
  mechanics::RowValues rows_;
  JointRows joints_;
  step::StepProblem problem_;
  RowNumbering numbering_;
  ContactRows contacts_;
  GeometricStiffness stiffness_;
  mechanics::Inertia inertia_;
  bool has_solved_ = false;
  std::vector<double> effort_before_;      // (rows,) N, of the last step or iteration
  linalg::AlignedNumbers problem_effort_;  // (rows of the problem,) N, of the last solution
  linalg::AlignedNumbers scratch_;         // (rows of the problem,)
};

}  // namespace sinew::sim
