/// @file
/// Settings of a high-rate loop: what it senses, touches and drives, and how it works.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::high_rate {

/// A row whose effort the loop chooses: a cable, a motor, a pressure.
struct DrivenRow {
  double effort_min = -kInfinity, effort_max = kInfinity;  ///< N or Pa
  double effort_rate = kInfinity;                          ///< N/s or Pa/s, > 0
  double motion_min = -kInfinity, motion_max = kInfinity;  ///< m or m^3
  double release = 0.0;  ///< N or Pa, within the limits: effort after release
};

/// A row with an unmeasured external force.
struct UnknownRow {
  double prior = 1.0;                        ///< N, > 0: standard deviation of the prior
  double min = -kInfinity, max = kInfinity;  ///< N
};

/// A row that a hand moves: it follows the hand, with an effort within limits. A hand that pushes
/// on a surface from outside has min = 0, since it cannot pull.
struct HandRow {
  double min = -kInfinity, max = kInfinity;  ///< N, force of the hand on the robot; min <= 0 <= max
};

/// A sensor of the motion of a row before those of the hands.
struct SensorRow {
  int row = 0;
  double noise = 1e-4;  ///< m or rad, > 0: standard deviation
};

/// The quantity of a row that a task controls.
enum class TaskKind {
  motion,  ///< motion of a row before those of the hands, m or rad
  effort,  ///< force with which a hand pushes, N
};

/// A target for the motion or effort of one row.
struct TaskRow {
  int row = 0;
  TaskKind kind = TaskKind::motion;
  double weight = 1.0;  ///< >= 0, of the squared error in m, rad or N
  bool turns = false;   ///< whether the row is an angle, rad; for largest_step
};

/// Settings of the PassivityController, which limits the energy that hands receive.
struct PassivitySettings {
  bool enabled = true;
  double reserve = 0.5;        ///< >= 0: extra dissipation, relative to the predicted energy
  double damping_limit = 4.0;  ///< >= 0: maximum damping, relative to K T/2
};

/// Settings of a loop. The rows of a snapshot are ordered: `driven`, `unknown`, `observed`,
/// `hands`, then three per contact.
struct HighRateSettings {
  std::vector<DrivenRow> driven;
  std::vector<UnknownRow> unknown;
  int observed = 0;  ///< number of rows of effectors
  std::vector<HandRow> hands;
  std::vector<SensorRow> sensors;
  std::vector<TaskRow> tasks;
  int max_contacts = 12;  ///< >= 0: memory is allocated for this many

  double period = 1e-3;  ///< T, s: 1e-4 .. 0.1
  /// s, >= 0: time after a refresh until the new snapshot counts fully (rounded down to whole
  /// periods), see RefreshBlend.
  double blend = 5e-3;
  /// s, > 0: a snapshot, or an input with sensors or hands, older than this is stale.
  double stale_after = 0.1;
  double release_time = 0.5;  ///< s, > 0: duration of the ramp to release after that
  /// Weight of changes of efforts against tasks, as control::InverseSettings::epsilon.
  double epsilon = 1e-3;
  /// A target farther away than this, relative to the robot's size, is approached by this distance
  /// per snapshot, since the linearisation does not hold beyond.
  double largest_step = 0.02;
  PassivitySettings passivity;

  int driving() const { return static_cast<int>(driven.size() + unknown.size()); }
  /// Number of rows before those of the hands.
  int free_rows() const { return driving() + observed; }
  int first_contact() const { return free_rows() + static_cast<int>(hands.size()); }
};

/// Checks the settings. Throws Error: out-of-range, contradictory-limits, index-out-of-range,
/// naming the entry.
void check(const HighRateSettings& settings);

}  // namespace sinew::high_rate
