// The state of a controller between steps, as numbers of a saved state.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/control/inverse_controller.hpp"

namespace sinew::control {

namespace {

// The first numbers: steps known (0, 1, or 2 for more), time, surprise, prediction, damping,
// status, largest_asked().
constexpr std::size_t kKnown = 7;

}  // namespace

// All that a step leaves to the next one, apart from the numbers that may be infinite or NaN.
template <class Self, class Visitor>
void InverseController::visit_memory(Self& self, Visitor&& visitor) {
  for (auto& target : self.asked_) {
    for (Eigen::Index k = 0; k < 3; ++k) visitor(target[k]);
  }
  for (auto& gap : self.gap_before_) visitor(gap);
  for (auto& gap : self.foreseen_) visitor(gap);
  for (auto& change : self.change_) visitor(change);
  for (auto& motion : self.expected_) visitor(motion);
  for (auto& effort : self.efforts_) visitor(effort);
}

// Infinity and NaN stand for "not yet known": before the first step, and after it until the next.
void InverseController::forget() {
  program_.forget();
  damping_.set(1.0);
  time_ = -std::numeric_limits<double>::infinity();
  surprise_ = came_ = std::numeric_limits<double>::infinity();
  predicted_error_ = std::numeric_limits<double>::quiet_NaN();
  status_ = ControllerStatus::not_started;
  visit_memory(*this, [](double& number) { number = 0.0; });
}

std::size_t InverseController::memory_size() const {
  std::size_t size = kKnown;
  visit_memory(*this, [&](double) { ++size; });
  return size;
}

void InverseController::save_memory(std::span<double> memory) const {
  const bool started = std::isfinite(time_), judged = started && std::isfinite(surprise_);
  const double known[kKnown] = {static_cast<double>(started) + static_cast<double>(judged),
                                started ? time_ : 0.0,
                                judged ? surprise_ : 0.0,
                                started ? predicted_error_ : 0.0,
                                damping_.value(),
                                static_cast<double>(status_),
                                program_.largest_asked()};
  std::ranges::copy(known, memory.begin());
  auto to = memory.begin() + kKnown;
  visit_memory(*this, [&](double number) { *to++ = number; });
}

void InverseController::load_memory(std::span<const double> memory) {
  forget();
  if (memory[0] >= 1.0) {
    time_ = memory[1];
    predicted_error_ = memory[3];
  }
  if (memory[0] >= 2.0) surprise_ = memory[2];
  damping_.set(memory[4]);
  status_ = controller_status_of(memory[5]);
  program_.set_largest_asked(memory[6]);
  auto from = memory.begin() + kKnown;
  visit_memory(*this, [&](double& number) { number = *from++; });
}

}  // namespace sinew::control
