/// @file
/// A running robot: model, state, commands, and the step.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sinew/sim/contact_state.hpp"
#include "sinew/sim/inputs.hpp"
#include "sinew/sim/newton_status.hpp"
#include "sinew/sim/stages.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/static_settings.hpp"
#include "sinew/sim/step_status.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::fem {
class FemBody;
}
namespace sinew::qp {
struct ConeResult;
}

namespace sinew::sim {

using step::LawStatus;

struct NewtonReport;
struct NewtonSettings;

/// J; gravity's from the height at rest.
struct Energies {
  double strain = 0.0, kinetic = 0.0, gravity = 0.0;
};

/// What a step did.
struct StepReport {
  StepStatus status = StepStatus::solved;
  LawStatus law = LawStatus::solved;
  double residual = 0.0;           ///< N, |p - f - ... + H^T lambda| at the end of the step
  double relative_residual = 0.0;  ///< of the sum of the forces' norms
  double violation = 0.0;          ///< m, of the law by the motion at the end
  int iterations = 1;              ///< linear solutions, of the last substep
  int substeps = 1;                ///< that the step was made of
  int retries = 0;                 ///< substeps that were taken back and tried smaller
  double error = 0.0;              ///< m, largest estimate of a substep's error in any coordinate
  double scale = 1.0;  ///< of the motion; < 1 when it was cut back to keep elements from inverting
  double energy_gained = 0.0;  ///< J, since the start: energy beyond what was put in, if > 0
  double smallest_volume_ratio = 1.0;  ///< min det F at the end of the step
  double contact_residual = 0.0;       ///< relative, see qp::ConeResult; 0 without contacts
  int contact_sweeps = 0;              ///< of Gauss-Seidel, in the last solution of the law
  NewtonStatus newton = NewtonStatus::converged;
  StageTimes times;
};

struct PathSettings {
  double first_step = 0.01;    ///< largest motion of any coordinate in it, of the robot's size
  double largest_step = 0.05;  ///< the same of every later one
  double tolerance = 1e-9;     ///< residual relative to the loads
  int max_points = 500;
};

/// An equilibrium on the way to the full load.
struct PathPoint {
  double share = 0.0;       ///< of the loads and efforts, 0 at the start, 1 at the end
  int negative_pivots = 0;  ///< directions in which it is unstable
};

/// One run of a model. Not thread-safe itself; any number may run side by side in threads.
class Simulation {
 public:
  /// @param model shared. @param threads inside a step, >= 1. Throws Error(out-of-range).
  explicit Simulation(std::shared_ptr<const Model> model, int threads = 1);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const Model& model() const { return *model_; }
  std::shared_ptr<const Model> shared_model() const { return model_; }
  int threads() const { return pool_->size(); }
  /// Parts of the steps' work that thread 0 .. threads()-1 has done so far.
  long work_done(int thread) const { return pool_->parts_done(thread); }
  double time() const { return static_cast<double>(steps_) * model_->step().time_step; }  ///< s
  std::int64_t steps() const { return steps_; }

  /// Advances one time step. Throws Error(diverged | inverted-in-run | singular-matrix |
  /// not-converged) with the step, the body and the likely cause; the state is then that before the
  /// step.
  const StepReport& step();
  const StepReport& report() const { return report_; }
  /// Of all bodies now. Evaluates their elements.
  Energies energies();
  /// J: what all actuators have done on the bodies in steps since the start or reset(), the sum of
  /// effort times change of motion, with the effort that acted through each step.
  double actuator_work() const { return ledger_.actuators; }
  /// The same of loads and outside forces (gravity has its own energy), and what damping, drag and
  /// the friction of cables, and friction and impacts of contacts took.
  double outside_work() const { return ledger_.outside; }
  double dissipation() const { return ledger_.dissipated; }

  /// A stable static equilibrium at the present inputs: commands at the present time, limits on
  /// rates lifted, actuators of a controller held at their efforts; see StaticSolver. Velocities
  /// become zero; time stands still. Friction of contacts is that of one slow motion from the
  /// present state.
  /// Throws Error(not-converged) and restores the state when there is none to be found.
  StaticReport solve_static(const StaticSettings& settings = {});

  /// Equilibria from the present one to that of the present loads' factors and commanded efforts,
  /// all growing in proportion from what acted last (nothing, at the start): through limit points
  /// and back, stable or not. Velocities become zero; time stands still. The last point lies at the
  /// full load or just beyond; solve_static() finds that of the load itself from there.
  /// @param settings see there. @param visit called at every point.
  /// Throws Error(bad-argument) where an actuator is told a motion, has a drive or friction;
  /// Error(not-in-this-version) with contacts; Error(not-converged), the state then being that of
  /// the start.
  std::vector<PathPoint> follow_path(const PathSettings& settings,
                                     const std::function<void()>& visit = {});

  /// Back to the start, bit for bit: state, time, commands of the model. Controllers stay attached.
  void reset();

  /// Tells an actuator what to do. Throws Error(actuator-owned) while a controller has it.
  void command(int actuator, Command command);
  const ActuatorState& actuator(int index) const {
    return actuators_[static_cast<std::size_t>(index)];
  }
  /// Moves a body's fixed nodes in the next step: turned about `centre` by a rotation vector and
  /// then shifted, from rest. An input, as commands are: where the nodes then are is state.
  /// @param translation (3,) m. @param rotation (3,) rad. @param centre (3,) m, at rest.
  /// Throws Error: wrong-type (no finite elements), nothing-fixed, not-finite, bad-argument where
  /// the model moves this base.
  void move_base(int body, const Vector3& translation, const Vector3& rotation,
                 const Vector3& centre);
  /// A load's factor from the next step on.
  void set_load(int load, Signal factor);
  const Signal& load_factor(int load) const {
    return load_factors_[static_cast<std::size_t>(load)];
  }
  /// Position (3,) m, or rotation vector (3,) rad, of an effector.
  Vector3 effector_value(int index) const;
  /// (components,) what a probe measures now, m and rad. @param index of Model::probes().
  std::vector<double> probe_values(int index) const;

