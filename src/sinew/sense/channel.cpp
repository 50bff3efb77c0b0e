#include "sinew/sense/channel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"

namespace sinew::sense {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// The same, relative to a sampling period.
constexpr double kSamePeriod = 1e-6;
// Index of the random block that decides whether a sample is lost.
constexpr std::uint64_t kLoss = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t kScalars = 8;  // of save(), before lists

void check(const char* key, double value, bool allowed, const char* remedy) {
  if (allowed) return;
  throw Error(ErrorKind::out_of_range, {.item = key}, fmt::format("{} is {:g}", key, value),
              remedy);
}

ChannelSettings checked(const ChannelSettings& settings) {
  const auto at_least_zero = [](const char* key, double value) {
    check(key, value, value >= 0.0 && std::isfinite(value), "give 0 or more");
  };
  at_least_zero("noise", settings.noise);
  at_least_zero("drift", settings.drift);
  at_least_zero("quantum", settings.quantum);
  at_least_zero("rate", settings.rate);
  at_least_zero("delay", settings.delay);
  check("bias", settings.bias, std::isfinite(settings.bias), "give a finite number");
  check("dropout", settings.dropout, settings.dropout >= 0.0 && settings.dropout <= 1.0,
        "give a probability, 0 to 1");
  check("timeout", settings.timeout, settings.timeout > 0.0, "give a positive time");
  check("range", settings.max, settings.min < settings.max, "give the lower end first");
  return settings;
}

}  // namespace

double ChannelSettings::standard_deviation() const {
  return std::sqrt(noise * noise + quantum * quantum / 12.0);
}

Channel::Channel(const ChannelSettings& settings, std::size_t size)
    : settings_(checked(settings)),
      size_(size),
      random_(settings.seed, settings.stream),
      walk_(size),
      sample_(size),
      value_(size, kNaN) {
  on_their_way_.reserve(2 + size);
}

void Channel::offer(double time, std::span<const double> truth) {
  fresh_ = just_received_;
  just_received_ = false;
  if (received_) return;
  if (is_due(time) && take(time, truth)) {
    on_their_way_.insert(on_their_way_.end(), {time + settings_.delay, time});
    on_their_way_.insert(on_their_way_.end(), sample_.begin(), sample_.end());
  }
  const std::size_t slot = 2 + size_;
  std::size_t arrived = 0;
  while (arrived < on_their_way_.size() && on_their_way_[arrived] <= time + kSameTime) {
    deliver(on_their_way_[arrived + 1], std::span(on_their_way_).subspan(arrived + 2, size_));
    arrived += slot;
  }
  on_their_way_.erase(on_their_way_.begin(),
                      on_their_way_.begin() + static_cast<std::ptrdiff_t>(arrived));
}

void Channel::settle(double time, std::span<const double> truth) {
  fresh_ = just_received_;
  just_received_ = false;
  if (received_) return;
  is_due(time);
  on_their_way_.clear();
  if (samples_ > 0) taken_ = time;
  bool taken = false;
  while (!taken && settings_.dropout < 1.0) taken = take(time, truth);
  if (taken) deliver(time, sample_);
}

bool Channel::is_due(double time) {
  if (settings_.rate == 0.0) return true;
  const double period = std::floor(time * settings_.rate + kSamePeriod);
  const bool due = period > period_;
  period_ = std::max(period_, period);
  return due;
}

// Stores the sample in sample_; returns false if it is lost.
bool Channel::take(double time, std::span<const double> truth) {
  const auto k = static_cast<std::uint64_t>(samples_);
  const double walked =
      samples_ == 0 ? 0.0 : settings_.drift * std::sqrt(std::max(0.0, time - taken_));
  ++samples_;
  taken_ = time;
  for (std::size_t c = 0; c < size_; ++c) {
    const Philox::Block words = random_.bits({k, c, 0, 0});
    walk_[c] += walked * Philox::normal(words[2], words[3]);
    double y =
        truth[c] + settings_.bias + walk_[c] + settings_.noise * Philox::normal(words[0], words[1]);
    if (settings_.quantum > 0.0) y = settings_.quantum * std::round(y / settings_.quantum);
    sample_[c] = std::clamp(y, settings_.min, settings_.max);
  }
  const double loss = Philox::uniform(random_.bits({k, kLoss, 0, 0})[0]);
  const bool lost = loss < settings_.dropout;
  missing_ += lost ? 1 : 0;
  return !lost;
}

