/// @file
/// What a high-rate loop knows of a robot: its linear equations at one state, as a value.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::sim {
class Simulation;
}

namespace sinew::control {

struct HighRateSettings;

/// Near one state, motions follow from efforts by
///   delta = free + W lambda.
/// Rows stand as in HighRateSettings; whatever else the robot has (joints, springs, actuators that
/// obey commands, friction of cables) keeps the state that it had and is part of W. A contact has a
/// normal and two tangents, in the sense of docs/conventions.md.
struct Snapshot {
  double time = 0.0;             ///< s, of the model
  MatrixX compliance;            ///< W (rows, rows), m/N
  VectorX free;                  ///< (rows,) m, without efforts of these rows
  VectorX effort;                ///< (rows,) N, at the linearisation
  std::vector<double> friction;  ///< (contacts,) Coulomb's coefficients, >= 0
  double size = 1.0;             ///< m, of the robot: what motions are small beside
  std::uint64_t number = 0;      ///< counted by the loop; another number is another snapshot

  Eigen::Index rows() const { return free.size(); }
  int contacts() const { return static_cast<int>(friction.size()); }
};

/// Throws Error(wrong-shape | not-finite | out-of-range) for a snapshot that does not have the rows
/// of the settings, or in which a hand's or a contact's row does not yield to its own effort.
void check(const Snapshot& snapshot, const HighRateSettings& settings);

/// Names of a simulation's rows in the order of HighRateSettings.
struct SnapshotRows {
  std::vector<std::string> driven, unknown;  ///< actuators
  std::vector<std::string> effectors;        ///< all rows of each
  std::vector<std::string> hands;            ///< actuators that push: forces along a direction
};

/// How the loop's rows answer at the present state, which is left as it is: sim::linearise() with
/// everything that has no part in the loop held by step::Response. Of contact points those take
/// part that carry a force, then those with the least gap, at most `max_contacts`.
/// @param simulation stays as it is, bit for bit. @param rows see there. @param max_contacts >= 0.
/// @param statics W of equilibrium; false: of the scene's integrator and time step.
/// Throws Error(unknown-name | singular-matrix | wrong-actuator-type).
Snapshot take_snapshot(sim::Simulation& simulation, const SnapshotRows& rows, int max_contacts,
                       bool statics = true);

}  // namespace sinew::control
