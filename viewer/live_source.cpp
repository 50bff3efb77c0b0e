#include "live_source.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "robot_state.hpp"

namespace sinew::viewer {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr Seconds kFrameTime{1.0 / 60.0};
/// A run that is this far behind the clock lets the clock go.
constexpr Seconds kLargestLag{0.1};
/// The real-time factor is measured over at least this long.
constexpr Seconds kFactorTime{0.5};
constexpr double kSlow = 0.9;

Clock::duration ticks(Seconds seconds) {
  return std::chrono::duration_cast<Clock::duration>(seconds);
}

}  // namespace

/// The thread and all that belongs to it; requests come in through a queue.
class LiveSource::Runner {
 public:
  Runner(scene::Robot robot, const LiveSettings& settings)
      : state_(std::move(robot), settings.controller),
        playing_(settings.playing),
        speed_(settings.speed) {}
  ~Runner() { stop(); }
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  const Description& description() const { return state_.description(); }

  void start(Publisher& publisher) {
    publisher_ = &publisher;
    thread_ = std::thread([this] { run(); });
  }

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

  void submit(const Request& request, std::function<void(Outcome)> done) {
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back({request, std::move(done)});
    }
    wake_.notify_one();
  }

 private:
  struct Item {
    Request request;
    std::function<void(Outcome)> done;
  };

  void run();
  void carry_out(Item& item);
  void handle(const Request& request);
  void advance();
  void restart_clock();
  void measure_factor();
  void publish();
  bool stopping() {
    const std::lock_guard lock(mutex_);
    return stopping_;
  }

  RobotState state_;
  Publisher* publisher_ = nullptr;
  std::thread thread_;
  std::mutex mutex_;  // of the next three
  std::condition_variable wake_;
  std::deque<Item> queue_;
  bool stopping_ = false;

  // The thread's own.
  bool playing_;
  double speed_;
  bool dirty_ = true;  ///< something has changed since the last frame
  Clock::time_point clock_start_, factor_start_, last_publication_;
  double time_start_ = 0.0, factor_time_ = 0.0;  ///< s, simulated
  double factor_ = 0.0;
  std::string last_status_;
};

void LiveSource::Runner::restart_clock() {
  clock_start_ = Clock::now();
  time_start_ = state_.simulation().time();
  factor_start_ = clock_start_;
  factor_time_ = time_start_;
}

void LiveSource::Runner::run() {
  restart_clock();
  while (true) {
    std::deque<Item> items;
    {
      std::unique_lock lock(mutex_);
      const bool free_running = playing_ && speed_ == 0.0;
      if (!free_running && queue_.empty() && !stopping_ && !dirty_) {
        if (playing_) {
          const double next = state_.simulation().time() + state_.time_step() - time_start_;
          wake_.wait_until(lock, clock_start_ + ticks(Seconds(next / speed_)));
        } else {
          wake_.wait(lock, [&] { return stopping_ || !queue_.empty(); });
        }
      }
      if (stopping_) return;
      items.swap(queue_);
    }
    for (Item& item : items) carry_out(item);
    if (playing_) advance();
    measure_factor();
    const auto now = Clock::now();
    if (dirty_ && (!playing_ || now - last_publication_ >= kFrameTime)) {
      publish();
    } else if (dirty_ && speed_ != 0.0) {
      // Played slower than frames come: the rest of the frame's time is nobody's.
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, last_publication_ + ticks(kFrameTime),
                       [&] { return stopping_ || !queue_.empty(); });
    }
  }
}

// Steps until simulated time has caught up with the clock, or a frame's time is over.
void LiveSource::Runner::advance() {
  const auto begin = Clock::now();
  while (playing_) {
    if (speed_ > 0.0) {
      const double due = time_start_ + speed_ * Seconds(Clock::now() - clock_start_).count();
      const double end = state_.simulation().time() + state_.time_step();
      if (end > due + 1e-9) break;
      if (Seconds((due - end) / speed_) > kLargestLag) restart_clock();
    }
    state_.step();
    dirty_ = true;
    if (state_.stopped()) playing_ = false;
    if (Clock::now() - begin >= kFrameTime) break;
  }
}