void Channel::deliver(double time, std::span<const double> value) {
  std::ranges::copy(value, value_.begin());
  time_ = time;
  has_value_ = fresh_ = true;
}

void Channel::receive(double time, std::span<const double> value) {
  if (value.size() != size_) {
    throw Error(ErrorKind::wrong_length, {.item = "value"},
                fmt::format("{} numbers for a sensor of {}", value.size(), size_),
                fmt::format("give {}", size_));
  }
  const double last = received_ && has_value_ ? time_ : -std::numeric_limits<double>::infinity();
  if (!(time >= last) || !std::isfinite(time)) {
    throw Error(ErrorKind::non_monotonic_time, {.item = "time"},
                fmt::format("time {:g} s follows {:g} s", time, last), "times must not decrease");
  }
  if (std::ranges::any_of(value, [](double x) { return std::isinf(x); })) {
    throw Error(ErrorKind::not_finite, {.item = "value"}, "a number is infinite",
                "give finite numbers, or NaN for a sample that is missing");
  }
  received_ = true;
  on_their_way_.clear();
  ++samples_;
  if (std::ranges::any_of(value, [](double x) { return std::isnan(x); })) {
    ++missing_;
    return;
  }
  deliver(time, value);
  just_received_ = true;
}

void Channel::restart() {
  samples_ = missing_ = 0;
  period_ = -1.0;
  taken_ = 0.0;
  std::ranges::fill(walk_, 0.0);
  on_their_way_.clear();
  has_value_ = fresh_ = received_ = just_received_ = false;
  time_ = kNaN;
  std::ranges::fill(value_, kNaN);
}

bool Channel::valid(double now) const {
  return has_value_ && now - time_ <= settings_.timeout + kSameTime;
}

void Channel::save(std::vector<double>& memory) const {
  const auto add = [&](const std::vector<double>& numbers) {
    memory.insert(memory.end(), numbers.begin(), numbers.end());
  };
  const int flags =
      (has_value_ ? 1 : 0) + (fresh_ ? 2 : 0) + (received_ ? 4 : 0) + (just_received_ ? 8 : 0);
  memory.insert(memory.end(),
                {static_cast<double>(size_), static_cast<double>(samples_),
                 static_cast<double>(missing_), period_, taken_, static_cast<double>(flags),
                 has_value_ ? time_ : 0.0, static_cast<double>(on_their_way_.size())});
  add(walk_);
  if (has_value_) add(value_);
  add(on_their_way_);
}

bool Channel::load(std::span<const double>& memory) {
  if (memory.size() < kScalars || memory[0] != static_cast<double>(size_)) return false;
  const double flags = memory[5], waiting = memory[7];
  if (!(flags >= 0.0 && flags < 16.0) || !(waiting >= 0.0)) return false;
  const int set = whole<int>(flags);
  const std::size_t values = (set & 1) != 0 ? size_ : 0;
  const std::size_t rest = memory.size() - kScalars;
  if (rest < size_ + values || waiting > static_cast<double>(rest - size_ - values)) return false;
  const auto queue = whole<std::size_t>(waiting);
  if (queue % (2 + size_) != 0) return false;
  restart();
  samples_ = whole<std::int64_t>(memory[1], 0);
  missing_ = whole<std::int64_t>(memory[2], 0);
  period_ = memory[3];
  taken_ = memory[4];
  has_value_ = (set & 1) != 0;
  fresh_ = (set & 2) != 0;
  received_ = (set & 4) != 0;
  just_received_ = (set & 8) != 0;
  if (has_value_) time_ = memory[6];
  memory = memory.subspan(kScalars);
  const auto get = [&](auto to, std::size_t count) {
    std::copy_n(memory.begin(), count, to);
    memory = memory.subspan(count);
  };
  get(walk_.begin(), size_);
  get(value_.begin(), values);
  on_their_way_.assign(memory.begin(), memory.begin() + static_cast<std::ptrdiff_t>(queue));
  memory = memory.subspan(queue);
  return true;
}

}  // namespace sinew::sense
