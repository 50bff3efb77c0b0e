/// @file
/// What the program shows while it works, and how it is stopped.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/notice.hpp"

namespace sinew::cli {

/// Thrown by work that a signal ends early: no error.
struct Interrupted {};

/// While it lives, the first Ctrl-C or SIGTERM only raises a flag, so that work ends where it can
/// go on; a second one ends the program at once.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Whether one was received.
  static bool requested();
  /// Throws Interrupted if so.
  static void check();
};

/// A line on standard error that shows how far work has come.
class ProgressBar {
 public:
  /// @param total amount of work. @param shown false: never drawn.
  ProgressBar(std::int64_t total, bool shown);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Redraws at most ten times a second; nothing unless standard error is a terminal.
  /// @param done of the work. @param note behind the bar.
  void update(std::int64_t done, const std::string& note);
  /// True when a call of update() would draw, so that its note is worth making.
  bool due() const;
  /// Of work that does not go on for long: the same on a terminal, else a line every ten seconds.
  void update_slow(std::int64_t done, const std::string& note);
  /// As due().
  bool slow_due() const;

 private:
  std::int64_t total_;
  bool shown_, terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

/// Warnings on standard error, a line each, as errors are printed; remarks are left out.
void print_warnings(std::span<const Notice> notices);

/// Rows of text with columns under each other.
/// @param rows of cells; the first column is set left, the others right.
std::string format_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace sinew::cli
