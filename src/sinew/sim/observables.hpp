/// @file
/// Everything that can be observed of a run, as one list. Tables, recordings, Python's arrays,
/// plots and the view take their numbers from here, and none has a list of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/step/drive.hpp"

namespace sinew::sim {

struct ActuatorModel;
class Simulation;
using step::CommandKind;

/// What an observable belongs to. The list is sorted by it, in this order.
enum class ObservableKind {
  time,
  body,           ///< positions and velocities of all nodes, coordinates of an arm
  actuator,       ///< effort, motion, and what is commanded of either
  effector,       ///< position or rotation
  probe,          ///< what it measures
  sensor,         ///< what it says, and what is true
  contact_point,  ///< of every point of a contact, and the pose of its surface
  contact,        ///< of all points of a contact together
  joint,          ///< force, moment, gap and motion
  estimator,      ///< unknowns, their standard deviations, and its status
  controller,     ///< targets and errors
  energy,         ///< of all bodies; evaluates their elements
  ledger,         ///< work and losses since the first reading; evaluates the elements, too
  report,         ///< numbers of the last step
  status,         ///< a word on the last step
  timing,         ///< of the computation: differs from run to run
};

/// A word that a number stands for.
struct StatusWord {
  int code = 0;
  std::string_view word;
};

/// One thing that can be observed: a number, a vector, a table of numbers.
struct Observable {
  std::string name;                ///< "long_0.tension", "tip.position", "residual"
  std::string unit;                ///< SI; empty for counts, ratios and words
  std::vector<std::size_t> shape;  ///< of one moment; empty for a number
  ObservableKind kind = ObservableKind::report;
  std::string owner;     ///< actuator, effector, ... that it is of; empty: the whole robot
  std::string quantity;  ///< of the owner, whatever its type: "effort", "position"
  /// Names of its numbers one by one, as in a table: "tip.x", "tip.y", "tip.z"; none where they are
  /// too many for that.
  std::vector<std::string> components;
  std::vector<StatusWord> words;  ///< where its numbers stand for words

  /// How many numbers it has.
  std::size_t size() const;
  /// The word that a number stands for; empty when it stands for none.
  std::string_view word(double number) const;
};

/// What can be observed of one simulation, and its values. Several observables may share a reading,
/// which is made once for each moment, and only when one of them is asked for. Reading allocates
/// nothing.
///
///     Observables list(simulation);
///     simulation.step();
///     list.refresh();
///     list.read(list.find("tip.position"))   // (3,) m
class Observables {
 public:
  /// The numbers of all observables that share a reading, one after the other. They stay where they
  /// are until the next reading.
  using Read = std::function<std::span<const double>()>;
  /// Writes them, all at once.
  using Fill = std::function<void(std::span<double>)>;

