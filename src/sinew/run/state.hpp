/// @file
/// The state of a run: with the inputs, it determines how the run continues.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "sinew/core/state_hash.hpp"

namespace sinew::run {

/// The work done on the bodies of a run and the energy dissipated, J, with reference values to
/// detect spurious gains of energy.
struct EnergyLedger {
  /// J: work of all actuators, by the quadrature of the integrator (Quadrature); likewise of loads,
  /// external forces and moving surfaces (gravity counts as stored energy), and of changes of
  /// stiffness factors; energy dissipated by damping, drag, cable friction, contact friction and
  /// impacts.
  double actuators = 0.0, outside = 0.0, dissipated = 0.0;
  double power = 0.0;    ///< W, of loads and external forces at the end of the last step
  double damping = 0.0;  ///< W, dissipated by damping and drag at the end of the last step
  double begun = 0.0;    ///< 1 once gains are monitored, see WorkLedger::open()
  double start = 0.0;    ///< J, stored energy less put_in() when monitoring began
  double largest = 0.0;  ///< J, largest strain plus kinetic energy since then
  double through = 0.0;  ///< J, sum of the sizes of all work in the present window
  double settled = 0.0;  ///< J, what was gained before the present window
  double gained = 0.0;   ///< J, excess of gain over what the integrator may cause, one step ago
  /// J: dissipation by damping and drag since then that `dissipated` counts beyond that of the
  /// damping force at the end of each step in its motion, see WorkLedger::gained().
  double doubtful = 0.0;

  double put_in() const { return actuators + outside - dissipated; }
  /// Restarts the monitoring with the next step.
  void restart() { begun = start = largest = through = settled = gained = doubtful = 0.0; }
  bool operator==(const EnergyLedger&) const = default;
};

/// The state as a value: it can be copied, compared, sent and saved. A simulation that restores it
/// continues bit for bit like the original. Inputs (run/inputs.hpp) are not part of it.
struct State {
  std::vector<std::vector<double>> bodies;  ///< of each body, see mechanics::Body::save_state()
  std::vector<double> efforts;              ///< (rows,) N or Pa
  std::vector<double> motions;              ///< (actuators,) m or m^3
  std::vector<double> setpoints;   ///< (actuators,) m: the last commanded motion, within limits
  std::vector<double> drives;      ///< state variables of all drives, see Drive::state_size()
  std::vector<double> loads;       ///< (loads,) factors applied last
  std::vector<double> frames;      ///< (contact points, 3, 3) normals and tangents of the last step
  std::vector<double> points;      ///< of contacts between bodies, see TouchingSurfaces
  std::vector<double> joints;      ///< (motions of joints,) rad or m, see JointRows
  std::vector<double> controller;  ///< memory of the attached controller; empty without one
  /// Memory of each instrument, see Instruments::save(); empty without any, and in states between
  /// which a step goes back and forth.
  std::vector<std::vector<double>> instruments;
  /// (bodies,) see Bodies::afresh(); empty if all start afresh, as `last_step` tells, or none.
  std::vector<double> afresh;
  std::vector<double> correction;    ///< see MeasuredCorrection; empty: none
  std::vector<double> kept_factors;  ///< see KeptFactors; empty: nothing is known
  std::vector<double> end_efforts;   ///< see EndEfforts; empty: those of the step's equation
  EnergyLedger ledger;
  double volume_ratio = 1.0;  ///< min det F
  double failed = 0.0;        ///< 1 if it descends from a failed step, see is_failure()
  double residual = 0.0;      ///< relative residual of the last step; controllers detect rest by it
  double last_step = 0.0;     ///< s, length of the last substep; 0: the integrator starts afresh
  double next_step = 0.0;     ///< s, length to try for the next substep; 0: the whole step
  std::int64_t steps = 0;     ///< since the start

  bool operator==(const State&) const = default;

  /// Calls visitor(name, numbers) for every list (std::vector<double>) and scalar (double) of the
  /// state, in a fixed order; `steps`, an integer, is not visited. @param state const or not.
  /// @param visitor accepts both types.
  template <class Self, class Visitor>
  static void visit(Self& state, Visitor&& visitor) {
    for (auto& body : state.bodies) visitor("body", body);
    visitor("efforts", state.efforts);
    visitor("motions", state.motions);
    visitor("setpoints", state.setpoints);
    visitor("drives", state.drives);
    visitor("loads", state.loads);
    visitor("frames", state.frames);
    visitor("points", state.points);
    visitor("joints", state.joints);
    visitor("controller", state.controller);
    visitor("actuators' work", state.ledger.actuators);
    visitor("outside work", state.ledger.outside);
    visitor("dissipation", state.ledger.dissipated);
    visitor("outside power", state.ledger.power);
    visitor("damping power", state.ledger.damping);
    visitor("watched", state.ledger.begun);
    visitor("energy at the start", state.ledger.start);
    visitor("largest energy", state.ledger.largest);
    visitor("energy through", state.ledger.through);
    visitor("energy settled", state.ledger.settled);
    visitor("energy gained", state.ledger.gained);
    visitor("doubtful dissipation", state.ledger.doubtful);
    visitor("volume ratio", state.volume_ratio);
    visitor("residual", state.residual);
    visitor("last step", state.last_step);
    visitor("next step", state.next_step);
    for (auto& memory : state.instruments) visitor("instrument", memory);
    visitor("failure", state.failed);
    visitor("afresh", state.afresh);
    visitor("correction", state.correction);
    visitor("kept factors", state.kept_factors);
    visitor("end efforts", state.end_efforts);
  }

  /// Hash of the bits of all numbers and the count of steps: equal states have equal hashes.
  std::uint64_t hash() const {
    StateHash sum;
    visit(*this, [&](std::string_view, const auto& numbers) { sum.add(numbers); });
    sum.add(static_cast<std::uint64_t>(steps));
    return sum.value();
  }
  /// Number of doubles in the state.
  std::size_t size() const {
    std::size_t sum = 0;
    const auto count = [](const auto& numbers) -> std::size_t {
      if constexpr (requires { numbers.size(); }) return numbers.size();
      return 1;
    };
    visit(*this, [&](std::string_view, const auto& numbers) { sum += count(numbers); });
    return sum;
  }
};

}  // namespace sinew::run
