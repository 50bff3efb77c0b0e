#include "terminal.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/whole.hpp"

namespace sinew::cli {

namespace {

// Signal handlers can access only globals.
volatile std::sig_atomic_t interrupted = 0;

void note_interrupt(int) { interrupted = 1; }

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kLogPause{10};
constexpr std::array<int, 2> kSignals = {SIGINT, SIGTERM};

}  // namespace

Interrupt::Interrupt() {
  interrupted = 0;
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

Interrupt::~Interrupt() {
  for (const int signal : kSignals) std::signal(signal, SIG_DFL);
}

bool Interrupt::requested() { return interrupted != 0; }

void Interrupt::check() {
  if (requested()) throw Interrupted{};
}

ProgressBar::ProgressBar(std::int64_t total, bool shown)
    : total_(std::max<std::int64_t>(total, 1)),
      shown_(shown),
      terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

bool ProgressBar::slow_due() const {
  return terminal_ ? due() : shown_ && std::chrono::steady_clock::now() - last_ >= kLogPause;
}

void ProgressBar::update_slow(std::int64_t done, const std::string& note) {
  if (terminal_) return update(done, note);
  if (!slow_due()) return;
  last_ = std::chrono::steady_clock::now();
  fmt::print(stderr, "sinew: {}\n", note);
  std::fflush(stderr);
}

bool ProgressBar::due() const {
  return shown_ && terminal_ && std::chrono::steady_clock::now() - last_ >= kRedraw;
}

void ProgressBar::update(std::int64_t done, const std::string& note) {
  if (!due()) return;
  last_ = std::chrono::steady_clock::now();
  drawn_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total_);
  const int filled = whole<int>(share * kBarWidth, 0, kBarWidth);
  fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3.0f} %  {}", "", filled, "", kBarWidth - filled,
             100.0 * share, note);
  std::fflush(stderr);
}

void print_warnings(std::span<const Notice> notices) {
  for (const Notice& notice : notices) {
    if (notice.level != NoticeLevel::warning) continue;
    fmt::print(stderr, "sinew: warning: {}\n", notice.text());
  }
}

std::string format_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      line += c == 0 ? fmt::format("{:<{}}", row[c], widths[c])
                     : fmt::format("  {:>{}}", row[c], widths[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace sinew::cli
