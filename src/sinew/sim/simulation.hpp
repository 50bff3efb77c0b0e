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
#include "sinew/run/step_progress.hpp"
#include "sinew/run/step_report.hpp"
#include "sinew/statics/path_settings.hpp"
#include "sinew/statics/static_settings.hpp"

namespace sinew::constraint {
class Configuration;
}
namespace sinew::mechanics {
class Body;
}
namespace sinew::law {
struct ActuatorBlock;
class Controller;
class WithMemory;
}  // namespace sinew::law

namespace sinew::model {
struct ActuatorState;
struct Command;
class Model;
class Signal;
}  // namespace sinew::model

namespace sinew::run {
class Commander;
class ContactReader;
struct EnergyLedger;
struct Inputs;
class Instruments;
struct Run;
struct State;
}  // namespace sinew::run

namespace sinew::step {
class Stepper;
}

namespace sinew::world {
class World;
}

namespace sinew::sim {

/// What a step that fails does.
enum class OnFailure {
  stop,        ///< throws, and restores the state before it
  keep_going,  ///< keeps its state where that can be evaluated, flagged
};

/// One run of a model: its state, inputs and time steps. An instance is not thread-safe; different
/// simulations may run in parallel threads.
class Simulation {
 public:
  /// @param model shared. @param threads number of threads inside a step, >= 1.
  /// Throws Error(out-of-range).
  explicit Simulation(std::shared_ptr<const model::Model> model, int threads = 1);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const model::Model& model() const;
  std::shared_ptr<const model::Model> shared_model() const;
  int threads() const;
  /// Number of work items of all steps that thread 0 .. threads()-1 has executed so far.
  long work_done(int thread) const;
  double time() const;  ///< s
  std::int64_t steps() const;

  /// Advances the run by one time step. Throws Error(diverged | inverted-in-run | singular-matrix |
  /// not-converged), whose text names the step, the body and the likely cause. The state is then
  /// restored to that before the step, and the report has the status of the failure.
  /// @param on_failure whether a step that ends not in equilibrium or unphysical throws
  ///   (is_failure()), or is kept where its state can be evaluated; no state that descends from it
  ///   is then `solved` until reset() or restore().
  const run::StepReport& step(OnFailure on_failure = OnFailure::stop);
  const run::StepReport& report() const;
  /// Sets a callback to which step(), solve_static() and follow_path() report their progress, from
  /// the next call on. An exception thrown by the watcher ends the call and propagates; the state
  /// is then that before the step or search, or that of the last point of the path. The watcher is
  /// part of neither inputs nor state, and is not cloned.
  /// @param watcher the callback, see StepWatcher; empty: no reports.
  void watch(run::StepWatcher watcher);
  /// The present energies of all bodies. Evaluates their elements.
  mechanics::Energies energies();
  /// The work done on the bodies and the energy dissipated since the start or reset().
  const run::EnergyLedger& ledger() const;

  /// Finds a stable static equilibrium under the present inputs (see StaticSolver): commands and
  /// loads are evaluated at the present time, rate limits do not apply, and actuators of a
  /// controller keep their efforts. Velocities become zero; time does not advance. Contact friction
  /// acts as in a single slow motion from the present state.
  /// Throws Error(not-converged) if no equilibrium is found, and restores the state.
  statics::StaticReport solve_static(const statics::StaticSettings& settings = {});

  /// Follows the path of equilibria from the present one as loads and commanded efforts grow in
  /// proportion from their last applied values (zero at the start) to their present ones, through
  /// limit points, stable or not; see PathFollower. Velocities become zero; time does not advance.
  /// No step changes the load by more than 10 % of the full one. The last point lies at the full
  /// load or at most 10 % beyond it; solve_static() finds the equilibrium at exactly the full load
  /// from there. Contact friction acts as in one slow motion from each point to the next. A path
  /// that ends early (Path::end) leaves the simulation at its last point.
  /// @param settings step lengths, tolerance and number of points. @param visit called at every
  ///   point.
  /// Throws Error(bad-argument) if an actuator has a drive or a commanded motion, or if cables have
  /// friction or joints have limits or friction; Error(not-in-this-version) for curved surfaces
  /// with friction, aggregated contacts, contacts between bodies, and bodies held by contacts
  /// alone; Error(not-converged) if it has no point at all, after which the state is that at the
  /// start.
  statics::Path follow_path(const statics::PathSettings& settings,
                            const std::function<void()>& visit = {});

  /// Returns to the start, bit for bit: state, time and the model's commands. Controllers stay
  /// attached.
  void reset();

  /// From the next step on, quasi-static steps follow (Equilibrium::following), unless the model's
  /// StepSettings::equilibrium says otherwise: for programs that steer the robot in real time
  /// without attaching a controller.
  /// @param on false: as the model says, otherwise `converged` without a controller.
  void follow(bool on = true);
  bool follows() const;
  /// When quasi-static steps end: as the model says, or by the default for this run.
  model::Equilibrium equilibrium() const;

