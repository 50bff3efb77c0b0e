#include "recording.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"

#include "limits.hpp"

namespace sinew::viewer {

namespace {

constexpr double kMotionInterval = 1.0 / 30.0;  // s
constexpr std::size_t kMinFrames = 8;
/// Beyond a step's rounding.
constexpr double kTimeTolerance = 1e-9;

}  // namespace

Recording::Recording(const Description& shown, std::string name)
    : shown_(shown), interval_(kMotionInterval) {
  motion_.name = std::move(name);
  for (const DisplaySurface& surface : shown.surfaces) {
    motion_.surfaces.push_back({surface.body, surface.triangles, {}});
    frame_bytes_ += surface.rest.size() * sizeof(float);
  }
  for (const CableInfo& cable : shown.cables) {
    motion_.lines.push_back({cable.actuator, {}});
    frame_bytes_ += 3 * cable.points * sizeof(float);
  }
  max_frames_ = std::clamp(limits::kRecordedMotion / std::max<std::size_t>(frame_bytes_, 1),
                           kMinFrames, limits::kMotionFrames);
  columns_ = 2 + shown.signals.size() + 3 * shown.effectors.size() + 1;
}

std::size_t Recording::bytes() const {
  return values_.size() * sizeof(double) + motion_.times.size() * frame_bytes_;
}

bool Recording::add(const Frame& frame) {
  full_ = full_ || (values_.size() + columns_) * sizeof(double) > limits::kRecordedRows;
  if (full_) return false;
  // A frame's step may be one that was seen already: after a reset, or when nothing went on.
  if (rows_ == 0) first_time_ = next_moment_ = frame.time;
  last_time_ = frame.time;
  values_.push_back(frame.time);
  values_.push_back(static_cast<double>(frame.step));
  values_.insert(values_.end(), frame.signals.begin(), frame.signals.end());
  for (const float coordinate : frame.targets) values_.push_back(static_cast<double>(coordinate));
  values_.push_back(frame.pull ? frame.pull->force : 0.0);
  ++rows_;
  if (frame.time > next_moment_ - kTimeTolerance) add_moment(frame);
  return true;
}

void Recording::add_moment(const Frame& frame) {
  motion_.times.push_back(static_cast<float>(frame.time - first_time_));
  for (std::size_t b = 0; b < motion_.surfaces.size(); ++b) {
    motion_.surfaces[b].frames.push_back(frame.bodies[b].positions);
  }
  auto from = frame.cables.begin();
  for (std::size_t k = 0; k < motion_.lines.size(); ++k) {
    const auto to = from + static_cast<std::ptrdiff_t>(3 * shown_.cables[k].points);
    motion_.lines[k].frames.emplace_back(from, to);
    from = to;
  }
  next_moment_ = frame.time + interval_;
  if (motion_.times.size() >= max_frames_) thin_out();
}

void Recording::thin_out() {
  const auto thin = [](auto& list) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < list.size(); k += 2) {
      if (kept != k) list[kept] = std::move(list[k]);
      ++kept;
    }
    list.resize(kept);
  };
  thin(motion_.times);
  for (auto& surface : motion_.surfaces) thin(surface.frames);
  for (auto& line : motion_.lines) thin(line.frames);
  interval_ *= 2.0;
  next_moment_ = first_time_ + static_cast<double>(motion_.times.back()) + interval_;
}

std::string Recording::csv() const {
  std::vector<std::string> names = {"time [s]", "step"};
  for (const SignalInfo& signal : shown_.signals) {
    names.push_back(signal.unit.empty() ? signal.key
                                        : fmt::format("{} [{}]", signal.key, signal.unit));
  }
  for (const std::string& effector : shown_.effectors) {
    for (const char axis : {'x', 'y', 'z'}) {
      names.push_back(fmt::format("{}.target_{} [m]", effector, axis));
    }
  }
  names.emplace_back("hand.force [N]");
  std::string text;
  append_csv_header(text, names);
  for (std::size_t row = 0; row < rows_; ++row) {
    append_csv_row(text, std::span(values_).subspan(row * columns_, columns_));
  }
  return text;
}

}  // namespace sinew::viewer
