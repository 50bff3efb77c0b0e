/// @file
/// A running robot: model, state, commands, and the step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/energies.hpp"
#include "sinew/sim/path_settings.hpp"
#include "sinew/sim/static_settings.hpp"
#include "sinew/sim/step_progress.hpp"
#include "sinew/sim/step_report.hpp"

namespace sinew::constraint {
class Configuration;
}
namespace sinew::mechanics {
class Body;
}
namespace sinew::step {
struct ActuatorBlock;
class Controller;
class WithMemory;
}  // namespace sinew::step

namespace sinew::sim {

struct ActuatorState;
class Channel;
struct Command;
class Commander;
class ContactReader;
class Estimator;
struct EnergyLedger;
struct Inputs;
class Model;
struct Run;
class Signal;
struct State;
class Stepper;
class World;

/// One run of a model. Not thread-safe itself; any number may run side by side in threads.
class Simulation {
 public:
  /// @param model shared. @param threads inside a step, >= 1. Throws Error(out-of-range).
  explicit Simulation(std::shared_ptr<const Model> model, int threads = 1);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const Model& model() const;
  std::shared_ptr<const Model> shared_model() const;
  int threads() const;
  /// Parts of the steps' work that thread 0 .. threads()-1 has done so far.
  long work_done(int thread) const;
  double time() const;  ///< s
  std::int64_t steps() const;

  /// Advances one time step. Throws Error(diverged | inverted-in-run | singular-matrix |
  /// not-converged) with the step, the body and the likely cause; the state is then that before the
  /// step.
  const StepReport& step();
  const StepReport& report() const;
  /// Has steps, solve_static() and follow_path() tell how far they are, from the next one on. What
  /// the watcher throws ends them and passes on; the state is then that before the step or the
  /// search, or that of the path's last point. No part of inputs or state, and not cloned.
  /// @param watcher see there; empty: nobody watches.
  void watch(StepWatcher watcher);
  /// Of all bodies now. Evaluates their elements.
  mechanics::Energies energies();
  /// What has been put into the energy and taken out since the start or reset().
  const EnergyLedger& ledger() const;

  /// A stable static equilibrium at the present inputs: commands at the present time, limits on
  /// rates lifted, actuators of a controller held at their efforts; see StaticSolver. Velocities
  /// become zero; time stands still. Friction of contacts is that of one slow motion from the
  /// present state.
  /// Throws Error(not-converged) and restores the state when there is none to be found.
  StaticReport solve_static(const StaticSettings& settings = {});

  /// Equilibria from the present one to that of the present loads' factors and commanded efforts,
  /// all growing in proportion from what acted last (nothing, at the start): through limit points
  /// and back, stable or not; see PathFollower. Velocities become zero; time stands still. The last
  /// point lies at the full load or just beyond; solve_static() finds that of the load itself from
  /// there. Friction of contacts is that of one slow motion from each point to the next.
  /// @param settings see there. @param visit called at every point.
  /// Throws Error(bad-argument) where an actuator is told a motion, has a drive or friction;
  /// Error(not-in-this-version) beside curved surfaces with friction, and where contacts alone hold
  /// a body; Error(not-converged), the state then being that of the start.
  std::vector<PathPoint> follow_path(const PathSettings& settings,
                                     const std::function<void()>& visit = {});

  /// Back to the start, bit for bit: state, time, commands of the model. Controllers stay attached.
  void reset();

  /// Tells an actuator what to do. Throws Error(actuator-owned) while a controller has it, or a
  /// commander other than `by`.
  void command(int actuator, Command command, const Commander* by = nullptr);
  const ActuatorState& actuator(int index) const;
  /// Moves a body's fixed nodes in the next step: turned about `centre` by a rotation vector and
  /// then shifted, from rest. An input, as commands are: where the nodes then are is state.
  /// @param body its number. @param translation (3,) m. @param rotation (3,) rad.
  /// @param centre (3,) m, at rest.
  /// Throws Error: wrong-type (no finite elements), nothing-fixed, not-finite, bad-argument where
  /// the model moves this base.
  void move_base(int body, const Vector3& translation, const Vector3& rotation,
                 const Vector3& centre);
  /// A load's factor from the next step on.
  void set_load(int load, Signal factor);
  const Signal& load_factor(int load) const;
  /// Position (3,) m, or rotation vector (3,) rad, of an effector.
  Vector3 effector_value(int index) const;
  /// (components,) what a probe measures now, m and rad. @param index of Model::probes().
  std::vector<double> probe_values(int index) const;

