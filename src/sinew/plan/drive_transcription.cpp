#include "sinew/plan/drive_transcription.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/core/whole.hpp"

namespace sinew::plan {

namespace {

constexpr int kMaxSamples = 1000000;  // of a drive

void append(VectorX& to, double value) {
  to.conservativeResize(to.size() + 1);
  to[to.size() - 1] = value;
}

double bounded(double value) { return std::clamp(value, -kNoBound, kNoBound); }

}  // namespace

double LinearForm::of(const VectorX& x) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) sum += weight[i] * x[at[i]];
  return sum;
}

DriveTranscription::DriveTranscription(const PlanTask& task, double torque, int variable, int row)
    : drive_(*task.drive),
      step_(drive_.channels.front().cylinder.sample_time),
      duration_(task.grid.duration),
      first_(variable) {
  for (int input = 0; input < static_cast<int>(drive_.channels.size()); ++input) {
    const Channel of = channel(task, input, torque);
    channels_.push_back(of);
    variables_ += 2 * of.count;
    add_bounds(of);
    if (!of.driven()) continue;
    add_rows(of, row + rows());
    const double rate = task.limits.command_rate[input];
    if (rate < kNoBound) add_rate_rows(of, row + rows(), rate);
    const double slope = of.drive.actuator.torque(of.scale) / of.scale * of.drive.cylinder.gain();
    add_cost(of, 2.0 * task.objective.command * slope * slope / step_);
  }
}

DriveTranscription::Channel DriveTranscription::channel(const PlanTask& task, int input,
                                                        double torque) const {
  Channel of{.drive = drive_.channels[static_cast<std::size_t>(input)]};
  const pcc::FluidicActuator& actuator = of.drive.actuator;
  const pcc::DriveCylinder& cylinder = of.drive.cylinder;
  // The second sample acts at or before the beginning of the plan.
  const double shift = drive_.lead - actuator.delay;
  of.offset = whole<int>(std::floor(shift / step_ + 1e-9), -kMaxSamples, kMaxSamples) - 1;
  of.begin = of.offset * step_ - shift;
  of.at_rest = of.begin + step_ > -1e-9 * step_ ? 1 : 2;
  // There is one sample beyond the end, for cubic interpolation.
  of.count = whole_count<int>(std::ceil((task.grid.duration - of.begin) / step_ - 1e-9) + 2.0,
                              kMaxSamples, "samples of a drive", "shorten the plan");
  of.volume = first_ + variables_;
  of.command = of.volume + of.count;
  of.rest_volume = actuator.volume(task.start.torque[input]);
  of.rest_command = of.rest_volume / cylinder.gain();
  const auto volume = [&](double limit) {
    return std::abs(limit) < kNoBound ? actuator.volume(limit) : limit;
  };
  of.lower = std::max(volume(task.limits.torque_lower[input]), bounded(cylinder.lowest_volume));
  of.upper = std::min(volume(task.limits.torque_upper[input]), bounded(cylinder.highest_volume));
  const double most = std::max(std::abs(of.lower), std::abs(of.upper));
  of.scale = most < kNoBound && of.driven() ? most : actuator.volume(torque);
  return of;
}

void DriveTranscription::add_bounds(const Channel& of) {
  const pcc::DriveCylinder& cylinder = of.drive.cylinder;
  const int feedthrough = cylinder.d == 0.0 ? 0 : 1;
  const double unit = of.scale / std::abs(cylinder.gain());
  for (int j = 0; j < of.count; ++j) {
    const bool fixed = j <= of.at_rest || !of.driven();
    append(variable_bounds_.lower, fixed ? of.rest_volume : of.lower);
    append(variable_bounds_.upper, fixed ? of.rest_volume : of.upper);
    append(variable_scale_, of.scale);
  }
  for (int j = 0; j < of.count; ++j) {
    const bool fixed = j < of.at_rest + feedthrough || !of.driven();
    append(variable_bounds_.lower, fixed ? of.rest_command : bounded(cylinder.lowest_input));
    append(variable_bounds_.upper, fixed ? of.rest_command : bounded(cylinder.highest_input));
    append(variable_scale_, unit);
  }
}

