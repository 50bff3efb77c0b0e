#include "recording.hpp"

#include <fmt/format.h>

#include "sinew/core/csv.hpp"

#include "limits.hpp"

namespace sinew::viewer {

namespace {

record::MotionRecorder motion_of(const Description& shown, std::string name) {
  record::Motion motion;
  std::size_t floats = 0;
  motion.name = std::move(name);
  for (const DisplaySurface& surface : shown.surfaces) {
    motion.surfaces.push_back({surface.body, surface.triangles, {}});
    floats += surface.rest.size();
  }
  for (const CableInfo& cable : shown.cables) {
    motion.lines.push_back({cable.actuator, {}});
    floats += 3 * cable.points;
  }
  return {std::move(motion), floats};
}

}  // namespace

Recording::Recording(const Description& shown, std::string name)
    : shown_(shown), motion_(motion_of(shown, std::move(name))) {
  columns_ = 2 + shown.signals.size() + 3 * shown.effectors.size() + 1;
}

std::size_t Recording::bytes() const { return values_.size() * sizeof(double) + motion_.bytes(); }

bool Recording::add(const Frame& frame) {
  full_ = full_ || (values_.size() + columns_) * sizeof(double) > limits::kRecordedRows;
  if (full_) return false;
  // The step of a frame may not be new, after a reset or in a paused run.
  if (rows_ == 0) first_time_ = frame.time;
  last_time_ = frame.time;
  values_.push_back(frame.time);
  values_.push_back(static_cast<double>(frame.step));
  values_.insert(values_.end(), frame.signals.begin(), frame.signals.end());
  for (const float coordinate : frame.targets) values_.push_back(static_cast<double>(coordinate));
  values_.push_back(frame.pull ? frame.pull->force : 0.0);
  ++rows_;
  if (motion_.is_due(frame.time)) add_moment(frame);
  return true;
}

void Recording::add_moment(const Frame& frame) {
  std::vector<std::vector<float>> surfaces, lines;
  for (const BodyFrame& body : frame.bodies) surfaces.push_back(body.positions);
  auto from = frame.cables.begin();
  for (const CableInfo& cable : shown_.cables) {
    const auto to = from + static_cast<std::ptrdiff_t>(3 * cable.points);
    lines.emplace_back(from, to);
    from = to;
  }
  motion_.add(frame.time, std::move(surfaces), std::move(lines));
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
