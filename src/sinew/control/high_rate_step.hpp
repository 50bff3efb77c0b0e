/// @file
/// One period of a high-rate loop: from the latest snapshot and what was measured to forces and
/// efforts. Knows no clock, no thread and no device.
#pragma once

#include <cstdint>
#include <string_view>

#include "sinew/control/drive_program.hpp"
#include "sinew/control/force_estimate.hpp"
#include "sinew/control/high_rate_settings.hpp"
#include "sinew/control/passivity_controller.hpp"
#include "sinew/control/refresh_blend.hpp"
#include "sinew/control/snapshot.hpp"
#include "sinew/control/touch_law.hpp"
#include "sinew/core/types.hpp"

namespace sinew::control {

/// What is measured and asked at the beginning of a period.
struct HighRateInput {
  VectorX sensors;  ///< (sensors,) m or rad; not finite: not measured
  VectorX hands;    ///< (hands,) m along their rows, from rest; not finite: no hand there
  VectorX targets;  ///< (tasks,) m, rad or N; not finite: nothing is asked
  VectorX driven;   ///< (driven,) N, measured efforts; not finite: those of the last output

  /// Nothing measured, nothing asked.
  static HighRateInput none(const HighRateSettings& settings);
};

enum class HighRateState {
  waiting,  ///< no snapshot yet: efforts are those of release, hands feel nothing
  running,
  holding,    ///< what it works from is stale: driven efforts stay as they are
  releasing,  ///< and go to those of release along a ramp, hands' forces to zero
  released,   ///< where they are
};
/// "waiting", "running", "holding", "releasing", "released".
std::string_view high_rate_state_name(HighRateState state);

/// What is stale.
enum class StaleCause { none, snapshot, input, sensors };
/// "none", "snapshot", "input", "sensors".
std::string_view stale_cause_name(StaleCause cause);

struct HighRateOutput {
  VectorX driven;         ///< (driven,) N, to be applied in this period
  VectorX driven_motion;  ///< (driven,) m, foreseen; for drives that are told lengths
  VectorX unknown;        ///< (unknown,) N, estimated
  VectorX deviation;      ///< (unknown,) N, of it
  VectorX hands;          ///< (hands,) N, that hands push with: they feel the opposite
  VectorX tasks;          ///< (tasks,) m, rad or N, foreseen
  VectorX contacts;       ///< (3 max_contacts,) N; behind those of the snapshot zero
  HighRateState state = HighRateState::waiting;
  StaleCause cause = StaleCause::none;
  bool limits_conflict = false;  ///< limits of motion gave way to those of efforts
  bool failed = false;           ///< a program had no solution: its part stays as it was
  double law_residual = 0.0;     ///< see TouchLaw::residual()
  double snapshot_time = 0.0;    ///< s, of the model
  double snapshot_age = 0.0;     ///< s, since the loop got it
  double jump = 0.0;             ///< N: largest change of a hand's force by blending in this period
  double damping = 0.0;          ///< N s/m, that passivity took in this period
  double energy_created = 0.0;   ///< J, by what hands felt since the start
  std::int64_t period = 0;       ///< number of this output, from 1

  static HighRateOutput none(const HighRateSettings& settings);
};

/// In each period, with hands and contacts obeying their laws on the snapshot (TouchLaw):
/// 1. ForceEstimate: sensors to outside forces, at the efforts that acted.
///    Where states of contacts change on the way and the forces found explain the readings less
///    well, the last ones stay, as the efforts of 2 do.
/// 2. DriveProgram: targets to driven efforts, for contacts and hands in the states that they have.
///    Where these change on the way, the tasks may end farther from their targets: the last efforts
///    then stay, and the next period goes half as far, until it serves. Efforts therefore come to
///    rest among contacts that are about to open, to close or to slide, and do not chatter; a robot
///    may rest there a little beside its optimum, which inverse::InverseController finds.
/// 3. What hands feel follows from both. A refresh is blended (RefreshBlend), and damping added
///    (PassivityController).
///
/// **Stale.** A snapshot that is older than stale_after describes another state: driven efforts
/// stay as they are, which keeps a robot that was at rest at rest, while hands go on to feel the
/// last snapshot, a passive spring. An input older than that, or one in which no sensor of several
/// speaks, likewise. From twice that age on, driven efforts go to DrivenRow::release and hands'
/// forces to zero along a ramp of release_time: what acts on a state that nobody knows should end,
/// and not at once. When it has news again it comes back along the same ramp.
class HighRateStep {
 public:
  /// Throws what check() does.
  explicit HighRateStep(HighRateSettings settings);
  HighRateStep(const HighRateStep&) = delete;
  HighRateStep& operator=(const HighRateStep&) = delete;

  const HighRateSettings& settings() const { return settings_; }
  /// Ages of what a period works from, s; -1 of an input without sensors and hands, which never is
  /// stale.
  struct Ages {
    double snapshot = 0.0, input = -1.0;
  };
  /// Allocates nothing, but for a snapshot with more contacts than settings.max_contacts.
  /// @param fresh a snapshot that has not been seen, whose contents are exchanged with those of the
  ///   one before; null: none. It must have passed check(). @param input of the right sizes.
  /// @param ages see there.
  const HighRateOutput& step(Snapshot* fresh, const HighRateInput& input, const Ages& ages);
  const HighRateOutput& output() const { return output_; }
  bool has_snapshot() const { return has_snapshot_; }
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
  VectorX driven_, unknown_, unknown_before_;  // chosen in this period
  VectorX applied_;                            // (driven,) N, in the last one
  VectorX held_;                               // (driven,) N, chosen when it last ran
  VectorX driving_;                            // (driven + unknown,)
  VectorX answer_, before_, difference_;       // (driven + unknown + hands,)
  int unchanged_ = 0;                          // periods since a state changed
  double share_ = 1.0;                         // of the way to the efforts found
  double belief_ = 1.0;                        // of the way to the forces found
  double gain_ = 1.0;                          // 0: released
  double deaf_ = 0.0;                          // s, since a sensor spoke
};

}  // namespace sinew::control
