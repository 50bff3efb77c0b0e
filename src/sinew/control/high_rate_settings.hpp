/// @file
/// What a high-rate loop senses, touches and drives, and how it works.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::control {

/// A row whose effort the loop chooses: a cable, a motor, a pressure.
struct DrivenRow {
  double effort_min = -kInfinity, effort_max = kInfinity;  ///< N or Pa
  double effort_rate = kInfinity;                          ///< N/s or Pa/s, > 0
  double motion_min = -kInfinity, motion_max = kInfinity;  ///< m or m^3
  double release = 0.0;  ///< N or Pa, within the limits: where it goes when it lets go
};

/// A row with an outside force that nobody measures.
struct UnknownRow {
  double prior = 1.0;  ///< N, > 0: standard deviation of what is expected before any sensor speaks
  double min = -kInfinity, max = kInfinity;  ///< N
};

/// A row that a hand moves: it goes where the hand is, with an effort within limits. A hand that
/// pushes on a surface from outside has min = 0: it cannot pull.
struct HandRow {
  double min = -kInfinity, max = kInfinity;  ///< N, of the hand on the robot; min <= 0 <= max
};

/// A measured motion of a row in front of the hands' ones.
struct SensorRow {
  int row = 0;
  double noise = 1e-4;  ///< m or rad, > 0: standard deviation
};

/// What a task asks of a row.
enum class TaskKind {
  motion,  ///< of a row in front of the hands' ones: that it be at the target, m or rad
  effort,  ///< of a hand's row: that the hand push with the target, N
};

struct TaskRow {
  int row = 0;
  TaskKind kind = TaskKind::motion;
  double weight = 1.0;  ///< >= 0, of the squared error in m, rad or N
  bool turns = false;   ///< whether the row is an angle, rad: of largest_step
};

/// Control of the energy that hands get (PassivityController).
struct PassivitySettings {
  bool enabled = true;
  double reserve = 0.5;        ///< >= 0: part of the energy foreseen that is dissipated on top
  double damping_limit = 4.0;  ///< >= 0: largest damping, over K T/2
};

/// Rows of a snapshot stand in this order: `driven`, `unknown`, `observed`, `hands`, then three of
/// each contact.
struct HighRateSettings {
  std::vector<DrivenRow> driven;
  std::vector<UnknownRow> unknown;
  int observed = 0;  ///< rows of effectors
  std::vector<HandRow> hands;
  std::vector<SensorRow> sensors;
  std::vector<TaskRow> tasks;
  int max_contacts = 12;  ///< >= 0: memory is for so many

  double period = 1e-3;  ///< T, s: 1e-4 .. 0.1
  /// s, >= 0: after a refresh the new snapshot counts fully after this time (rounded down to
  /// periods), see RefreshBlend.
  double blend = 5e-3;
  /// s, > 0: a snapshot, or an input with sensors or hands, older than this is stale.
  double stale_after = 0.1;
  double release_time = 0.5;  ///< s, > 0: of the ramp along which everything then lets go
  /// Weighs changes of efforts against tasks as in inverse::InverseSettings::epsilon.
  double epsilon = 1e-3;
  /// A target farther away than this part of the robot's size is approached by as much from each
  /// snapshot, since beyond it the linearisation is worth nothing.
  double largest_step = 0.02;
  PassivitySettings passivity;

  int driving() const { return static_cast<int>(driven.size() + unknown.size()); }
  /// Rows in front of the hands' ones.
  int free_rows() const { return driving() + observed; }
  int first_contact() const { return free_rows() + static_cast<int>(hands.size()); }
};

/// Throws Error(out-of-range | contradictory-limits | index-out-of-range), naming the
/// entry.
void check(const HighRateSettings& settings);

}  // namespace sinew::control