void LiveSource::Runner::measure_factor() {
  if (!playing_) {
    factor_ = 0.0;
    return;
  }
  const auto now = Clock::now();
  const Seconds since = now - factor_start_;
  if (since < kFactorTime) return;
  const double time = state_.simulation().time();
  factor_ = (time - factor_time_) / since.count();
  factor_start_ = now;
  factor_time_ = time;
}

void LiveSource::Runner::carry_out(Item& item) {
  Outcome outcome;
  try {
    handle(item.request);
  } catch (const Error& error) {
    outcome = error;
  } catch (const std::exception& error) {
    outcome = Error(ErrorKind::internal, {}, error.what(), "please report this");
  }
  dirty_ = true;
  item.done(outcome);
}

void LiveSource::Runner::handle(const Request& request) {
  const auto stopped_run = [&] {
    if (!state_.stopped()) return;
    throw Error(ErrorKind::diverged, {}, "the run has stopped: " + state_.stopped()->message,
                "reset it first");
  };
  if (std::holds_alternative<Play>(request)) {
    stopped_run();
    playing_ = true;
    restart_clock();
  } else if (std::holds_alternative<Pause>(request)) {
    playing_ = false;
  } else if (const auto* step = std::get_if<Step>(&request)) {
    stopped_run();
    playing_ = false;
    for (std::int64_t k = 0; k < step->count && !state_.stopped() && !stopping(); ++k) {
      state_.step();
      dirty_ = true;
      if (Clock::now() - last_publication_ >= kFrameTime) publish();
    }
    stopped_run();
  } else if (std::holds_alternative<Reset>(request)) {
    state_.reset();
    restart_clock();
  } else if (std::holds_alternative<Settle>(request)) {
    state_.settle();
  } else if (const auto* speed = std::get_if<Speed>(&request)) {
    speed_ = speed->factor;
    restart_clock();
  } else if (const auto* command = std::get_if<SetCommand>(&request)) {
    state_.command(*command);
  } else if (const auto* controller = std::get_if<ChooseController>(&request)) {
    state_.choose_controller(controller->name);
  } else if (const auto* target = std::get_if<SetTarget>(&request)) {
    state_.set_target(*target);
  } else if (const auto* pull = std::get_if<Pull>(&request)) {
    state_.pull(*pull);
  } else if (std::holds_alternative<Release>(request)) {
    state_.release();
  } else {
    throw Error(ErrorKind::not_in_this_version, {}, "a live robot cannot do this", "");
  }
}

void LiveSource::Runner::publish() {
  std::array<bool, kFieldCount> wanted{};
  for (int f = 0; f < kFieldCount; ++f) {
    wanted[static_cast<std::size_t>(f)] = publisher_->wants_field(f);
  }
  publisher_->publish(state_.frame(wanted, factor_));
  last_publication_ = Clock::now();
  dirty_ = false;
  const bool slow = playing_ && speed_ > 0.0 && factor_ > 0.0 && factor_ < kSlow * speed_;
  std::string status = fmt::format(R"({{"playing":{},"speed":{},"slow":{},{})", playing_, speed_,
                                   slow, state_.status_members().substr(1));
  if (status == last_status_) return;
  last_status_ = status;
  publisher_->publish_status(std::move(status));
}

LiveSource::LiveSource(scene::Robot robot, const LiveSettings& settings)
    : runner_(std::make_unique<Runner>(std::move(robot), settings)) {}
LiveSource::~LiveSource() = default;
const Description& LiveSource::description() const { return runner_->description(); }
void LiveSource::start(Publisher& publisher) { runner_->start(publisher); }
void LiveSource::stop() { runner_->stop(); }
void LiveSource::submit(const Request& request, std::function<void(Outcome)> done) {
  runner_->submit(request, std::move(done));
}
void LiveSource::fetch(std::string_view, std::function<void(std::optional<Download>)> done) {
  done(std::nullopt);
}

}  // namespace sinew::viewer
