/// @file
/// The list of all quantities that can be observed in a run. Tables, recordings, Python's arrays,
/// plots and the view all take their values from it.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/law/drive.hpp"
#include "sinew/run/observable.hpp"

namespace sinew::model {
struct ActuatorModel;
}

namespace sinew::sim {

class Simulation;

/// The observables of one simulation and their values. Observables may share a reading, which is
/// evaluated at most once per time, and only if one of them is read. Reading allocates nothing.
///
///     Observables list(simulation);
///     simulation.step();
///     list.refresh();
///     list.read(list.find("tip.position"))   // (3,) m
class Observables {
 public:
  /// Returns the values of all observables that share a reading, concatenated. They stay at the
  /// same address until the next reading.
  using Read = std::function<std::span<const double>()>;
  /// Writes these values.
  using Fill = std::function<void(std::span<double>)>;

  /// Lists the standard observables in the order of ObservableKind:
  /// - `time`, s.
  /// - Body: `NAME.positions` (n, 3) m and, in dynamics, `NAME.velocities` (n, 3) m/s. Rigid body:
  ///   also `NAME.position` (3,) m and `NAME.rotation` (4,) w, x, y, z of its frame,
  ///   `NAME.velocity` (3,) m/s of its centre of mass, `NAME.angular_velocity` (3,) rad/s. Arm:
  ///   also `NAME.coordinates` (c,) rad and, in dynamics, `NAME.rates` (c,) rad/s; extensions in m
  ///   and m/s.
  /// - Actuator: effort and motion, such as `NAME.tension` and `NAME.displacement`, and its
  ///   commands, see commanded().
  /// - Effector: `NAME.position` (3,) m or `NAME.rotation` (3,) rad.
  /// - Probe: `NAME.value`; of a line also `NAME.positions` (k, 3) m.
  /// - Sensor: `NAME.measured`, `NAME.true`, and the time `NAME.sample_time`, s, when the former
  ///   was taken (NaN before the first sample).
  /// - Contact of n points: `NAME.pose` (3, 4), `NAME.points.position` (n, 3) m, `.gap` (n,) m,
  ///   `.normal` (n, 3), `.normal_force` (n,) N, `.friction_force` (n, 3) N, `.state` (n,). Points
  ///   that the step did not find have a position, gap and normal of NaN.
  /// - Resultant of a contact: `NAME.force` (3,) N, `NAME.normal_force` and `NAME.friction_force`
  ///   N, `NAME.gap` m, `NAME.gap_above` m (see ContactGap), `NAME.sticking`, `NAME.slipping`.
  /// - Joint: `NAME.force` (3,) N and `NAME.moment` (3,) N m (see JointLoad), `NAME.gap` m, and, if
  ///   free, `NAME.angle` rad and `NAME.displacement` m.
  /// - Estimator: for each unknown force `NAME.UNKNOWN` (3,) N and its standard deviation
  ///   `NAME.UNKNOWN.std` (3,) N, for each unknown effort the same as scalars; `NAME.status`.
  /// - Energies, J: `strain_energy`, `kinetic_energy`, `gravity_energy`, `actuator_work`,
  ///   `outside_work`, `dissipation`, `numerical_loss`.
  /// - Report: `residual` N, `relative_residual`, `distance` m (StepReport), `iterations`,
  ///   `substeps`, `scale`, `smallest_volume_ratio`, `snapped` (0 or 1); with contacts
  ///   `contact_residual`, `contact_signorini` m and `contact_coulomb` m; with zones
  ///   `contact_aggregation`; `status`.
  /// - Times of the computation, s: `time.step`, and `time.STAGE` for each stage.
  /// @param simulation must outlive the list.
  explicit Observables(Simulation& simulation);
  Observables(const Observables&) = delete;
  Observables& operator=(const Observables&) = delete;
  Observables(Observables&&) noexcept = default;
  Observables& operator=(Observables&&) noexcept = default;

  Simulation& simulation() const { return *simulation_; }
  const std::vector<run::Observable>& list() const { return list_; }

  /// Adds observables that share a reading, each after the last one of its kind; indices of later
  /// observables change.
  /// @param parts in the order in which `fill` writes them. @param fill writes their values.
  void add(std::vector<run::Observable> parts, Fill fill);
  /// The same for values that are stored elsewhere. @param parts in the order of the values.
  /// @param read returns the stored values.
  void add_view(std::vector<run::Observable> parts, Read read);

  /// Index of an observable in list(); if an actuator and a contact share a name, the first one. A
  /// link that is part of a body (Model::body_names()) stands for the body. Throws
  /// Error(unknown-name) with a suggestion.
  /// @param name of an observable. @param asked source location of the request, for errors.
  std::size_t find(std::string_view name, const Location& asked = {}) const;

  /// Invalidates all readings, since the simulation has changed.
  void refresh();
  /// (size(),) row by row; valid until refresh(). @param index in list().
  std::span<const double> read(std::size_t index);
  /// The value of a scalar observable, or the first component. @param index in list().
  double number(std::size_t index) { return read(index).front(); }
  /// The present word of a status. @param index in list().
  std::string_view word(std::size_t index) { return list_[index].word(number(index)); }

  /// Replaces the values of an observable, such as by those of a recording, until release(). Throws
  /// Error(wrong-length). @param index in list(). @param numbers (size(),).
  void hold(std::size_t index, std::span<const double> numbers);
  /// Undoes all calls of hold().
  void release();

 private:
  struct Source {
    Read read;
    std::span<const double> numbers;
    bool fresh = false;
  };
  struct Entry {
    std::size_t source = 0, offset = 0;
    std::vector<double> held;  // empty: the value of the simulation
  };

  void sort();
  std::string with_body(std::string_view name) const;

  Simulation* simulation_;
  bool gathering_ = false;  // whether the list is sorted later
  std::vector<run::Observable> list_;
  std::vector<Entry> entries_;  // of each observable
  std::vector<Source> sources_;
};

/// The present command of an actuator's quantity, in the quantity's unit, before limits apply; NaN
/// while another quantity is commanded. For an actuator owned by a controller, the effort is the
/// one chosen for the last step.
/// @param simulation,actuator which. @param kind of the quantity.
double commanded(const Simulation& simulation, int actuator, law::CommandKind kind);
/// The kinds of commands that an actuator accepts; none for a passive spring.
std::vector<law::CommandKind> command_kinds(const model::ActuatorModel& actuator);
/// The name of the observable of a command: "long_0.displacement_command".
std::string command_name(const model::ActuatorModel& actuator, law::CommandKind kind);

}  // namespace sinew::sim
