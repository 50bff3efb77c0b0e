#include "source_thread.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "fields.hpp"

namespace sinew::viewer {

namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kFrameTime{1.0 / 60.0};
/// Lag behind the clock at which a run gives up catching up.
constexpr Seconds kLargestLag{0.1};
constexpr double kSlow = 0.9;

std::chrono::steady_clock::duration ticks(Seconds seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(seconds);
}

}  // namespace

SourceThread::~SourceThread() { end(); }

void SourceThread::start(Publisher& publisher) {
  publisher_ = &publisher;
  thread_ = std::thread([this] { run(); });
}

void SourceThread::stop() { end(); }

void SourceThread::end() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

bool SourceThread::stopping() {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

void SourceThread::enqueue(std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back({std::move(work)});
  }
  wake_.notify_one();
}

void SourceThread::submit(const Request& request, std::function<void(Outcome)> done) {
  enqueue([this, request, done = std::move(done)] { carry_out(request, done); });
}

void SourceThread::fetch(std::string_view name, std::function<void(std::optional<Download>)> done) {
  enqueue([this, name = std::string(name), done = std::move(done)] { done(download(name)); });
}

void SourceThread::align_clock() {
  clock_start_ = Clock::now();
  time_start_ = time();
}

void SourceThread::restart_clock() {
  align_clock();
  factor_.restart();
  factor_.add(clock_start_, time_start_);
}

void SourceThread::run() {
  publish();
  begin();
  restart_clock();
  while (true) {
    std::deque<Item> items;
    {
      std::unique_lock lock(mutex_);
      const bool free_running = runs() && speed_ == 0.0;
      if (!free_running && queue_.empty() && !stopping_ && !dirty_) {
        const auto called = [&] { return stopping_ || !queue_.empty(); };
        if (runs()) {
          const double next = time() + time_step() - time_start_;
          wake_.wait_until(lock, clock_start_ + ticks(Seconds(next / speed_)), called);
        } else {
          wake_.wait(lock, called);
        }
      }
      if (stopping_) return;
      items.swap(queue_);
    }
    for (const Item& item : items) item.work();
    if (runs()) catch_up();
    measure_factor();
    if (!dirty_) continue;
    if (!playing_ || Clock::now() >= frame_due_) {
      publish();
    } else if (speed_ != 0.0) {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, frame_due_, [&] { return stopping_ || !queue_.empty(); });
    }
  }
}

bool SourceThread::asked() {
  const std::lock_guard lock(mutex_);
  return stopping_ || !queue_.empty();
}

// Steps until simulated time has caught up with the clock, the time of a frame is over, or a
// request arrives.
void SourceThread::catch_up() {
  const auto begin = Clock::now();
  while (playing_) {
    if (speed_ > 0.0) {
      const double due = time_start_ + speed_ * Seconds(Clock::now() - clock_start_).count();
      const double next = time() + time_step();
      if (next > due + 1e-9) break;
      if (Seconds((due - next) / speed_) > kLargestLag) align_clock();
    }
    if (!advance()) playing_ = false;
    dirty_ = true;
    if (Clock::now() - begin >= kFrameTime || asked()) break;
  }
}

void SourceThread::measure_factor() {
  if (runs()) {
    factor_.add(Clock::now(), time());
  } else {
    factor_.restart();
  }
}

void SourceThread::carry_out(const Request& request, const std::function<void(Outcome)>& done) {
  Outcome outcome;
  try {
    do_request(request);
  } catch (const Error& error) {
    outcome = error;
  } catch (const std::exception& error) {
    outcome = Error(ErrorKind::internal, {}, error.what(), "please report this");
  }
  dirty_ = true;
  done(outcome);
}

void SourceThread::do_request(const Request& request) {
  if (std::holds_alternative<Play>(request)) {
    try_again();
    require_ready();
    playing_ = true;
    awaits_page_ = false;
    restart_clock();
  } else if (std::holds_alternative<Ready>(request)) {
    if (std::exchange(awaits_page_, false)) restart_clock();
  } else if (std::holds_alternative<Pause>(request)) {
    playing_ = false;
  } else if (const auto* step = std::get_if<Step>(&request)) {
    try_again();
    require_ready();
    playing_ = false;
    for (std::int64_t k = 0; k < step->count && !stopping() && advance(); ++k) {
      dirty_ = true;
      if (Clock::now() >= frame_due_) publish();
    }
    require_ready();
  } else if (const auto* speed = std::get_if<Speed>(&request)) {
    speed_ = speed->factor;
    restart_clock();
  } else if (!std::holds_alternative<ChooseField>(request) &&
             !std::holds_alternative<Pick>(request) &&
             !std::holds_alternative<ShowInside>(request)) {  // which the publisher handles
    handle(request);
  }
}

void SourceThread::publish() {
  FrameWishes wishes{std::vector<bool>(list_fields().size()), publisher_->picks(),
                     publisher_->wants_inside()};
  for (std::size_t f = 0; f < wishes.fields.size(); ++f) {
    wishes.fields[f] = publisher_->wants_field(static_cast<int>(f));
  }
  const double factor = factor_.value();
  const bool slow = playing_ && speed_ > 0.0 && factor < kSlow * speed_;
  std::string status = fmt::format(R"({{"playing":{},"speed":{},"slow":{},{})", playing_, speed_,
                                   slow, status_members().substr(1));
  // The status is published first, so that a receiver of the frame has its status.
  if (status != last_status_) {
    last_status_ = status;
    publisher_->publish_status(std::move(status));
  }
  publisher_->publish(frame(wishes, factor));
  // Keeps an average of 60 frames per second, even if one of them is late.
  frame_due_ = std::max(frame_due_, Clock::now() - ticks(kFrameTime)) + ticks(kFrameTime);
  dirty_ = false;
}

}  // namespace sinew::viewer
