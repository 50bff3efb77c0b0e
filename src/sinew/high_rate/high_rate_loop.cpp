#include "sinew/high_rate/high_rate_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"

namespace sinew::high_rate {

namespace {

void require_numbers(const VectorX& given, Eigen::Index wanted, const char* name) {
  if (given.size() != wanted) {
    throw Error(ErrorKind::wrong_shape, {.item = fmt::format("high-rate input: {}", name)},
                fmt::format("it has {} numbers in place of {}", given.size(), wanted),
                "give one for each row, and nan for what is not there");
  }
  for (const double number : given) {
    if (!std::isinf(number)) continue;
    throw Error(ErrorKind::not_finite, {.item = fmt::format("high-rate input: {}", name)},
                "a number is infinite", "give nan for what is not there");
  }
}

void count(std::atomic<std::int64_t>& counter, std::int64_t more = 1) {
  counter.store(counter.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

}  // namespace

HighRateLoop::HighRateLoop(HighRateSettings settings, std::shared_ptr<Device> device)
    : step_(std::move(settings)),
      device_(std::move(device)),
      inputs_(HighRateInput::none(step_.settings())),
      outputs_(HighRateOutput::none(step_.settings())),
      input_(HighRateInput::none(step_.settings())) {}

HighRateLoop::~HighRateLoop() { stop(); }

void HighRateLoop::publish(Snapshot snapshot) {
  check(snapshot, settings());
  const std::lock_guard lock(publishing_);
  snapshot.number = ++published_;
  snapshots_.slot() = std::move(snapshot);
  snapshots_.publish();
}

void HighRateLoop::set_input(const HighRateInput& input) {
  require_numbers(input.sensors, input_.sensors.size(), "sensors");
  require_numbers(input.hands, input_.hands.size(), "hands");
  require_numbers(input.targets, input_.targets.size(), "targets");
  require_numbers(input.driven, input_.driven.size(), "driven");
  const std::lock_guard lock(setting_);
  inputs_.slot() = input;
  inputs_.publish();
}

HighRateOutput HighRateLoop::output() {
  const std::lock_guard lock(reading_);
  outputs_.take();
  return outputs_.value();
}

HighRateReport HighRateLoop::report() const {
  const auto read = [](const auto& counter) { return counter.load(std::memory_order_relaxed); };
  const std::lock_guard lock(starting_);
  return {read(periods_),  read(taken_),     read(missed_), read(conflicts_),
          read(failures_), read(real_time_), scheduling_};
}

void HighRateLoop::begin_run() {
  if (!running_.exchange(true, std::memory_order_acq_rel)) {
    stop_.store(false, std::memory_order_relaxed);
    return;
  }
  throw Error(ErrorKind::bad_argument, {.item = "high-rate loop"}, "it is running",
              "stop() it before it starts anew");
}

void HighRateLoop::start() {
  const std::lock_guard lock(starting_);
  begin_run();
  if (thread_.joinable()) thread_.join();  // one that ended by itself
  scheduling_ = "starting";
  thread_ = std::thread([this] {
    const std::string refusal = request_real_time();
    {
      const std::lock_guard note(starting_);
      scheduling_ = refusal.empty() ? "SCHED_FIFO" : refusal;
      real_time_.store(refusal.empty(), std::memory_order_relaxed);
    }
    MonotonicClock clock;
    loop(clock, std::numeric_limits<std::int64_t>::max(), this);
    running_.store(false, std::memory_order_release);
  });
}

void HighRateLoop::stop() {
  std::thread ending;
  {
    const std::lock_guard lock(starting_);
    stop_.store(true, std::memory_order_relaxed);
    ending.swap(thread_);
  }
  if (ending.joinable()) ending.join();
}

void HighRateLoop::run(Clock& clock, std::int64_t periods) {
  begin_run();
  try {
    loop(clock, periods, &clock);
  } catch (...) {
    running_.store(false, std::memory_order_release);
    throw;
  }
  running_.store(false, std::memory_order_release);
}

void HighRateLoop::loop(Clock& clock, std::int64_t periods, const void* timeline) {
  double due = clock.now();
  // Ages continue from run to run. On another clock, the time between runs does not count.
  if (timeline != timeline_) {
    snapshot_seen_ += due - last_begin_;
    input_seen_ += due - last_begin_;
    timeline_ = timeline;
  }
  for (std::int64_t k = 0; k < periods && !stop_.load(std::memory_order_relaxed); ++k) {
    const double begin = clock.now();
    last_begin_ = begin;
    period(begin);
    const double end = clock.now();
    note(due, begin, end);
    // Missed periods are skipped; the next one begins at its regular time.
    const double passed = std::floor((end - due) / settings().period);
    if (passed >= 1.0) count(missed_, whole<std::int64_t>(passed));
    due += settings().period * std::max(passed + 1.0, 1.0);
    clock.sleep_until(due);
  }
}

void HighRateLoop::period(double now) {
  Snapshot* fresh = nullptr;
  if (snapshots_.take()) {
    fresh = &snapshots_.value();
    snapshot_seen_ = now;
    count(taken_);
  }
  read_input(now);
  const HighRateSettings& asked = settings();
  const bool ages = !asked.sensors.empty() || !asked.hands.empty();
  const HighRateOutput& output =
      step_.step(fresh, input_, {now - snapshot_seen_, ages ? now - input_seen_ : -1.0});
  if (device_ != nullptr) device_->write(output);
  outputs_.slot() = output;
  outputs_.publish();
}

void HighRateLoop::read_input(double now) {
  if (inputs_.take()) {
    const HighRateInput& given = inputs_.value();
    if (device_ == nullptr) {
      input_ = given;
      input_seen_ = now;
    } else {
      input_.targets = given.targets;
    }
  }
  if (device_ != nullptr && device_->read(input_)) input_seen_ = now;
}

void HighRateLoop::note(double due, double begin, double end) {
  const HighRateOutput& output = step_.output();
  count(periods_);
  if (output.limits_conflict) count(conflicts_);
  if (output.failed) count(failures_);
  lateness_.add(begin - due);
  work_.add(end - begin);
}

}  // namespace sinew::high_rate
