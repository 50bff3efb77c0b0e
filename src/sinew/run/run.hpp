/// @file
/// The data of one simulation.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/law/step_solver.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/actuation.hpp"
#include "sinew/run/instruments.hpp"
#include "sinew/run/kept_factors.hpp"
#include "sinew/run/measured_correction.hpp"
#include "sinew/run/state.hpp"
#include "sinew/run/step_report.hpp"
#include "sinew/run/step_watch.hpp"
#include "sinew/run/surroundings.hpp"
#include "sinew/run/work_ledger.hpp"
#include "sinew/world/stage_clock.hpp"
#include "sinew/world/world.hpp"

namespace sinew::run {

class Commander;
struct Inputs;
struct NewtonReport;
struct NewtonSettings;

/// The data on which Stepper, StaticSolver and PathFollower work; Simulation is its public
/// interface.
struct Run {
  /// See Simulation::Simulation().
  Run(std::shared_ptr<const model::Model> shared_model, int threads);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  double time() const { return static_cast<double>(steps) * model->step().time_step; }  ///< s
  /// Integrator weights of the next step. @param time_step s.
  mechanics::StepWeights step_weights(double time_step) const;
  /// How the work of the next step is computed.
  Quadrature quadrature() const;
  mechanics::LinearisationRequest request(double time_step) const;
  /// Weights of the bodies whose integrator starts afresh in the next step, if there are any.
  /// @param time_step s.
  std::optional<mechanics::StepWeights> weights_afresh(double time_step) const;
  /// Whether the next step uses a formula of several steps.
  bool reaches_back() const;
  /// Lets the integrators of all bodies start afresh in the next step.
  void forget_history();
  /// Writes limits and commands of the actuators into the step's problem. @param time s, the end of
  /// the step. @param time_step s; infinity removes the rate limits.
  void read_commands(double time, double time_step);
  /// Sets bases and loads to their values at the time `now` and begins a step of the world that
  /// ends there. Also needed after restore(), since a state contains the loads of its own step.
  /// @param time_step s.
  void begin_world(double time_step);
  /// Runs Newton's method from the world's present state. @param chooser,settings see
  /// solve_newton().
  NewtonReport newton(law::Controller* chooser, const NewtonSettings& settings);
  /// The attached controller or commander; null if there is none.
  law::WithMemory* attached() const;
  /// When quasi-static steps end; see StepSettings::equilibrium.
  model::Equilibrium equilibrium() const;
  /// Updates efforts and motions of actuators and joints from the state at the end of the step.
  void finish_step();
  void restart();

  /// Writes the state, except the memory of the instruments, which a step does not change.
  /// Allocates nothing if the vectors already have their sizes.
  void keep(State& state) const;
  /// Restores what keep() writes, and leaves the instruments as they are.
  void restore(const State& state);
  /// Restores `before` after a failed or interrupted step or search.
  void go_back();
  Inputs inputs() const;
  void set_inputs(const Inputs& inputs);
  /// See Simulation::set_stiffness_factor().
  void set_stiffness_factor(int body, double factor);

  std::size_t bytes() const;

  std::shared_ptr<const model::Model> model;
  ThreadPool pool;
  world::World world;
  StepWatch watch;
  law::StepSolver solver;
  law::DirectSolver correction_solver;    ///< for World::correction()
  law::Controller* controller = nullptr;  ///< attached; chooses efforts within steps
  Commander* commander = nullptr;         ///< attached; gives commands before steps
  Actuation actuation;
  Surroundings surroundings;
  std::vector<double> effort;  ///< (rows,) N or Pa, of the equation of the last step
  WorkLedger ledger;
  std::int64_t steps = 0;  ///< since the start
  double last_step = 0.0;  ///< s, length of the last substep; 0: the integrator starts afresh
  double next_step = 0.0;  ///< s, length to try for the next substep; 0: the whole step
  bool follows = false;    ///< see Simulation::follow()
  MeasuredCorrection correction;
  KeptFactors kept_factors;
  double volume_ratio = 1.0;
  double now = 0.0;  ///< s, end of the current substep
  /// Whether the state descends from a failed step (is_failure()).
  bool failed = false;
  bool keeps_going =
      false;     ///< whether the present step failed and is kept, see Simulation::step()
  State before;  ///< state before the current substep or search
  StepReport report;
  world::StageClock clock;
  Instruments instruments;
};

}  // namespace sinew::run
