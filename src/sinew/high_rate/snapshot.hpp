/// @file
/// The linear equations of a robot at one state, as a value for a high-rate loop.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::sim {
class Simulation;
}

namespace sinew::high_rate {

struct HighRateSettings;

/// Linear model of a robot. Near one state, motions follow from efforts by
///   delta = free + W lambda.
/// Rows are ordered as in HighRateSettings. Everything else on the robot (joints, springs,
/// actuators that obey commands, friction of cables) keeps its state and is part of W. A contact
/// has a normal and two tangents, with the signs of docs/conventions.md.
struct Snapshot {
  double time = 0.0;             ///< s, simulation time
  MatrixX compliance;            ///< W (rows, rows), m/N
  VectorX free;                  ///< (rows,) m, motions without efforts of these rows
  VectorX effort;                ///< (rows,) N, at the linearisation
  std::vector<double> friction;  ///< (contacts,) Coulomb's coefficients, >= 0
  double size = 1.0;             ///< m, size of the robot
  std::uint64_t number = 0;      ///< assigned by the loop; identifies the snapshot

  Eigen::Index rows() const { return free.size(); }
  int contacts() const { return static_cast<int>(friction.size()); }
};

/// Checks a snapshot. Throws Error: wrong-shape, not-finite, out-of-range, if it does not have the
/// rows of the settings, or if a row of a hand or contact does not yield to its own effort.
void check(const Snapshot& snapshot, const HighRateSettings& settings);

/// Names of a simulation's rows in the order of HighRateSettings.
struct SnapshotRows {
  std::vector<std::string> driven, unknown;  ///< actuators
  std::vector<std::string> effectors;        ///< effectors, with all their rows
  std::vector<std::string> hands;            ///< actuators: forces along a direction
};

/// Linearises the simulation at its present state for the loop's rows: sim::linearise(), with all
/// rows outside the loop held in their states by law::Response. Contact points that carry a force
/// are taken first, then those with the smallest gap, at most `max_contacts`.
/// @param simulation is unchanged, bit for bit. @param rows names of the rows.
/// @param max_contacts >= 0.
/// @param statics W of equilibrium; false: of the scene's integrator and time step.
/// Throws Error: unknown-name, singular-matrix, wrong-actuator-type, bad-argument (an actuator
/// named twice).
Snapshot take_snapshot(sim::Simulation& simulation, const SnapshotRows& rows, int max_contacts,
                       bool statics = true);

}  // namespace sinew::high_rate
