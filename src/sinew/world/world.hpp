/// @file
/// All bodies of a simulation and the rows that couple them: the linear system of a step.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/constraint/configuration.hpp"
#include "sinew/contact/contact_rows.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/law/law_status.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/world/bodies.hpp"
#include "sinew/world/geometric_stiffness.hpp"
#include "sinew/world/homotopy.hpp"
#include "sinew/world/joint_rows.hpp"

namespace sinew::law {
class Controller;
class DirectSolver;
class StepSolver;
}  // namespace sinew::law

namespace sinew::world {

class EndEfforts;
class StageClock;

/// Bodies, rows and step problem of one simulation, below the level of commands and laws. Allocates
/// nothing after construction, except at the first use of geometric stiffness.
class World {
 public:
  /// @param model shared. @param pool must outlive the world.
  World(std::shared_ptr<const model::Model> model, ThreadPool& pool);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Begins a step: places surfaces and bodies, and chooses the active contact points.
  /// @param from,to s, start and end of the step, which fix the positions of moving surfaces.
  /// @param effort (rows,) N of the last step, in and out: points with a force are active, whatever
  ///   their gap, and where contact points are searched anew, forces move to the rows of the new
  ///   points.
  /// @param reach m: points with a smaller gap are active, too.
  void begin_step(double from, double to, std::span<double> effort, double reach = 0.0);
  /// Begins a motion from an equilibrium with the contact points of its solution. A new search may
  /// name other points, and a point that it does not name loses its force.
  /// @param at s, time of the surfaces' positions. @param effort (rows,) N, of the solution.
  void begin_at_rest(double at, std::span<double> effort);
  /// Begins a query of the present state, which moves no base. The active contact points are those
  /// with which a step from here would begin. @param at s, time of the surfaces' positions.
  /// @param effort (rows,) N, see begin_step().
  void begin_query(double at, std::span<double> effort);
  /// The same with all contact points that a step could use.
  void begin_query(double at);
  /// The same within an event-driven step; searches the points of contacts that strike. @param at
  /// s. @param effort (rows,) N, see begin_step().
  void begin_event_query(double at, std::span<double> effort);
  /// Restricts the contact problem to the closed points of contacts that strike, for an impact at
  /// the present state. Call after begin_event_query().
  void take_closed_points();
  /// Assembles every body at its current state.
  void linearise(const mechanics::LinearisationRequest& request);
  /// Computes H and delta at the current configuration and passes them to the bodies. condense()
  /// adds the geometric stiffness of the constraints `geometric` at `effort`, see
  /// GeometricStiffness.
  void form_rows(std::span<const double> effort, std::span<const int> geometric);
  /// Computes W and delta_free of the step's problem. @return the worst status of any body.
  linalg::FactorStatus condense();
  /// Solves the step's problem for efforts that satisfy all laws and for dq of all bodies, which
  /// Bodies::apply_motion() applies. If the motion shows that the active set of contacts was wrong
  /// (see ContactRows::correct()), it is corrected and the problem solved again with the same
  /// factorisation.
  /// @param solver,controller see law::StepSolver. @param effort (rows,) N, in and out. @param
  ///   clock records the times of the stages from the law on.
  law::LawStatus solve_step(law::StepSolver& solver, law::Controller* controller,
                            std::span<double> effort, StageClock& clock);
  /// The same with the matrix and W of the last condense(), although the bodies have been
  /// linearised and the rows formed anew since: one iteration of the simplified Newton method (P.
  /// Deuflhard, Newton Methods for Nonlinear Problems (2004), section 2.1). It converges to the
  /// solution of the same equations, since b, H and delta are those of the present state.
  law::LawStatus solve_step_again(law::StepSolver& solver, std::span<double> effort,
                                  StageClock& clock);
  /// (rows,) N, the efforts before the last solve_step() or solve_step_again().
  std::span<const double> efforts_before() const { return effort_before_; }
  /// The motion that solve_step_again() would propose, as its largest change of any coordinate, m.
  /// Changes neither the problem nor the efforts; actuators of a controller keep their efforts.
  /// @param solver of the laws, begun for this step. @param effort (rows,) N, of the present state.
  /// @return NaN if the laws have no solution.
  double correction(law::DirectSolver& solver, std::span<const double> effort);