  /// The channel of a sensor: what it says, when it was taken. @param index of Model::sensors().
  const Channel& sensor(int index) const;
  /// (size,) what it would say now without errors and delay. @param index of Model::sensors().
  std::vector<double> sensor_truth(int index) const;
  /// The same into (size,) numbers, which allocates nothing. @param index of Model::sensors().
  /// @param values replaced.
  void read_sensor_truth(int index, std::span<double> values) const;
  /// Takes a sample of a real sensor in place of the simulated ones, from now until reset(). Throws
  /// what Channel::receive() does. @param index of Model::sensors(). @param time s, when it was
  /// taken. @param value (size,).
  void feed_sensor(int index, double time, std::span<const double> value);

  /// What an estimator concludes from the sensors, after each step and each search for an
  /// equilibrium. @param index of Model::estimators().
  const Estimator& estimator(int index) const;

  /// Forces, gaps and states of contacts; valid as long as the simulation.
  ContactReader contacts() const;

  /// Gives a controller the actuators that it chooses efforts for, in every step until it is
  /// detached. One controller at a time. Throws Error(actuator-owned); Error(not-in-this-version)
  /// with event-driven integration.
  /// @param controller must be detached before it ends. @param actuators of the model.
  /// @param contacts whose forces it asks for, see ContactRows::want().
  void attach(step::Controller& controller, std::span<const int> actuators,
              std::span<const int> contacts = {});
  void detach(const step::Controller& controller);
  const step::Controller* attached_controller() const;
  /// Gives a commander the actuators that it alone commands until it is detached. One commander or
  /// controller at a time. Throws Error(actuator-owned).
  /// @param commander must be detached before it ends. @param actuators of the model.
  void attach(Commander& commander, std::span<const int> actuators);
  void detach(const Commander& commander);

  World& world();
  const World& world() const;
  int bodies() const;
  /// @param index of Model::bodies(). What only some bodies can do: mechanics::as().
  mechanics::Body& body(int index);
  const mechanics::Body& body(int index) const;
  /// Where the points of all bodies are now.
  const constraint::Configuration& configuration() const;
  std::span<const double> efforts() const;  ///< (rows,) N or Pa
  /// The numbers of an actuator's drive (see Drive); empty without one.
  std::span<const double> drive_state(int actuator) const;
  /// What actuators were allowed and told in the last step.
  std::span<const step::ActuatorBlock> actuator_blocks() const;

  /// Everything that decides, with the inputs, how the run goes on.
  State state() const;
  /// Takes up a state, of this simulation or of another one of the same model. A controller takes
  /// up its memory where the state has it; otherwise it begins anew, as do sensors where those of
  /// the state are others. Commands stay as they are.
  /// Throws Error(wrong-length) for a state of another model, and is then unchanged; and where the
  /// memory of estimators is damaged, which then begin anew.
  void restore(const State& state);
  /// What acts from outside: commands, load factors, forces, tethers, and where bases are asked to
  /// be.
  Inputs inputs() const;
  /// Throws Error(wrong-length) for inputs of another model, and is then unchanged.
  void set_inputs(const Inputs& inputs);
  /// A simulation of the same model, with the same inputs, in the same state. A controller is not
  /// copied: attach one to the copy, and restore() the state again for its memory.
  std::unique_ptr<Simulation> clone() const;
  /// Bytes that one more simulation of the same model takes.
  std::size_t bytes() const;

 private:
  void step_by_command();
  void require_free(const step::WithMemory* newcomer) const;

  std::unique_ptr<Run> run_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace sinew::sim
