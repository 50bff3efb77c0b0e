#include "sinew/high_rate/high_rate_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sinew::high_rate {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Smallest fraction of a step; it recovers in twelve periods.
constexpr double kMinShare = 1.0 / 4096.0;

Eigen::Index length(const auto& list) { return static_cast<Eigen::Index>(list.size()); }

const HighRateSettings& checked(const HighRateSettings& settings) {
  check(settings);
  return settings;
}

}  // namespace

std::string_view high_rate_state_name(HighRateState state) {
  switch (state) {
    case HighRateState::waiting:
      return "waiting";
    case HighRateState::running:
      return "running";
    case HighRateState::holding:
      return "holding";
    case HighRateState::releasing:
      return "releasing";
    case HighRateState::released:
      return "released";
  }
  return "unknown";
}

std::string_view stale_cause_name(StaleCause cause) {
  switch (cause) {
    case StaleCause::none:
      return "none";
    case StaleCause::snapshot:
      return "snapshot";
    case StaleCause::input:
      return "input";
    case StaleCause::sensors:
      return "sensors";
  }
  return "unknown";
}

HighRateInput HighRateInput::none(const HighRateSettings& settings) {
  return {VectorX::Constant(length(settings.sensors), kNone),
          VectorX::Constant(length(settings.hands), kNone),
          VectorX::Constant(length(settings.tasks), kNone),
          VectorX::Constant(length(settings.driven), kNone)};
}

HighRateOutput HighRateOutput::none(const HighRateSettings& settings) {
  HighRateOutput output;
  output.driven.resize(length(settings.driven));
  for (std::size_t k = 0; k < settings.driven.size(); ++k) {
    output.driven[static_cast<Eigen::Index>(k)] = settings.driven[k].release;
  }
  output.driven_motion = VectorX::Zero(length(settings.driven));
  output.unknown = output.deviation = VectorX::Zero(length(settings.unknown));
  output.hands = VectorX::Zero(length(settings.hands));
  output.tasks = VectorX::Zero(length(settings.tasks));
  output.contacts = VectorX::Zero(3 * Eigen::Index{settings.max_contacts});
  return output;
}

HighRateStep::HighRateStep(HighRateSettings settings)
    : settings_(checked(settings)),
      output_(HighRateOutput::none(settings_)),
      law_(settings_),
      estimate_(settings_),
      drive_(settings_),
      blend_(settings_.driving() + length(settings_.hands), settings_.blend, settings_.period),
      passivity_(settings_),
      driven_(VectorX::Zero(length(settings_.driven))),
      unknown_(VectorX::Zero(length(settings_.unknown))),
      unknown_before_(unknown_),
      applied_(output_.driven),
      held_(applied_),
      driving_(VectorX::Zero(settings_.driving())),
      answer_(VectorX::Zero(settings_.driving() + length(settings_.hands))),
      before_(answer_),
      difference_(answer_) {}

const HighRateOutput& HighRateStep::step(Snapshot* fresh, const HighRateInput& input,
                                         const Ages& ages) {
  ++output_.period;
  output_.limits_conflict = output_.failed = false;
  if (fresh == nullptr && !has_snapshot_) return output_;
  judge(input, ages);
  if (fresh != nullptr) {
    take(*fresh, input);
  } else {
    solve(input);
    write_answer(answer_);
  }
  blend_.advance();
  finish_driven();
  finish_hands(input);
  foresee();
  output_.snapshot_time = snapshot_.time;
  output_.snapshot_age = ages.snapshot;
  output_.law_residual = law_.residual();
  return output_;
}

// Evaluates both snapshots at the same input.
void HighRateStep::take(Snapshot& fresh, const HighRateInput& input) {
  if (has_snapshot_) {
    solve(input);
    write_answer(before_);
    for (Eigen::Index k = 0; k < before_.size(); ++k) before_[k] += blend_.at(k);
  }
  std::swap(snapshot_, fresh);
  law_.begin(snapshot_);
  if (!has_snapshot_) {  // the robot is where its efforts hold it
    for (Eigen::Index k = 0; k < applied_.size(); ++k) {
      const DrivenRow& row = settings_.driven[static_cast<std::size_t>(k)];
      applied_[k] = std::clamp(snapshot_.effort[k], row.effort_min, row.effort_max);
    }
    held_ = applied_;
  }
  solve(input);
  write_answer(answer_);
  if (!has_snapshot_) {
    before_ = answer_;
    before_.tail(output_.hands.size()).setZero();
    has_snapshot_ = true;
  }
  difference_ = before_ - answer_;
  blend_.begin(difference_);
}

void HighRateStep::judge(const HighRateInput& input, const Ages& ages) {
  const bool deaf = input.sensors.size() > 0 && !input.sensors.array().isFinite().any();
  deaf_ = deaf ? deaf_ + settings_.period : 0.0;
  double oldest = ages.snapshot;
  output_.cause = StaleCause::snapshot;
  if (ages.input > oldest) {
    oldest = ages.input;
    output_.cause = StaleCause::input;
  }
  if (deaf_ > oldest) {
    oldest = deaf_;
    output_.cause = StaleCause::sensors;
  }
  const double change = settings_.period / settings_.release_time;
  if (oldest <= settings_.stale_after) {
    output_.cause = StaleCause::none;
    output_.state = HighRateState::running;
    gain_ = std::min(gain_ + change, 1.0);
  } else if (oldest <= 2.0 * settings_.stale_after) {
    output_.state = HighRateState::holding;
  } else {
    gain_ = std::max(gain_ - change, 0.0);
    output_.state = gain_ > 0.0 ? HighRateState::releasing : HighRateState::released;
  }
}

