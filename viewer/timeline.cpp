#include "timeline.hpp"

#include <algorithm>
#include <utility>

#include "limits.hpp"

namespace sinew::viewer {

namespace {

constexpr double kInterval = 1.0 / 30.0;  // s

std::size_t bytes_of(const Moment& moment) { return moment.state.size() * sizeof(double); }

}  // namespace

bool Timeline::due(double time) const {
  return moments_.empty() || time - moments_.back().time > kInterval - 1e-9;
}

void Timeline::drop_latest() {
  bytes_ -= bytes_of(moments_.back());
  moments_.pop_back();
}

void Timeline::go_on() {
  while (shown_ && latest() > *shown_) drop_latest();
  shown_.reset();
}

void Timeline::keep(Moment moment) {
  go_on();
  if (!empty() && moments_.back().state.steps == moment.state.steps) drop_latest();
  const double oldest = moment.time - limits::kTimelineSeconds;
  bytes_ += bytes_of(moment);
  moments_.push_back(std::move(moment));
  while (size() > 1 && (bytes_ > limits::kTimelineBytes || moments_.front().time < oldest)) {
    bytes_ -= bytes_of(moments_.front());
    moments_.pop_front();
    ++first_;
  }
}

const Moment& Timeline::go_back(std::int64_t number) {
  const std::int64_t nearest = std::clamp(number, first_, latest());
  shown_.reset();
  if (nearest < latest()) shown_ = nearest;
  return moments_[static_cast<std::size_t>(nearest - first_)];
}

void Timeline::clear() {
  moments_.clear();
  bytes_ = 0;
  first_ = 0;
  shown_.reset();
}

TimelineFrame Timeline::describe(double time) const {
  return {first_, latest(), shown_.value_or(latest()), moments_.front().time,
          in_past() ? moments_.back().time : time};
}

}  // namespace sinew::viewer
