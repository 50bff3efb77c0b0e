/// @file
/// A source with a thread of its own, which advances in time with the clock: the common base of
/// running robots and recorded runs.
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

/// Runs a source on a thread. Requests are carried out between steps, in the order of arrival. All
/// virtual protected functions are called on this thread.
class SourceThread : public Source {
 public:
  ~SourceThread() override;
  void start(Publisher& publisher) override;
  void stop() override;
  void submit(const Request& request, std::function<void(Outcome)> done) override;
  /// Delays playing until a page has drawn its first frame, so that it shows the run from the
  /// start, or until a page requests it. Call it before start().
  void await_page() { awaits_page_ = true; }
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override;

 protected:
  /// @param playing,speed initially; speed 0: as fast as possible.
  SourceThread(bool playing, double speed) : playing_(playing), speed_(speed) {}

  /// Called once, after the first frame.
  virtual void begin() {}
  virtual double time() const = 0;       ///< s, simulated
  virtual double time_step() const = 0;  ///< s
  /// Advances by one step; false if that is no longer possible.
  virtual bool advance() = 0;
  /// Carries out a request other than play, pause, step and speed. Throws Error.
  virtual void handle(const Request& request) = 0;
  /// Throws Error if play and step are to be refused.
  virtual void require_ready() const {}
  /// Called before play and step requests: a live robot whose step failed tries again from its last
  /// solved state.
  virtual void try_again() {}
  /// Makes a frame. @param wishes parts besides positions. @param real_time_factor NaN: not
  /// measured.
  virtual std::shared_ptr<const Frame> frame(const FrameWishes& wishes,
                                             double real_time_factor) = 0;
  /// JSON object with the members of the status message except playing, speed and slow.
  virtual std::string status_members() const = 0;
  /// A file such as "run.csv"; none unless overridden.
  virtual std::optional<Download> download(std::string_view) { return std::nullopt; }

  void pause() { playing_ = false; }
  /// Whether the thread is to end.
  bool stopping();
  Publisher& publisher() { return *publisher_; }
  /// Call it after time has changed other than by advance().
  void restart_clock();
  /// Ends the thread. Destructors of derived classes call it, since the thread calls their
  /// functions.
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
  std::mutex mutex_;  // protects the next three members
  std::condition_variable wake_;
  std::deque<Item> queue_;
  bool stopping_ = false;

  // Used only on the thread.
  bool playing_;
  double speed_;
  bool dirty_ = true;  ///< whether something has changed since the last frame
  bool awaits_page_ = false;
  Clock::time_point clock_start_, frame_due_;
  double time_start_ = 0.0;  ///< s, simulated
  RealTimeFactor factor_;
  std::string last_status_;
};

}  // namespace sinew::viewer
