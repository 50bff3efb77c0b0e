// A progress bar on a terminal; nothing elsewhere.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace sinew::cli {

class Progress {
 public:
  Progress(long total, bool wanted) : total_(total), shown_(wanted && isatty(STDERR_FILENO) != 0) {}
  ~Progress() { clear(); }

  void show(long done, const std::string& note) {
    const auto now = Clock::now();
    if (!shown_ || (done < total_ && now - last_ < std::chrono::milliseconds(100))) return;
    last_ = now;
    const int filled = total_ > 0 ? static_cast<int>(kWidth * done / total_) : kWidth;
    fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {:3d} %  {}\033[K", "", filled, "", kWidth - filled,
               total_ > 0 ? 100 * done / total_ : 100, note);
    std::fflush(stderr);
    drawn_ = true;
  }
  void clear() {
    if (drawn_) fmt::print(stderr, "\r\033[K");
    drawn_ = false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kWidth = 40;
  long total_;
  bool shown_;
  bool drawn_ = false;
  Clock::time_point last_{};
};

}  // namespace sinew::cli
