/// @file
/// The class behind sinew.Simulation: the robot, the simulation, the attached controller, and a
/// guard against use by two threads at once.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sinew/control/target_controller.hpp"
#include "sinew/mechanics/tangent.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/strain_watch.hpp"
#include "sinew/sim/cable_watch.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"

namespace sinew::python {

/// A controller and its name in the scene. The name is empty for a controller made in Python.
struct AttachedController {
  std::string name;
  std::unique_ptr<control::TargetController> law;
  bool attached = true;
};

/// A robot, and the folder at which relative paths of its scene start.
struct LoadedRobot {
  scene::Robot robot;
  std::filesystem::path folder;
};

/// The tangent of a name. Throws Error(unknown-choice) for any other word.
/// @param word from Python. @param argument such as "linearise(tangent)", for errors.
mechanics::Tangent to_tangent(const std::string& word, const std::string& argument);

/// A saved state: either a state of a simulation in this process, or its bytes (sim/state_io.hpp).
class SavedState {
 public:
  explicit SavedState(std::string bytes) : bytes_(std::move(bytes)) {}
  SavedState(std::shared_ptr<const run::State> state, std::shared_ptr<const model::Model> model)
      : state_(std::move(state)), model_(std::move(model)) {}

  /// The bytes of the state. For a state of this process, they are made at the first call, since
  /// most states are only restored. Requires the GIL.
  const std::string& bytes() const;
  /// The state; null if only bytes are known, or the model has another fingerprint.
  const run::State* of(const model::Model& model) const;
  /// Number of steps so far. Throws Error(state-corrupt), Error(state-version).
  std::int64_t steps() const;

 private:
  mutable std::string bytes_;  // empty: not made yet
  std::shared_ptr<const run::State> state_;
  std::shared_ptr<const model::Model> model_;
};

/// A simulation in Python.
class Session {
 public:
  /// Makes a simulation with the scene's first controller attached.
  /// @param robot shared with clones. @param threads inside a step.
  Session(std::shared_ptr<const LoadedRobot> robot, int threads);

  /// Gives exclusive use while it exists. Throws SimulationBusy if another Use exists.
  class Use {
   public:
    explicit Use(const Session& session);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    const Session& session_;
  };

  /// Makes a simulation of the same robot with the same state, commands and controller.
  std::shared_ptr<Session> clone() const;

  const LoadedRobot& robot() const { return *robot_; }
  const model::Model& model() const { return simulation_.model(); }
  /// To be used only while a Use is held.
  sim::Simulation& simulation() { return simulation_; }
  const sim::Simulation& simulation() const { return simulation_; }
  /// The observables, with an energy ledger that counts from the start. To be used only while a Use
  /// is held.
  sim::Observables& observables() { return observables_; }

  /// busy(), steps() and time() may be called at any time, from any thread.
  bool busy() const { return busy_.load(std::memory_order_acquire); }
  std::int64_t steps() const { return steps_.load(std::memory_order_relaxed); }
  double time() const { return static_cast<double>(steps()) * model().step().time_step; }

  /// Advances `count` steps without the GIL. Like the solvers below, it checks regularly for
  /// Ctrl-C, also within a step; the state is then that of the last complete step. It warns
  /// (sinew.SinewWarning) of flagged steps, once per status until the next reset. Throws what
  /// sim::Simulation::step() throws, and Error(not-finite) for external forces.
  /// @param cables that watches the run; null: none does.
  void advance(std::int64_t count, sim::OnFailure on_failure = sim::OnFailure::stop) {
    advance(count, on_failure, nullptr);
  }
  void advance(std::int64_t count, sim::OnFailure on_failure, sim::CableWatch* cables);
  /// Advances from a thread that does not hold the GIL, without checking for Ctrl-C or warning.
  /// @param count maximum number of steps. @param ended called after each step; true ends the run.
  void advance_unlocked(std::int64_t count, const std::function<bool()>& ended);
  /// Warns of flagged steps, see advance().
  void warn();
  /// Keeps a pressure that Python commands, for warn_units(). @param what
  /// "actuator('air').pressure".
  /// @param signal Pa.
  void note_pressure(const std::string& what, const model::Signal& signal);
  /// Issues a SinewWarning for each pressure of which all commands so far were far below those of
  /// robots, such as 30 for 30 kPa. A loop that raises a pressure step by step passes small ones,
  /// so this is for calls whose result is final: many steps, and equilibria.
  void warn_units();
  /// Issues a SinewWarning for what a run showed about its cables, once per cable and kind.
  /// @param cables that watched the run.
  void warn_cables(const sim::CableWatch& cables);
  /// Issues a SinewWarning for each law that was not tested at the strains of a run, once each
  /// until the next reset. @param strains of the run.
  void warn_strains(const scene::StrainWatch& strains);
  statics::StaticReport solve_static(const statics::StaticSettings& settings);
  /// @param visit called without the GIL.
  statics::Path follow_path(const statics::PathSettings& settings,
                            const std::function<void()>& visit);
  /// Calls Simulation::reset(), and sets external forces to zero.
  void reset();
  SavedState state() const;
  /// Restores a state. Throws what sim::parse_state() throws.
  void restore(const SavedState& state);
  /// Call sim::load_state() and sim::save_state().
  void load_state(const std::filesystem::path& path);
  void save_state(const std::filesystem::path& path) const;

  sim::Linearisation linearise(const sim::LinearisationChoice& choice);
  sim::Linearisation last_linearisation();

  /// The attached controller; null if there is none.
  const std::shared_ptr<AttachedController>& controller() const { return controller_; }
  /// Attaches a controller. Throws Error(actuator-owned) if another one is attached.
  std::shared_ptr<AttachedController> attach(const control::ControllerSettings& settings,
                                             std::string name);
  /// Detaches `controller` if it is attached.
  void detach(AttachedController& controller);

  /// For code that holds a Use and steps the simulation itself: detaches the controller, which
  /// Python still sees as attached, and returns its settings; none if there is no controller.
  std::optional<control::ControllerSettings> lend_controller();
  /// Takes back the controller after lend_controller().
  /// @param same whether it is the one that was lent. @param name of another one.
  /// @param law the controller that is now attached, or null.
  void take_back(bool same, const std::string& name,
                 std::unique_ptr<control::TargetController> law);
  /// Updates steps() after other code has stepped the simulation.
  void count_steps() { steps_ = simulation_.steps(); }

 private:
  void check_loads() const;
  void note_status();

  std::shared_ptr<const LoadedRobot> robot_;
  sim::Simulation simulation_;
  sim::Observables observables_;
  std::shared_ptr<AttachedController> controller_;
  struct Flagged {
    std::int64_t steps = 0;
    double first = 0.0;  // s
    bool warned = false;
  };
  std::map<run::StepStatus, Flagged> flagged_;  // since the last reset
  struct Told {
    double largest = 0.0;  // Pa
    bool warned = false;
  };
  std::map<std::string, Told> pressures_;  // by attribute
  std::set<std::string> told_laws_;        // by place; since the last reset
  std::atomic<std::int64_t> steps_{0};
  mutable std::atomic<bool> busy_{false};
  std::set<std::string> told_of_cables_;  // kinds of notices and places
};

}  // namespace sinew::python