void DriveTranscription::add_rows(const Channel& of, int row) {
  const pcc::DriveCylinder& cylinder = of.drive.cylinder;
  const double trace = cylinder.a.trace(), determinant = cylinder.a.determinant();
  const double first = cylinder.c.dot(cylinder.b), second = cylinder.c.dot(cylinder.a * cylinder.b);
  const std::array<double, 3> own{1.0, -trace, determinant};
  const std::array<double, 3> driven{cylinder.d, first - trace * cylinder.d,
                                     second - trace * first + determinant * cylinder.d};
  for (int j = of.at_rest + 1; j < of.count; ++j, ++row) {
    for (int m = 0; m < 3; ++m) {
      const auto at = static_cast<std::size_t>(m);
      entries_.push_back({row, of.volume + j - m, own[at]});
      if (driven[at] != 0.0) entries_.push_back({row, of.command + j - m, -driven[at]});
    }
    append(row_bounds_.lower, 0.0);
    append(row_bounds_.upper, 0.0);
    append(row_scale_, of.scale);
  }
}

void DriveTranscription::add_rate_rows(const Channel& of, int row, double limit) {
  for (int j = of.at_rest; j < of.count; ++j, ++row) {
    entries_.push_back({row, of.command + j, 1.0 / step_});
    entries_.push_back({row, of.command + j - 1, -1.0 / step_});
    append(row_bounds_.lower, -limit);
    append(row_bounds_.upper, limit);
    append(row_scale_, limit);
  }
}

void DriveTranscription::add_cost(const Channel& of, double weight) {
  for (int j = of.at_rest; j < of.count; ++j) {
    const int at = of.command + j;
    cost_.push_back({at - 1, at - 1, weight});
    cost_.push_back({at, at - 1, -weight});
    cost_.push_back({at, at, weight});
  }
}

LinearForm DriveTranscription::volume(int input, double time) const {
  const Channel& of = channels_[static_cast<std::size_t>(input)];
  // At a sample, rounding must not select a sample that does not exist.
  const double at = (time - of.begin) / step_, rounding = 1e-9;
  const int j = whole<int>(std::floor(at + rounding), -kMaxSamples, kMaxSamples);
  const std::array<double, 4> weights = sample_weights(std::max(at - j, 0.0));
  LinearForm form;
  for (int m = 0; m < 4; ++m) {
    const int sample = std::clamp(j + m - 1, 0, of.count - 1);
    form.at[static_cast<std::size_t>(m)] = of.volume + sample;
  }
  form.weight = weights;
  form.count = 4;
  return form;
}

VectorX DriveTranscription::pack(const DriveRun& run) const {
  VectorX x(variables_);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& of = channels_[i];
    const auto input = static_cast<Eigen::Index>(i);
    for (int j = 0; j < of.count; ++j) {
      const Eigen::Index at = of.offset + j;
      const Eigen::Index sample = std::clamp<Eigen::Index>(at, 0, run.times.size() - 1);
      x[of.volume - first_ + j] = at < 0 ? of.rest_volume : run.volume(sample, input);
      x[of.command - first_ + j] = at < 0 ? of.rest_command : run.command(sample, input);
    }
  }
  return x;
}

DriveRun DriveTranscription::unpack(const VectorX& x) const {
  Eigen::Index count = sample_count(drive_.channels.front().cylinder, drive_.lead + duration_);
  for (const Channel& of : channels_) {
    count = std::max<Eigen::Index>(count, of.offset + of.count);
  }
  const auto inputs = static_cast<Eigen::Index>(channels_.size());
  MatrixX command(count, inputs);
  VectorX rest(inputs);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& of = channels_[i];
    const auto input = static_cast<Eigen::Index>(i);
    rest[input] = of.rest_command;
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index j = std::min<Eigen::Index>(k - of.offset, of.count - 1);
      command(k, input) = j < 0 ? of.rest_command : x[of.command + j];
    }
  }
  return {drive_.channels, std::move(command), drive_.lead, std::move(rest)};
}

}  // namespace sinew::plan
