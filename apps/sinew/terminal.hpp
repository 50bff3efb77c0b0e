/// @file
/// Progress, warnings and interruption of the program in a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/notice.hpp"

namespace sinew::cli {

/// Thrown by work that a signal ends early. It is not an error.
struct Interrupted {};

/// While it exists, the first Ctrl-C or SIGTERM only sets a flag, so that work can stop in a
/// consistent state. A second one ends the program immediately.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Whether a signal was received.
  static bool requested();
  /// Throws Interrupted if a signal was received.
  static void check();
};

/// A progress bar on standard error.
class ProgressBar {
 public:
  /// @param total amount of work. @param shown whether it is drawn at all.
  ProgressBar(std::int64_t total, bool shown);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Redraws the bar, at most ten times a second and only if standard error is a terminal.
  /// @param done amount of work so far. @param note text after the bar.
  void update(std::int64_t done, const std::string& note);
  /// Whether update() would draw now, so that its note is worth composing.
  bool due() const;
  /// Reports work that is stuck for long: like update() on a terminal, else prints a line every ten
  /// seconds.
  void update_slow(std::int64_t done, const std::string& note);
  /// Whether update_slow() would draw or print now.
  bool slow_due() const;

 private:
  std::int64_t total_;
  bool shown_, terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

/// Prints warnings on standard error, one line each, in the format of errors. Omits remarks.
void print_warnings(std::span<const Notice> notices);

/// Formats a table with aligned columns.
/// @param rows of cells; the first column is left-aligned, the others are right-aligned.
std::string format_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace sinew::cli