  /// Sets the command of an actuator. Throws Error(actuator-owned) unless the actuator's owner is
  /// `by` (null: it has no owner); actuators of a controller accept no commands.
  void command(int actuator, model::Command command, const run::Commander* by = nullptr);
  const model::ActuatorState& actuator(int index) const;
  /// Prescribes the position of a body's fixed nodes in the next step: from their rest positions,
  /// they are rotated about `centre` by a rotation vector and then translated. The prescribed
  /// displacement is an input, like a command; the positions that the nodes have reached are state.
  /// @param body index of Model::bodies(). @param translation (3,) m. @param rotation (3,) rad.
  /// @param centre (3,) m, at rest.
  /// Throws Error: wrong-type (body without finite elements), nothing-fixed, not-finite,
  /// bad-argument if the model prescribes the motion of this base.
  void move_base(int body, const Vector3& translation, const Vector3& rotation,
                 const Vector3& centre);
  /// Sets the factor of a load from the next step on.
  void set_load(int load, model::Signal factor);
  const model::Signal& load_factor(int load) const;
  /// Sets the factor of all moduli of a body's elements (fem::HasMaterial) from the next step on.
  /// The strain energy of the deformed body changes at once; the change counts as outside work.
  /// @param body index of Model::bodies(). @param factor > 0.
  /// Throws Error: wrong-type (body without finite elements), out-of-range (also not finite).
  void set_stiffness_factor(int body, double factor);
  /// Position (3,) m, or rotation vector (3,) rad, of an effector.
  Vector3 effector_value(int index) const;
  /// (components,) the present values of a probe, m and rad. @param index of Model::probes().
  std::vector<double> probe_values(int index) const;

  /// Sensors and estimators, which observe after each step and each search for an equilibrium: see
  /// sensors_of() and estimator_of().
  run::Instruments& instruments();
  const run::Instruments& instruments() const;

  /// Forces, gaps and states of the contacts. The reader is valid as long as the simulation.
  run::ContactReader contacts() const;

  /// Attaches a controller, which chooses the efforts of the given actuators in every step until it
  /// is detached. Only one controller or commander can be attached at a time. Throws
  /// Error(actuator-owned); Error(not-in-this-version) with event-driven integration.
  /// @param controller must be detached before its lifetime ends. @param actuators indices of
  ///   Model::actuators().
  /// @param contacts whose forces the controller needs, see ContactRows::require_active().
  void attach(law::Controller& controller, std::span<const int> actuators,
              std::span<const int> contacts = {});
  void detach(const law::Controller& controller);
  /// Attaches a commander, which alone may command the given actuators until it is detached. Only
  /// one controller or commander can be attached at a time. Throws Error(actuator-owned).
  /// @param commander must be detached before its lifetime ends. @param actuators indices of
  ///   Model::actuators().
  void attach(run::Commander& commander, std::span<const int> actuators);
  void detach(const run::Commander& commander);

  world::World& world();
  const world::World& world() const;
  int bodies() const;
  /// @param index of Model::bodies(). Capabilities of some bodies only: mechanics::as().
  mechanics::Body& body(int index);
  const mechanics::Body& body(int index) const;
  /// Present positions of the points of all bodies.
  const constraint::Configuration& configuration() const;
  std::span<const double> efforts() const;  ///< (rows,) N or Pa
  /// The state variables of an actuator's drive (see Drive); empty without a drive.
  std::span<const double> drive_state(int actuator) const;
  /// Limits and commands of the actuators in the last step.
  std::span<const law::ActuatorBlock> actuator_blocks() const;

  /// Everything that, together with the inputs, determines how the run continues.
  run::State state() const;
  /// Sets the state to one of this simulation or of another simulation of the same model. An
  /// attached controller restores its memory if the state contains it, and otherwise starts afresh;
  /// so do instruments of which the state has no memory. Commands do not change.
  /// Throws Error(wrong-length) for a state of another model, which leaves the simulation
  /// unchanged; also if the memory of an instrument is damaged, in which case the state is
  /// restored and that instrument begins afresh.
  void restore(const run::State& state);
  /// External inputs: commands, load factors, forces, tethers, prescribed displacements of bases
  /// and stiffness factors.
  run::Inputs inputs() const;
  /// The state stays the same, and so does its energy ledger: set_stiffness_factor() counts the
  /// change of the strain energy, this does not.
  /// Throws Error: wrong-length for inputs of another model, out-of-range for a stiffness factor
  /// that is not above zero and finite. The simulation is then unchanged.
  void set_inputs(const run::Inputs& inputs);
  /// A new simulation of the same model with the same inputs and state. A controller is not copied:
  /// attach one to the copy, then restore() the state again to set its memory.
  std::unique_ptr<Simulation> clone() const;
  /// Memory of one more simulation of the same model, in bytes.
  std::size_t bytes() const;

 private:
  void make_step();
  void keep_failed_step();
  void step_by_command();
  bool make_same_step();
  void require_free(const law::WithMemory* newcomer) const;

  std::unique_ptr<run::Run> run_;
  std::unique_ptr<step::Stepper> stepper_;
};

}  // namespace sinew::sim
