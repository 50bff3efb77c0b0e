/// @file
/// Energy balance of a run.
#pragma once

#include <span>

#include "sinew/run/state.hpp"

namespace sinew::mechanics {
struct Energies;
}

namespace sinew::model {
class Model;
}

namespace sinew::world {
class World;
}

namespace sinew::run {

class Actuation;

/// How the work of a force that acts through a step is computed.
///
/// Backward Euler and the midpoint rule have exact balances with the one force that they evaluate,
///   E_1 - E_0 <= f_1 . d  (the difference is |v_1 - v_0|^2_M / 2 for a convex potential)
///   E_1 - E_0  = f_m . d  (quadratic potential; Hairer, Lubich & Wanner 2006, VI.4),
/// so their work is that of this force. Formulas of second order that reach back balance
///   E_1 - E_0 = (f_0 + f_1)/2 . d + O(h^3) = h (P_0 + P_1)/2 + O(h^3),   P = f . v,
/// and so do successive equilibria of statics, whereas f_1 . d has the error h^2 f'.v/2, which adds
/// up in a periodic motion with a force that changes in phase with the velocity.
enum class Quadrature { one_force, trapezoid };

/// Sums the work of actuators, loads and moving surfaces and the energy dissipated by damping,
/// friction and contacts, step by step, and checks whether the energy of the bodies grows by more.
class WorkLedger {
 public:
  /// What the ledger needs to know of a step that ended.
  struct Step {
    std::span<const double> effort_before;  ///< (rows,) N or Pa, at its start
    std::span<const double> effort;         ///< (rows,) N or Pa, at its end
    Quadrature quadrature = Quadrature::one_force;
    double length = 0.0;  ///< s
    bool dynamic = false;
  };

  /// Sums since the start, J.
  const EnergyLedger& sums() const { return sums_; }
  void set(const EnergyLedger& sums) { sums_ = sums; }
  /// Adds the contributions of a step. Call after its actuators were read.
  /// @param model,world,actuation of the run at the end of the step. @param step that ended.
  void count(const model::Model& model, const world::World& world, const Actuation& actuation,
             const Step& step);

  /// Adds an impact. @param lost J, dissipated. @param outside J, work of moving surfaces.
  void count_impact(double lost, double outside) {
    sums_.dissipated += lost;
    sums_.outside += outside;
  }

  /// Takes back dissipation of a step. @param energy J.
  void count_less_dissipation(double energy) { sums_.dissipated -= energy; }

  /// Adds work on the bodies from outside a step. @param work J.
  void count_outside(double work) { sums_.outside += work; }

  /// Starts monitoring. Call before the first step, so that its gain counts, too.
  void open(const mechanics::Energies& now);
  bool is_open() const { return sums_.begun != 0.0; }
  /// Restarts the monitoring with the next step.
  void restart() { sums_.restart(); }
  /// The same after the bodies were put to rest.
  void rest();
  /// J: growth of the stored energy beyond the work done since open(), with the smaller of two
  /// dissipations by damping C. Where velocities are smooth, the trapezoidal rule
  ///   h/2 (v_0.C v_0 + v_1.C v_1)   and   C v_1.d
  /// differ by h/4 (v_1.C v_1 - v_0.C v_0) and terms of third order, which do not add up. After a
  /// jump of an effort or a command, the velocities of a multistep formula change sign from step to
  /// step, v_1 is not d/h, and the former dissipates energy that the robot never had.
  double gained(const mechanics::Energies& now);
  /// Whether a gain exceeds what the integrator may cause: a fraction of the energy that was stored
  /// or went through. Work adds up for ever in a driven motion, and so do the integrator's errors;
  /// after some multiples of the largest stored energy, the account is therefore settled and a new
  /// window begins. The gain must have lasted for two steps: after a jump of a commanded velocity,
  /// efforts that hold it alternate, and so does their work.
  /// @param gain J, from gained(). @param nothing J: smaller gains are rounding.
  bool is_excessive(double gain, double nothing);

 private:
  void count_bodies(const world::World& world, const Step& step);
  void count_friction(const world::World& world, const Actuation& actuation, const Step& step);
  void count_contacts(const model::Model& model, const world::World& world, const Step& step);

  EnergyLedger sums_;
};

}  // namespace sinew::run
