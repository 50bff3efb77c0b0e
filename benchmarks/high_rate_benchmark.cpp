// Times one period of a high-rate loop with eight driven rows, three unknown forces estimated from
// fourteen sensors, a task of three rows, one hand, and contacts near their surfaces. The robot
// moves, and there is a new snapshot every ten periods. The last table is measured on the loop's
// own thread at 1 kHz.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>
#include <vector>

#include <time.h>

#include "sinew/high_rate/high_rate_loop.hpp"
#include "sinew/high_rate/high_rate_step.hpp"

#include "snapshots.hpp"

namespace {

using namespace sinew;
using namespace sinew::high_rate;

HighRateSettings robot(int contacts) {
  HighRateSettings settings = sinew::testing::robot_settings(1, contacts);
  sinew::testing::add_sensors(settings);
  for (SensorRow& sensor : settings.sensors) sensor.noise = 1e-4;
  return settings;
}

// Sets the efforts of contacts to those without actuation.
void settle(const HighRateSettings& settings, Snapshot& snapshot) {
  TouchLaw law(settings);
  law.begin(snapshot);
  VectorX hands(static_cast<Eigen::Index>(settings.hands.size()));
  hands.setConstant(std::nan(""));
  law.settle(VectorX::Zero(settings.driving()), hands);
  snapshot.effort.tail(law.rows()) = law.effort();
}

// A bending robot, whose W and gaps change little between snapshots.
std::vector<Snapshot> bending(const HighRateSettings& settings, double friction, int count) {
  Random random(1);
  Snapshot first = sinew::testing::random_snapshot(settings, random, friction);
  const Snapshot last = sinew::testing::random_snapshot(settings, random, friction);
  std::vector<Snapshot> snapshots;
  for (int k = 0; k < count; ++k) {
    const double share = 0.1 * (0.5 - 0.5 * std::cos(2.0 * 3.14159265 * k / count));
    Snapshot snapshot = first;
    snapshot.compliance += share * (last.compliance - first.compliance);
    snapshot.free += share * (last.free - first.free);
    settle(settings, snapshot);
    snapshots.push_back(snapshot);
  }
  return snapshots;
}

void move(HighRateInput& input, int period) {
  const double time = 1e-3 * period;
  for (Eigen::Index k = 0; k < input.sensors.size(); ++k) {
    input.sensors[k] = 1e-4 * std::sin(3.0 * time + static_cast<double>(k));
  }
  input.hands[0] = 2e-3 * std::sin(12.0 * time);
  for (Eigen::Index k = 0; k < input.targets.size(); ++k) {
    input.targets[k] = 2e-3 * std::sin(2.0 * time + static_cast<double>(k));
  }
}

double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void step(int contacts, double friction, int periods) {
  const HighRateSettings settings = robot(contacts);
  const std::vector<Snapshot> snapshots = bending(settings, friction, 100);
  HighRateStep high_rate(settings);
  HighRateInput input = HighRateInput::none(settings);
  std::vector<double> times;
  int closed = 0;
  for (int k = 0; k < periods; ++k) {
    move(input, k);
    const bool refresh = k % 10 == 0;
    Snapshot fresh = refresh ? snapshots[static_cast<std::size_t>(k / 10) % 100] : Snapshot{};
    const double begin = processor_time();
    const HighRateOutput& output = high_rate.step(refresh ? &fresh : nullptr, input, {});
    times.push_back(1e6 * (processor_time() - begin));
    for (int c = 0; c < contacts; ++c) closed += output.contacts[3 * c] > 0.0 ? 1 : 0;
  }
  std::ranges::sort(times);
  const auto part = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  std::printf("| %d | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f |\n", contacts, friction,
              static_cast<double>(closed) / periods, part(0.5), part(0.99), part(0.999), part(1.0));
}

void loop(double seconds) {
  const HighRateSettings settings = robot(12);
  const std::vector<Snapshot> snapshots = bending(settings, 0.0, 100);
  HighRateLoop high_rate(settings);
  high_rate.start();
  HighRateInput input = HighRateInput::none(settings);
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < static_cast<int>(100.0 * seconds); ++k) {  // the model runs at 100 Hz
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(10 * k));
    high_rate.publish(snapshots[static_cast<std::size_t>(k) % 100]);
    move(input, 10 * k);
    high_rate.set_input(input);
  }
  high_rate.stop();
  const HighRateReport report = high_rate.report();
  std::printf(
      "\nThread at 1 kHz for %g s, snapshots at 100 Hz: %s; %lld of %lld periods missed\n\n",
      seconds, report.scheduling.c_str(), static_cast<long long>(report.missed),
      static_cast<long long>(report.periods + report.missed));
  std::printf("| us | median | 99 %% | 99.9 %% | longest |\n|---|---|---|---|---|\n");
  const auto row = [](const char* name, const TimeHistogram& times) {
    std::printf("| %s | %.0f | %.0f | %.0f | %.0f |\n", name, 1e6 * times.quantile(0.5),
                1e6 * times.quantile(0.99), 1e6 * times.quantile(0.999), 1e6 * times.longest());
  };
  row("a period's beginning, after it was due", high_rate.lateness());
  row("a period's work", high_rate.work());
  std::printf("\n| begins late by, us | periods |\n|---|---|\n");
  const std::vector<std::int64_t> counts = high_rate.lateness().counts();
  const int edges[] = {0, 5, 10, 20, 50, 100, 200, 500, 1000};
  for (std::size_t k = 0; k + 1 < std::size(edges); ++k) {
    std::int64_t sum = 0;
    for (int bin = edges[k]; bin < edges[k + 1]; ++bin)
      sum += counts[static_cast<std::size_t>(bin)];
    std::printf("| %d to %d | %lld |\n", edges[k], edges[k + 1], static_cast<long long>(sum));
  }
  std::printf("| 1000 and more | %lld |\n", static_cast<long long>(counts.back()));
}

}  // namespace

int main(int count, char** arguments) {
  const bool quick = count > 1 && std::strcmp(arguments[1], "--quick") == 0;
  const int periods = quick ? 5000 : 50000;
  std::printf(
      "Processor time of a period, us\n\n"
      "| contacts | friction | of them closed | median | 99 %% | 99.9 %% | longest |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const double friction : {0.0, 0.3}) {
    for (const int contacts : {0, 4, 12, 24}) step(contacts, friction, periods);
  }
  loop(quick ? 2.0 : 60.0);
  return 0;
}