  /// What the points of a contact do, see Model::contact().
  /// @param index of Model::contacts(). @param point of constraint::Contact::points().
  ContactPoint contact_point(int index, std::size_t point) const;
  std::vector<ContactPoint> contact_points(int index) const;
  ContactSum contact_sum(int index) const;
  /// The points and where the surface stands.
  ContactMoment contact_moment(int index) const;
  /// How the contacts' forces were last found.
  const qp::ConeResult& contact_result() const;

  /// Gives a controller the actuators that it chooses efforts for, in every step until it is
  /// detached. One controller at a time. Throws Error(actuator-owned).
  void attach(step::Controller& controller, std::span<const int> actuators);
  void detach(const step::Controller& controller);
  const step::Controller* attached_controller() const { return controller_; }

  World& world() { return world_; }
  const World& world() const { return world_; }
  /// Throws Error(wrong-type) when the body is of another kind.
  fem::FemBody& fem_body(int index);
  const fem::FemBody& fem_body(int index) const;
  std::span<const double> efforts() const { return effort_; }  ///< (rows,) N or Pa
  /// The numbers of an actuator's drive (see Drive); empty without one.
  std::span<const double> drive_state(int actuator) const;
  /// What actuators were allowed and told in the last step.
  std::span<const step::ActuatorBlock> actuator_blocks() const {
    return world_.problem().actuators;
  }

  /// Everything that decides, with the inputs, how the run goes on.
  State state() const;
  /// Takes up a state, of this simulation or of another one of the same model. A controller takes
  /// up its memory where the state has it; otherwise it begins anew. Commands stay as they are.
  /// Throws Error(wrong-length) for a state of another model, and is then unchanged.
  void restore(const State& state);
  /// What acts from outside: commands, load factors, forces, tethers, and where bases are asked to
  /// be.
  Inputs inputs() const;
  /// Throws Error(wrong-length) for inputs of another model, and is then unchanged.
  void set_inputs(const Inputs& inputs);
  /// A simulation of the same model, with the same inputs, in the same state. A controller is not
  /// copied: attach one to the copy, and restore() the state again for its memory.
  std::unique_ptr<Simulation> clone() const;
  std::uint64_t state_hash() const { return state().hash(); }
  /// Bytes that one more simulation of the same model takes.
  std::size_t bytes() const;

 private:
  void keep(State& state) const;
  void read_commands(double time, double time_step);
  std::span<double> drive_numbers(std::size_t actuator);
  void advance_drives();
  mechanics::StepWeights step_weights(double time_step) const;
  double substep(double end, double time_step);
  void move_bases(double time);
  void set_loads(double time);
  void apply_load(std::size_t load, double factor);
  void set_share(double share);
  void plan_path();
  void imbalance_at(double share, VectorX& imbalance);
  int step_path(double length, double& share, VectorX& direction, double tolerance);
  void count_work();
  void count_contact_work();
  void step_adaptively();
  void step_in_parts();
  NewtonSettings newton_settings(double time_step) const;
  NewtonSettings settings_of_part(double time_step) const;
  void solve_equation(double time_step);
  void step_once(double time_step);
  void step_newton(double time_step);
  NewtonReport newton(step::Controller* controller, const NewtonSettings& settings);
  bool is_usable(const NewtonReport& result) const;
  NewtonReport stay(double time_step);
  void blend_commands(std::span<const step::ActuatorBlock> goal,
                      std::span<const ActuatorState> start, double fraction);
  NewtonReport approach(double time_step);
  NewtonReport descend(double time_step, int iterations);
  void hold_efforts();
  [[noreturn]] void fail_law();
  void take_report(const NewtonReport& result);
  bool balanced() const;
  void watch();
  void open_ledger();
  void watch_energy();
  void move_soundly();
  void require_outside();
  void finish_step();
  [[noreturn]] void fail(ErrorKind kind, const std::string& message, const std::string& remedy);
  [[noreturn]] void fail_contacts();

  friend class StaticSolver;

  std::shared_ptr<const Model> model_;
  std::unique_ptr<ThreadPool> pool_;
  World world_;
  std::unique_ptr<step::StepSolver> solver_;
  step::Controller* controller_ = nullptr;
  std::vector<ActuatorState> actuators_;
  std::vector<double> effort_;
  std::vector<double> drive_state_;  // of all drives, at the start of the step
  State state_before_;               // before the substep
  State state_at_step_;              // before the whole step, where that is made in parts
  double step_before_ = 0.0;         // s, the last substep; 0: the integrator starts afresh
  double substep_ = 0.0;             // s, adaptive: what the next one tries
  double now_ = 0.0;                 // s, end of the substep in hand
  // Commands of a step that is made in parts go there in proportion.
  struct Part {
    double fraction = 1.0;             // of the step, at the end of the part
    std::vector<ActuatorState> start;  // of the step
  };
  std::optional<Part> part_;
  std::vector<double> motion_before_;  // (actuators,) m
  std::vector<Signal> load_factors_;
  std::vector<double> load_applied_;  // (loads,) factors that acted last; 0 at the start
  struct Stretch {
    double from = 0.0, to = 0.0;
  };
  std::vector<Stretch> path_loads_, path_efforts_;
  EnergyLedger ledger_;
  std::int64_t steps_ = 0;
  double volume_ratio_ = 1.0;
  StepReport report_;
  StageTimes times_;
  StageClock clock_{times_};
};

}  // namespace sinew::sim