void HighRateStep::settle(const HighRateInput& input) {
  driving_.head(driven_.size()) = driven_;
  driving_.tail(unknown_.size()) = unknown_;
  law_.settle(driving_, input.hands);
}

void HighRateStep::solve(const HighRateInput& input) {
  const bool runs = output_.state == HighRateState::running;
  driven_ = applied_;
  for (Eigen::Index k = 0; k < driven_.size(); ++k) {
    if (std::isfinite(input.driven[k])) driven_[k] = input.driven[k];
  }
  settle(input);
  if (runs && unknown_.size() > 0) estimate(input);
  driven_ = runs ? applied_ : held_;
  if (runs && driven_.size() > 0) {
    drive(input);
  } else {
    settle(input);
  }
}

void HighRateStep::estimate(const HighRateInput& input) {
  unknown_before_ = unknown_;
  const double before = estimate_.misfit(law_, driven_, input.sensors, unknown_);
  if (!estimate_.solve(law_, driven_, input.sensors, unknown_)) {
    output_.failed = true;
    return;
  }
  unknown_ = unknown_before_ + belief_ * (unknown_ - unknown_before_);
  settle(input);
  const bool serves = estimate_.misfit(law_, driven_, input.sensors, unknown_) <= before;
  belief_ = std::clamp(serves ? 2.0 * belief_ : 0.5 * belief_, kMinShare, 1.0);
  if (!serves) unknown_ = unknown_before_;
}

void HighRateStep::drive(const HighRateInput& input) {
  settle(input);
  const DriveProgram::Asked asked{snapshot_, law_, unknown_, applied_, input.targets};
  const auto status = drive_.solve(asked, driven_);
  const double before = drive_.missed(asked, applied_);
  const bool within = drive_.keeps_limits(applied_);
  output_.limits_conflict |= status == DriveProgram::Status::limits_conflict;
  output_.failed |= status == DriveProgram::Status::failed;
  if (status == DriveProgram::Status::failed) return;
  driven_ = applied_ + share_ * (driven_ - applied_);
  settle(input);
  const bool serves = !within || drive_.missed(asked, driven_) <= before;
  share_ = std::clamp(serves ? 2.0 * share_ : 0.5 * share_, kMinShare, 1.0);
  if (serves) return;
  driven_ = applied_;
  settle(input);
}

void HighRateStep::write_answer(VectorX& answer) const {
  answer.head(driven_.size()) = driven_;
  answer.segment(driven_.size(), unknown_.size()) = unknown_;
  answer.tail(output_.hands.size()) = law_.effort().head(output_.hands.size());
}

void HighRateStep::finish_driven() {
  for (Eigen::Index k = 0; k < driven_.size(); ++k) {
    const DrivenRow& row = settings_.driven[static_cast<std::size_t>(k)];
    const double most = row.effort_rate * settings_.period;
    const double wanted = row.release + gain_ * (answer_[k] + blend_.at(k) - row.release);
    const double allowed = std::clamp(wanted, row.effort_min, row.effort_max);
    applied_[k] = std::clamp(allowed, applied_[k] - most, applied_[k] + most);
  }
  output_.driven = applied_;
  if (output_.state == HighRateState::running) held_ = driven_;
  for (Eigen::Index k = 0; k < unknown_.size(); ++k) {
    output_.unknown[k] = answer_[driven_.size() + k] + blend_.at(driven_.size() + k);
  }
  output_.deviation = estimate_.deviation();
}

void HighRateStep::finish_hands(const HighRateInput& input) {
  const Eigen::Index first = settings_.driving();
  output_.jump = 0.0;
  for (Eigen::Index h = 0; h < output_.hands.size(); ++h) {
    output_.hands[h] = 0.0;
    if (!std::isfinite(input.hands[h])) continue;
    output_.hands[h] = gain_ * (answer_[first + h] + blend_.at(first + h));
    output_.jump = std::max(output_.jump, gain_ * blend_.jump(first + h));
  }
  passivity_.observe(input.hands, law_.stored());
  passivity_.damp(law_.hand_stiffness(), output_.hands);
  output_.damping = passivity_.damping();
  output_.energy_created = passivity_.created();
}

void HighRateStep::foresee() {
  driving_.head(driven_.size()) = output_.driven;
  driving_.tail(unknown_.size()) = unknown_;
  const Eigen::Index count = driven_.size();
  output_.driven_motion = law_.free().head(count);
  output_.driven_motion.noalias() += law_.compliance().topRows(count) * driving_;
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    const TaskRow& task = settings_.tasks[t];
    output_.tasks[static_cast<Eigen::Index>(t)] =
        task.kind == TaskKind::effort
            ? output_.hands[task.row - settings_.free_rows()]
            : law_.free()[task.row] + law_.compliance().row(task.row).dot(driving_);
  }
  output_.contacts.setZero();
  const Eigen::Index hands = output_.hands.size();
  const Eigen::Index rows = law_.rows() - hands;
  output_.contacts.head(rows) = law_.effort().tail(rows);
}

}  // namespace sinew::high_rate
