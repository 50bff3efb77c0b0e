/// @file
/// One period of a high-rate loop: computes forces and efforts from the latest snapshot and the
/// measurements. Independent of clocks, threads and devices.
#pragma once

#include <cstdint>
#include <string_view>

#include "sinew/core/types.hpp"
#include "sinew/high_rate/drive_program.hpp"
#include "sinew/high_rate/force_estimate.hpp"
#include "sinew/high_rate/high_rate_settings.hpp"
#include "sinew/high_rate/passivity_controller.hpp"
#include "sinew/high_rate/refresh_blend.hpp"
#include "sinew/high_rate/snapshot.hpp"
#include "sinew/high_rate/touch_law.hpp"

namespace sinew::high_rate {

/// Measurements and targets at the beginning of a period.
struct HighRateInput {
  VectorX sensors;  ///< (sensors,) m or rad; not finite: not measured
  VectorX hands;    ///< (hands,) m, displacement along their rows from rest; not finite: no hand
  VectorX targets;  ///< (tasks,) m, rad or N; not finite: no target
  VectorX driven;   ///< (driven,) N, measured efforts; not finite: those of the last output

  /// No measurements and no targets.
  static HighRateInput none(const HighRateSettings& settings);
};

/// State of a loop.
enum class HighRateState {
  waiting,  ///< no snapshot yet: efforts are those of release, hands feel no force
  running,
  holding,    ///< snapshot or input is stale: driven efforts are held
  releasing,  ///< driven efforts ramp to those of release, hand forces to zero
  released,   ///< the ramp has ended
};
/// "waiting", "running", "holding", "releasing", "released".
std::string_view high_rate_state_name(HighRateState state);

/// The cause of staleness.
enum class StaleCause { none, snapshot, input, sensors };
/// "none", "snapshot", "input", "sensors".
std::string_view stale_cause_name(StaleCause cause);

/// Efforts, estimated forces and diagnostics of a period.
struct HighRateOutput {
  VectorX driven;         ///< (driven,) N, to be applied in this period
  VectorX driven_motion;  ///< (driven,) m, predicted; for drives that take lengths as commands
  VectorX unknown;        ///< (unknown,) N, estimated
  VectorX deviation;      ///< (unknown,) N, standard deviation of `unknown`
  VectorX hands;          ///< (hands,) N, force of the hands on the robot; they feel the opposite
  VectorX tasks;          ///< (tasks,) m, rad or N, predicted
  VectorX contacts;       ///< (3 max_contacts,) N; zero after those of the snapshot
  HighRateState state = HighRateState::waiting;
  StaleCause cause = StaleCause::none;
  bool limits_conflict = false;  ///< limits of motions gave way to those of efforts
  bool failed = false;           ///< a program had no solution: its output is unchanged
  double law_residual = 0.0;     ///< see TouchLaw::residual()
  double snapshot_time = 0.0;    ///< s, simulation time of the snapshot
  double snapshot_age = 0.0;     ///< s, since the loop received it
  double jump = 0.0;     ///< N: largest change of a hand force due to blending in this period
  double damping = 0.0;  ///< N s/m, added by the passivity controller in this period
  double energy_created = 0.0;  ///< J, created by the forces that hands felt since the start
  std::int64_t period = 0;      ///< number of this output, from 1

  static HighRateOutput none(const HighRateSettings& settings);
};

/// One period of the loop. Hands and contacts obey their laws on the snapshot (TouchLaw).
/// 1. ForceEstimate estimates external forces from the sensors, at the efforts that acted. If
/// contacts
///    change state on the way and the new forces explain the readings less well, the last forces
///    are kept, as in 2.
/// 2. DriveProgram computes driven efforts from the targets, with contacts and hands in their
/// present
///    states. If these states change on the way, the tasks may end farther from their targets. The
///    last efforts are then kept, and the next period takes half the step, until the tasks improve.
///    Efforts therefore converge, instead of chattering, where contacts are about to open, close or
///    slide. A robot may come to rest a little beside its optimum, which
///    control::InverseController finds.
/// 3. The forces that hands feel follow from both. Changes of the snapshot are blended
///    (RefreshBlend), and damping is added (PassivityController).
///
/// **Stale data.** A snapshot older than stale_after describes another state. Driven efforts are
/// then held, which keeps a resting robot at rest, while hands continue to feel the last snapshot,
/// a passive spring. The same holds for an input older than that, and for one in which all sensors
/// are silent. From twice that age on, driven efforts ramp to DrivenRow::release and hand forces to
/// zero within release_time: actions on an unknown state should end, but not abruptly. When new
/// data arrive, the loop returns along the same ramp.
class HighRateStep {
 public:
  /// Throws what check() throws.
  explicit HighRateStep(HighRateSettings settings);
  HighRateStep(const HighRateStep&) = delete;
  HighRateStep& operator=(const HighRateStep&) = delete;

  const HighRateSettings& settings() const { return settings_; }
  /// Ages of the data of a period, s. The age of an input without sensors and hands is -1: it is
  /// never stale.
  struct Ages {
    double snapshot = 0.0, input = -1.0;
  };
  /// Computes one period. Allocates only for a snapshot with more contacts than
  /// settings.max_contacts.
  /// @param fresh a new snapshot, which has passed check(); its contents are exchanged with those
  ///   of the last one. Null: none. @param input of the right sizes. @param ages of the data.
  const HighRateOutput& step(Snapshot* fresh, const HighRateInput& input, const Ages& ages);
  const HighRateOutput& output() const { return output_; }
  const TouchLaw& law() const { return law_; }
  const PassivityController& passivity() const { return passivity_; }

 private:
  void solve(const HighRateInput& input);
  void estimate(const HighRateInput& input);
  void drive(const HighRateInput& input);
  void take(Snapshot& fresh, const HighRateInput& input);
  void settle(const HighRateInput& input);
  void write_answer(VectorX& answer) const;
  void judge(const HighRateInput& input, const Ages& ages);
  void finish_driven();
  void finish_hands(const HighRateInput& input);
  void foresee();

  const HighRateSettings settings_;
  Snapshot snapshot_;
  bool has_snapshot_ = false;
  HighRateOutput output_;
  TouchLaw law_;
  ForceEstimate estimate_;
  DriveProgram drive_;
  RefreshBlend blend_;
  PassivityController passivity_;
  VectorX driven_, unknown_, unknown_before_;  // of this period
  VectorX applied_;                            // (driven,) N, applied in the last period
  VectorX held_;                               // (driven,) N, chosen in the last running period
  VectorX driving_;                            // (driven + unknown,)
  VectorX answer_, before_, difference_;       // (driven + unknown + hands,)
  int unchanged_ = 0;                          // number of periods since a state changed
  double share_ = 1.0;                         // fraction of the step to the efforts found
  double belief_ = 1.0;                        // fraction of the step to the forces found
  double gain_ = 1.0;                          // 1: running, 0: released
  double deaf_ = 0.0;                          // s, since all sensors became silent
};

}  // namespace sinew::high_rate
