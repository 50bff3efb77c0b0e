/// @file
/// A source with a thread of its own that goes on in time with the clock: what running robots and
/// recorded runs have in common.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "real_time_factor.hpp"
#include "source.hpp"

namespace sinew::viewer {

/// Requests are carried out between steps, in the order in which they came. All protected functions
/// are called on the thread.
class SourceThread : public Source {
 public:
  ~SourceThread() override;
  void start(Publisher& publisher) override;
  void stop() override;
  void submit(const Request& request, std::function<void(Outcome)> done) override;
  /// Does not play until a page has drawn its first frame, so that it sees the run from its start,
  /// or until it is asked to. Before start().
  void await_page() { awaits_page_ = true; }
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override;

 protected:
  /// @param playing,speed from the start on; speed 0: as fast as it can.
  SourceThread(bool playing, double speed) : playing_(playing), speed_(speed) {}

  /// Once, after the first frame.
  virtual void begin() {}
  virtual double time() const = 0;       ///< s, simulated
  virtual double time_step() const = 0;  ///< s
  /// Goes on by one step; false when that is not possible any more.
  virtual bool advance() = 0;
  /// Carries out a request other than play, pause, step and speed. Throws Error.
  virtual void handle(const Request& request) = 0;
  /// Throws Error when play and step are refused.
  virtual void require_ready() const {}
  /// @param wishes beside positions. @param real_time_factor NaN: not measured.
  virtual std::shared_ptr<const Frame> frame(const FrameWishes& wishes,
                                             double real_time_factor) = 0;
  /// JSON object of the status message without playing, speed and slow.
  virtual std::string status_members() const = 0;
  /// "run.csv" and the like; none unless overridden.
  virtual std::optional<Download> download(std::string_view) { return std::nullopt; }

  void pause() { playing_ = false; }
  /// Whether end() waits for the thread.
  bool stopping();
  Publisher& publisher() { return *publisher_; }
  /// Time was changed other than by advance().
  void restart_clock();
  /// Ends the thread; for destructors of classes whose functions it calls.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  struct Item {
    std::function<void()> work;
  };

  void run();
  void carry_out(const Request& request, const std::function<void(Outcome)>& done);
  void do_request(const Request& request);
  void catch_up();
  void measure_factor();
  void align_clock();
  bool runs() const { return playing_ && !awaits_page_; }
  void publish();
  bool asked();
  void enqueue(std::function<void()> work);

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
  bool awaits_page_ = false;
  Clock::time_point clock_start_, frame_due_;
  double time_start_ = 0.0;  ///< s, simulated
  RealTimeFactor factor_;
  std::string last_status_;
};

}  // namespace sinew::viewer
