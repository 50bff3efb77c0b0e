#include "sinew/high_rate/high_rate_settings.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::high_rate {

namespace {

void require(bool holds, const std::string& item, double value, const char* wanted) {
  if (holds) return;
  throw Error(ErrorKind::out_of_range, {.item = "high-rate loop: " + item},
              fmt::format("{} is {}", item, value), fmt::format("give {}", wanted));
}

void require_order(double least, double most, const std::string& item) {
  if (least <= most) return;
  throw Error(ErrorKind::contradictory_limits, {.item = "high-rate loop: " + item},
              fmt::format("the lower limit {} exceeds the upper one {}", least, most),
              "exchange them");
}

void require_row(int row, int begin, int end, const std::string& item, const char* whose) {
  if (row >= begin && row < end) return;
  throw Error(ErrorKind::index_out_of_range, {.item = "high-rate loop: " + item},
              fmt::format("row {} is none of {}, {} to {}", row, whose, begin, end - 1),
              "count driven, unknown, observed and hands' rows in this order from 0");
}

std::string entry(const char* list, std::size_t index, const char* key) {
  return fmt::format("{}[{}].{}", list, index, key);
}

void check_rows(const HighRateSettings& settings) {
  for (std::size_t i = 0; i < settings.driven.size(); ++i) {
    const DrivenRow& row = settings.driven[i];
    require_order(row.effort_min, row.effort_max, entry("driven", i, "effort"));
    require_order(row.motion_min, row.motion_max, entry("driven", i, "motion"));
    require(row.effort_rate > 0.0, entry("driven", i, "effort_rate"), row.effort_rate,
            "a rate > 0");
    require(row.release >= row.effort_min && row.release <= row.effort_max,
            entry("driven", i, "release"), row.release, "an effort within the limits");
  }
  for (std::size_t i = 0; i < settings.unknown.size(); ++i) {
    const UnknownRow& row = settings.unknown[i];
    require_order(row.min, row.max, entry("unknown", i, "force"));
    require(row.prior > 0.0 && std::isfinite(row.prior), entry("unknown", i, "prior"), row.prior,
            "a force > 0, N");
  }
  for (std::size_t i = 0; i < settings.hands.size(); ++i) {
    const HandRow& row = settings.hands[i];
    require(row.min <= 0.0, entry("hands", i, "min"), row.min, "a force <= 0, N");
    require(row.max >= 0.0, entry("hands", i, "max"), row.max, "a force >= 0, N");
  }
}

void check_uses(const HighRateSettings& settings) {
  const int free_rows = settings.free_rows();
  for (std::size_t i = 0; i < settings.sensors.size(); ++i) {
    const SensorRow& sensor = settings.sensors[i];
    require_row(sensor.row, 0, free_rows, entry("sensors", i, "row"), "the rows without hands");
    require(sensor.noise > 0.0 && std::isfinite(sensor.noise), entry("sensors", i, "noise"),
            sensor.noise, "a deviation > 0, m or rad");
  }
  for (std::size_t i = 0; i < settings.tasks.size(); ++i) {
    const TaskRow& task = settings.tasks[i];
    if (task.kind == TaskKind::motion) {
      require_row(task.row, 0, free_rows, entry("tasks", i, "row"), "the rows without hands");
    } else {
      require_row(task.row, free_rows, settings.first_contact(), entry("tasks", i, "row"),
                  "the hands' rows");
    }
    require(task.weight >= 0.0 && std::isfinite(task.weight), entry("tasks", i, "weight"),
            task.weight, "a weight >= 0");
  }
}

}  // namespace

void check(const HighRateSettings& settings) {
  require(settings.observed >= 0, "observed", settings.observed, "a number of rows >= 0");
  require(settings.max_contacts >= 0, "max_contacts", settings.max_contacts, "a number >= 0");
  require(settings.period >= 1e-4 && settings.period <= 0.1, "period", settings.period,
          "1e-4 to 0.1 s");
  require(settings.blend >= 0.0 && settings.blend <= 10.0, "blend", settings.blend, "0 to 10 s");
  require(settings.stale_after > 0.0, "stale_after", settings.stale_after, "a time > 0 s");
  require(settings.release_time > 0.0, "release_time", settings.release_time, "a time > 0 s");
  require(settings.epsilon > 0.0 && settings.epsilon <= 1.0, "epsilon", settings.epsilon,
          "a number within (0, 1]");
  require(settings.largest_step > 0.0, "largest_step", settings.largest_step, "a part > 0");
  require(settings.passivity.reserve >= 0.0, "passivity.reserve", settings.passivity.reserve,
          "a part >= 0");
  require(settings.passivity.damping_limit >= 0.0, "passivity.damping_limit",
          settings.passivity.damping_limit, "a factor >= 0");
  check_rows(settings);
  check_uses(settings);
}

}  // namespace sinew::high_rate