  /// Inertia of all bodies' matrices at the last condensation.
  const mechanics::Inertia& inertia() const { return inertia_; }
  /// Whether the robot with its drives and held rows is stable according to its linearisation.
  bool is_stable() const;
  /// Whether it is stable if what is taut stays so; the next solution then supposes that, see
  /// law::brace(). Until the next condensation. @param effort (rows,) N.
  bool brace(std::span<const double> effort);
  /// Whether A contains a majorant of the geometric stiffness, and is therefore not the derivative.
  bool has_majorant() const { return stiffness_.has_majorant(); }

  /// m: violation of all laws by `effort` at the present configuration, including points that were
  /// left out; see law::violation(). @param effort (rows,) N. @param law status of the solution
  /// that gave `effort`.
  double violation(std::span<const double> effort, law::LawStatus law);

  /// The step's problem, see RowNumbering for its rows. The caller writes the blocks of the
  /// actuators; the world writes the grip of capstans, joints, contacts and all values of rows.
  law::StepProblem& problem() { return problem_; }
  const law::StepProblem& problem() const { return problem_; }
  /// The data that last_linearisation() reads.
  struct Solved {
    law::StepProblem problem;
    contact::RowNumbering numbering;
    VectorX delta;  // (rows,) m
    mechanics::Inertia inertia;
    bool is_present = false;
  };
  /// Whether problem(), numbering() and inertia() are those of the step that led to the present
  /// state; false after a query or an impact, or when another state was restored.
  bool has_solved() const { return has_solved_; }
  void forget_solved() { has_solved_ = false; }
  /// A copy for a query, which restores it together with the state.
  Solved keep_solved() const { return {problem_, numbering_, rows_.delta, inertia_, has_solved_}; }
  void put_back(Solved solved);

  /// For the step that was solved last, see ContactRows::mark_turning_back(). @param time_step s.
  /// @param bodies (bodies,) marks.
  void mark_turning_back(double time_step, std::span<char> bodies) const {
    contacts_.mark_turning_back(problem_, numbering_, problem_effort_, time_step, bodies);
  }
  const contact::RowNumbering& numbering() const { return numbering_; }
  /// Stores the present positions at which cables stick to their guides and joints to their
  /// friction in this step.
  void hold_friction();
  const VectorX& delta() const { return rows_.delta; }  ///< (rows,) m, as last computed
  /// Computes delta at the current configuration, without passing the rows to the bodies.
  const VectorX& measure_delta();
  const mechanics::RowValues& rows() const { return rows_; }

  const contact::ContactRows& contacts() const { return contacts_; }
  contact::ContactRows& contacts() { return contacts_; }
  const JointRows& joints() const { return joints_; }
  JointRows& joints() { return joints_; }
  const constraint::Configuration& configuration() const { return configuration_; }
  Homotopy& homotopy() { return homotopy_; }
  const model::Model& model() const { return *model_; }
  Bodies& bodies() { return bodies_; }
  const Bodies& bodies() const { return bodies_; }

  /// What efforts at the end of the last step differ from those of its equation.
  EndEfforts& end_efforts() { return *end_efforts_; }
  const EndEfforts& end_efforts() const { return *end_efforts_; }

  /// Returns all bodies to rest and surfaces to their initial poses, as after construction.
  void restart();
  std::size_t bytes() const;

 private:
  void place_contacts(double from, double to);
  void begin_contacts(double from, double to, std::span<double> effort, double reach);
  void choose_points(double from, double to, std::span<double> effort, double reach);
  bool correct_contacts(bool looks, StageClock& clock);
  law::LawStatus solve_laws(law::StepSolver& solver, law::Controller* controller, bool again,
                            std::span<double> effort, StageClock& clock);
  void number_rows();
  void form_compliance();
  void renew_free_motion(std::span<const double> effort, bool turned);

  std::shared_ptr<const model::Model> model_;
  Bodies bodies_;
  Homotopy homotopy_;
  constraint::Configuration configuration_;
  mechanics::RowValues rows_;
  JointRows joints_;
  law::StepProblem problem_;
  contact::RowNumbering numbering_;
  contact::ContactRows contacts_;
  GeometricStiffness stiffness_;
  mechanics::Inertia inertia_;
  bool has_solved_ = false;
  std::vector<double> effort_before_;      // (rows,) N, of the last step or iteration
  linalg::AlignedNumbers problem_effort_;  // (rows of the problem,) N, of the last solution
  linalg::AlignedNumbers scratch_;         // (rows of the problem,)
  std::unique_ptr<EndEfforts> end_efforts_;
  // For correction():
  VectorX held_free_;
  std::vector<double> trial_;  // (rows,) N
};

}  // namespace sinew::world
