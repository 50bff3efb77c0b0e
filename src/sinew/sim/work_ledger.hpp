/// @file
/// Energy balance of a run.
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

/// Sums the work of actuators, loads and moving surfaces and the energy dissipated by damping,
/// friction and contacts, step by step, and checks whether the energy of the bodies grows by more.
class WorkLedger {
 public:
  /// Sums since the start, J.
  const EnergyLedger& sums() const { return sums_; }
  void set(const EnergyLedger& sums) { sums_ = sums; }
  /// Adds the contributions of a step. Call after its actuators were read.
  /// @param model,world,actuation of the run at the end of the step.
  /// @param effort (rows,) N or Pa, which acted through the step.
  void count(const Model& model, const World& world, const Actuation& actuation,
             std::span<const double> effort);

  /// Adds an impact. @param lost J, dissipated. @param outside J, work of moving surfaces.
  void count_impact(double lost, double outside) {
    sums_.dissipated += lost;
    sums_.outside += outside;
  }

  /// Adds work on the bodies from outside a step. @param work J.
  void count_outside(double work) { sums_.outside += work; }

  /// Starts monitoring. Call before the first step, so that its gain counts, too.
  void open(const mechanics::Energies& now);
  bool is_open() const { return sums_.begun != 0.0; }
  /// Restarts the monitoring with the next step.
  void restart() { sums_.restart(); }
  /// J: growth of the stored energy beyond the work done since open().
  double gained(const mechanics::Energies& now);
  /// Whether a gain exceeds what the integrator may cause. @param gain J, from gained().
  /// @param nothing J: smaller gains are rounding.
  bool is_excessive(double gain, double nothing) const;

 private:
  void count_contacts(const Model& model, const World& world, std::span<const double> effort);

  EnergyLedger sums_;
};

}  // namespace sinew::sim