  /// Lists, in this order: `time`; of every body `NAME.positions` (n, 3) m, in dynamics
  /// `NAME.velocities` (n, 3) m/s, of a rigid body `NAME.position` (3,) m and `NAME.rotation` (4,)
  /// w, x, y, z of its frame, `NAME.velocity` (3,) m/s of its centre of mass,
  /// `NAME.angular_velocity` (3,) rad/s, of an arm `NAME.coordinates` (c,) rad and, in dynamics,
  /// `NAME.rates` (c,) rad/s, extensions in m and m/s; of every actuator effort and motion, as
  /// `NAME.tension` and `NAME.displacement`, and its commands (see commanded()); of every effector
  /// `NAME.position` (3,) m or `NAME.rotation` (3,) rad; of every probe `NAME.value`, and of a line
  /// `NAME.positions` (k, 3) m; of every sensor `NAME.measured` and `NAME.true` and when the former
  /// was taken, `NAME.sample_time` s (NaN before the first sample); of every contact of n points
  /// `NAME.pose` (3, 4) and
  /// `NAME.points.position` (n, 3), `.gap` (n,), `.normal` (n, 3),
  /// `.normal_force` (n,), `.friction_force` (n, 3), `.state` (n,), and, of the points together,
  /// `NAME.force` (3,) N, `NAME.normal_force` and `NAME.friction_force` N, `NAME.gap` m,
  /// `NAME.sticking`, `NAME.slipping`; of every joint `NAME.force` (3,) N and `NAME.moment` (3,) N
  /// m (see JointLoad), `NAME.gap` m, `NAME.angle` rad and `NAME.displacement` m where it has them;
  /// of every estimator `NAME.UNKNOWN` (3,) N and its standard deviation `NAME.UNKNOWN.std` (3,) N
  /// for each unknown force, and `NAME.status`;
  /// `strain_energy`, `kinetic_energy`, `gravity_energy`, `actuator_work`, `outside_work`,
  /// `dissipation`, `numerical_loss` J; the report's `residual` N, `relative_residual`,
  /// `iterations`, `substeps`, `scale`, `smallest_volume_ratio`, with contacts `contact_residual`,
  /// `contact_signorini` and `contact_coulomb` m, with zones `contact_aggregation`; `status`;
  /// `time.step` and the stages' times, s.
  /// @param simulation must outlive the list.
  explicit Observables(Simulation& simulation);
  Observables(const Observables&) = delete;
  Observables& operator=(const Observables&) = delete;
  Observables(Observables&&) noexcept = default;
  Observables& operator=(Observables&&) noexcept = default;

  Simulation& simulation() const { return *simulation_; }
  const std::vector<Observable>& list() const { return list_; }

  /// Adds observables that share a reading, each after those of its kind; the places of later ones
  /// move.
  /// @param parts in the order in which `fill` writes them. @param fill writes their numbers.
  void add(std::vector<Observable> parts, Fill fill);
  /// The same of numbers that are kept elsewhere. @param parts in the order in which these stand.
  /// @param read returns where they are.
  void add_view(std::vector<Observable> parts, Read read);

  /// Where an observable is in list(): the first of that name, where an actuator and a contact have
  /// one name. Throws Error(unknown-name) with a suggestion.
  /// @param name of an observable. @param asked by whom, for the error.
  std::size_t find(std::string_view name, const Location& asked = {}) const;

  /// Begins a new moment: what was read before is no longer true.
  void refresh();
  /// (size(),) row by row; valid until refresh(). @param index in list().
  std::span<const double> read(std::size_t index);
  /// The only number of an observable, or its first. @param index in list().
  double number(std::size_t index) { return read(index).front(); }
  /// The word that a status has now. @param index in list().
  std::string_view word(std::size_t index) { return list_[index].word(number(index)); }

  /// Sets numbers in place of what the simulation says, until release(): those of a recorded
  /// moment. Throws Error(wrong-length). @param index in list(). @param numbers (size(),).
  void hold(std::size_t index, std::span<const double> numbers);
  /// Ends all that hold() did.
  void release();

 private:
  struct Source {
    Read read;
    std::span<const double> numbers;
    bool fresh = false;
  };
  struct Entry {
    std::size_t source = 0, offset = 0;
    std::vector<double> held;  // empty: as the simulation says
  };

  void sort();

  Simulation* simulation_;
  bool gathering_ = false;  // the list is sorted later
  std::vector<Observable> list_;
  std::vector<Entry> entries_;  // of each observable
  std::vector<Source> sources_;
};

/// What an actuator is told of one of its quantities now, in that quantity's unit: the value of its
/// command, before limits; NaN while another quantity is commanded. A controller commands efforts:
/// that of an actuator which it owns is the one that it chose for the last step.
/// @param simulation,actuator which. @param kind of the quantity.
double commanded(const Simulation& simulation, int actuator, CommandKind kind);
/// Kinds of commands that an actuator takes; none for a passive spring.
std::vector<CommandKind> command_kinds(const ActuatorModel& actuator);
/// The name of such an observable: "long_0.displacement_command".
std::string command_name(const ActuatorModel& actuator, CommandKind kind);

}  // namespace sinew::sim
