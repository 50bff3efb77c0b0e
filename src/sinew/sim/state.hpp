/// @file
/// Everything that decides, together with the inputs, how a run goes on.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "sinew/core/state_hash.hpp"

namespace sinew::sim {

/// What was put into the energy of a run and taken out of it, J, and what its gain is judged by.
struct EnergyLedger {
  /// J: the sum of effort times change of motion of all actuators, with the effort that acted
  /// through each step; the same of loads and outside forces (gravity has its own energy); what
  /// damping, drag, the friction of cables, and friction and impacts of contacts took.
  double actuators = 0.0, outside = 0.0, dissipated = 0.0;
  double begun = 0.0;    ///< 1 from the first step that is watched; then
  double start = 0.0;    ///< energy at the start less what had been put in
  double largest = 0.0;  ///< energy since then

  double put_in() const { return actuators + outside - dissipated; }
  /// Watches anew, from the next step on.
  void restart() { begun = start = largest = 0.0; }
  bool operator==(const EnergyLedger&) const = default;
};

/// A value: copies compare, are sent and saved, and a simulation that takes one up goes on bit for
/// bit as the one it came from. Inputs (sim/inputs.hpp) are not part of it.
struct State {
  std::vector<std::vector<double>> bodies;  ///< of each, see mechanics::Body::save_state()
  std::vector<double> efforts;              ///< (rows,) N or Pa
  std::vector<double> motions;              ///< (actuators,) m or m^3
  std::vector<double> setpoints;   ///< (actuators,) m: the last commanded motion, within limits
  std::vector<double> drives;      ///< of all drives, see Drive::state_size()
  std::vector<double> loads;       ///< (loads,) factors that acted last
  std::vector<double> frames;      ///< (contact points, 3, 3) normals and tangents of the last step
  std::vector<double> points;      ///< of contacts between surfaces, see TouchingSurfaces
  std::vector<double> joints;      ///< (motions of joints,) rad or m, see JointRows
  std::vector<double> controller;  ///< memory of the attached controller; empty without one
  std::vector<double> sensors;     ///< memory of the sensors, see Sensors; empty without
  std::vector<double> estimators;  ///< memory of the estimators, see Estimators; empty without
  EnergyLedger ledger;
  double volume_ratio = 1.0;  ///< min det F
  double residual = 0.0;      ///< that the last step left, relative: controllers judge rest by it
  double last_step = 0.0;     ///< s, the last substep; 0: the integrator starts afresh
  double next_step = 0.0;     ///< s, what the next substep tries; 0: the whole step
  std::int64_t steps = 0;     ///< since the start

  bool operator==(const State&) const = default;

  /// Calls visitor(name, numbers) for every list of numbers (std::vector<double>) and every single
  /// one (double), in an order that stays; `steps` alone is neither. @param state const or not.
  /// @param visitor takes both kinds.
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
    visitor("watched", state.ledger.begun);
    visitor("energy at the start", state.ledger.start);
    visitor("largest energy", state.ledger.largest);
    visitor("volume ratio", state.volume_ratio);
    visitor("residual", state.residual);
    visitor("last step", state.last_step);
    visitor("next step", state.next_step);
    visitor("sensors", state.sensors);
    visitor("estimators", state.estimators);
  }

  /// Over all numbers by their bits, and the count of steps: equal runs have equal hashes.
  std::uint64_t hash() const {
    StateHash sum;
    visit(*this, [&](std::string_view, const auto& numbers) { sum.add(numbers); });
    sum.add(static_cast<std::uint64_t>(steps));
    return sum.value();
  }
  /// How many numbers it has.
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

}  // namespace sinew::sim
