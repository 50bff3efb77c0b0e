/// @file
/// The data of one simulation.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/sim/actuation.hpp"
#include "sinew/sim/estimators.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/sensors.hpp"
#include "sinew/sim/stage_clock.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/step_report.hpp"
#include "sinew/sim/step_watch.hpp"
#include "sinew/sim/surroundings.hpp"
#include "sinew/sim/work_ledger.hpp"
#include "sinew/sim/world.hpp"
#include "sinew/step/step_solver.hpp"

namespace sinew::sim {

class Commander;
struct Inputs;
struct NewtonReport;
struct NewtonSettings;

/// What Stepper, StaticSolver and PathFollower work on, and Simulation shows.
struct Run {
  /// See Simulation.
  Run(std::shared_ptr<const Model> shared_model, int threads);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  double time() const { return static_cast<double>(steps) * model->step().time_step; }  ///< s
  /// Of the next step. @param time_step s.
  mechanics::StepWeights step_weights(double time_step) const;
  mechanics::LinearisationRequest request(double time_step) const;
  /// What actuators may do in a step, into its problem. @param time s, its end. @param time_step s;
  /// infinity lifts the limits on rates.
  void read_commands(double time, double time_step);
  /// Bases and loads as at `now`, and the world begins a step that ends there. Also after
  /// restore(), since a state has the loads of its own step. @param time_step s.
  void begin_world(double time_step);
  /// From where the world is. @param chooser,settings see solve_newton().
  NewtonReport newton(step::Controller* chooser, const NewtonSettings& settings);
  /// Of what is attached; null: nothing is.
  step::WithMemory* attached() const;
  /// Reads off the state what actuators did.
  void finish_step();
  void restart();

  /// Writes the state, but for the memory of estimators, which a step does not touch. Allocates
  /// nothing where it has the sizes already.
  void keep(State& state) const;
  /// Takes up what keep() writes; see Simulation.
  void restore(const State& state);
  /// To `before`, after what failed or was ended there.
  void go_back();
  Inputs inputs() const;
  void set_inputs(const Inputs& inputs);

  std::size_t bytes() const;

  std::shared_ptr<const Model> model;
  ThreadPool pool;
  World world;
  StepWatch watch;
  step::StepSolver solver;
  step::Controller* controller = nullptr;  ///< that is attached, and chooses efforts in steps
  Commander* commander = nullptr;          ///< that is attached, and commands before steps
  Actuation actuation;
  Surroundings surroundings;
  std::vector<double> effort;  ///< (rows,) N or Pa
  WorkLedger ledger;
  std::int64_t steps = 0;  ///< since the start
  double last_step = 0.0;  ///< s, the last substep; 0: the integrator starts afresh
  double next_step = 0.0;  ///< s, what the next substep tries; 0: the whole step
  double volume_ratio = 1.0;
  double now = 0.0;  ///< s, end of the substep in hand
  State before;      ///< before that, or before the search in hand
  StepReport report;
  Sensors sensors;
  Estimators estimators;
  StageClock clock;
};

}  // namespace sinew::sim
