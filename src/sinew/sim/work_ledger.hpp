/// @file
/// What was put into the energy of a run and taken out of it.
#pragma once

#include <span>

#include "sinew/sim/state.hpp"

namespace sinew::mechanics {
struct Energies;
}

namespace sinew::sim {

class Actuation;
class Model;
class World;

/// Counts the work of actuators, loads, friction and contacts step by step, and watches whether the
/// bodies gain more energy than that.
class WorkLedger {
 public:
  /// J, since the start.
  const EnergyLedger& sums() const { return sums_; }
  void set(const EnergyLedger& sums) { sums_ = sums; }
  /// After the actuators of a step were read: what it came to.
  /// @param model,world,actuation of the run, as the step left them.
  /// @param effort (rows,) N or Pa, that acted through it.
  void count(const Model& model, const World& world, const Actuation& actuation,
             std::span<const double> effort);

  /// An impact. @param lost J. @param outside J, the work of surfaces that move.
  void count_impact(double lost, double outside) {
    sums_.dissipated += lost;
    sums_.outside += outside;
  }

  /// Before the first step that is watched, so that its own gain counts.
  void open(const mechanics::Energies& now);
  bool is_open() const { return sums_.begun != 0.0; }
  /// Watches anew, from the next step on.
  void restart() { sums_.restart(); }
  /// J: stored energy against what was put in since open().
  double gained(const mechanics::Energies& now);
  /// Whether a gain is more than the integrator's. @param gain J, of gained(). @param nothing J:
  /// less than this is rounding.
  bool is_excessive(double gain, double nothing) const;

 private:
  void count_contacts(const Model& model, const World& world, std::span<const double> effort);

  EnergyLedger sums_;
};

}  // namespace sinew::sim
