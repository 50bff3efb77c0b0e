#include "sinew/high_rate/clock.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include "sinew/core/whole.hpp"

namespace sinew::high_rate {

namespace {

constexpr double kNano = 1e-9;
constexpr int kPriority = 40;  // kernel threads of interrupts have 50

}  // namespace

double MonotonicClock::now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + kNano * static_cast<double>(time.tv_nsec);
}

void MonotonicClock::sleep_until(double time) {
  const double seconds = std::floor(time);
  const timespec until{whole<std::time_t>(seconds),
                       whole<long>((time - seconds) / kNano, 0, 999'999'999)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

std::string request_real_time() {
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  const int failure = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (failure == 0) return {};
  return fmt::format(
      "SCHED_FIFO was refused ({}); allow a priority of {} by `ulimit -r {}` or "
      "CAP_SYS_NICE",
      std::strerror(failure), kPriority, kPriority);
}

}  // namespace sinew::high_rate
