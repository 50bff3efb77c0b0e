/// @file
/// A simulation as Python holds it: the robot it came from, the simulation, the controller attached
/// to it, and a guard against use from two threads at once.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sinew/inverse/target_controller.hpp"
#include "sinew/mechanics/tangent.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"

namespace sinew::python {

/// A controller and the name that it has in the scene; empty for one made from Python.
struct AttachedController {
  std::string name;
  std::unique_ptr<inverse::TargetController> law;
  bool attached = true;
};

/// A scene made ready, and the folder that its relative paths start from.
struct LoadedRobot {
  scene::Robot robot;
  std::filesystem::path folder;
};

/// The tangent of that name. Throws Error(unknown-choice) for any other word.
/// @param argument as "linearise(tangent)".
mechanics::Tangent to_tangent(const std::string& word, const std::string& argument);

/// A state of a simulation of this process, or the bytes of one (sim/state_io.hpp).
class SavedState {
 public:
  explicit SavedState(std::string bytes) : bytes_(std::move(bytes)) {}
  SavedState(std::shared_ptr<const sim::State> state, std::shared_ptr<const sim::Model> model)
      : state_(std::move(state)), model_(std::move(model)) {}

  /// Of a state of this process made when they are first asked for, with the interpreter's lock:
  /// most states are only restored.
  const std::string& bytes() const;
  /// Null where only bytes are known, or the model is another one.
  const sim::State* of(const sim::Model& model) const;
  /// Throws Error(state-corrupt), Error(state-version).
  std::int64_t steps() const;

 private:
  mutable std::string bytes_;  // empty: not made yet
  std::shared_ptr<const sim::State> state_;
  std::shared_ptr<const sim::Model> model_;
};

/// See the file.
class Session {
 public:
  /// Attaches the scene's first controller.
  /// @param robot shared with clones. @param threads inside a step.
  Session(std::shared_ptr<const LoadedRobot> robot, int threads);

  /// Exclusive use for as long as it lives. Throws SimulationBusy when another thread has it.
  class Use {
   public:
    explicit Use(const Session& session);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    const Session& session_;
  };

  /// Another simulation of the same robot at the same state, commands and controller included.
  std::shared_ptr<Session> clone() const;

  const LoadedRobot& robot() const { return *robot_; }
  const sim::Model& model() const { return simulation_.model(); }
  /// Only while a Use is held.
  sim::Simulation& simulation() { return simulation_; }
  const sim::Simulation& simulation() const { return simulation_; }
  /// Their ledger counts from the start. Only while a Use is held.
  sim::Observables& observables() { return observables_; }

  /// May be asked at any time, from any thread.
  bool busy() const { return busy_.load(std::memory_order_acquire); }
  std::int64_t steps() const { return steps_.load(std::memory_order_relaxed); }
  double time() const { return static_cast<double>(steps()) * model().step().time_step; }

  /// Advances `count` steps without the interpreter's lock; looks for Ctrl-C now and then, within
  /// steps, too, as the searches below do: the state is then that of the last step. Warns
  /// (sinew.SinewWarning) of flagged steps, of each status once until the next reset. Throws
  /// what sim::Simulation::step() does, and Error(not-finite) for external forces that are not.
  void advance(std::int64_t count);
  /// The same by any thread that does not hold the interpreter's lock, without looking for Ctrl-C
  /// or warning. @param ended asked after each step; true: it is the last one.
  void advance_unlocked(std::int64_t count, const std::function<bool()>& ended);
  /// Of flagged steps; see advance().
  void warn();
  sim::StaticReport solve_static(const sim::StaticSettings& settings);
  /// @param visit is called without the interpreter's lock.
  std::vector<sim::PathPoint> follow_path(const sim::PathSettings& settings,
                                          const std::function<void()>& visit);
  /// Simulation::reset(), and external forces set to zero.
  void reset();
  SavedState state() const;
  /// Throws as sim::parse_state().
  void restore(const SavedState& state);
  /// sim::load_state() and sim::save_state().
  void load_state(const std::filesystem::path& path);
  void save_state(const std::filesystem::path& path) const;

  sim::Linearisation linearise(const sim::LinearisationChoice& choice);
  sim::Linearisation last_linearisation();

  /// Null when there is none.
  const std::shared_ptr<AttachedController>& controller() const { return controller_; }
  /// Attaches. Throws Error(actuator-owned) while another one is.
  std::shared_ptr<AttachedController> attach(inverse::InverseSettings settings, std::string name);
  /// Detaches `controller` if it is attached.
  void detach(AttachedController& controller);

  /// For whoever steps the simulation while it holds a Use: detaches the controller, which Python
  /// goes on to see as attached, and tells its settings; none without one.
  std::optional<inverse::InverseSettings> lend_controller();
  /// What came of it: null, or the controller that is attached now.
  /// @param same whether it is the one that was lent. @param name of another one.
  void take_back(bool same, const std::string& name,
                 std::unique_ptr<inverse::TargetController> law);
  /// After others have stepped.
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
  std::map<sim::StepStatus, Flagged> flagged_;  // since the last reset
  std::atomic<std::int64_t> steps_{0};
  mutable std::atomic<bool> busy_{false};
};

}  // namespace sinew::python
