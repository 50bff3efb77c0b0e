#include "sinew/identify/actuator_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/identify/motion_record.hpp"

namespace sinew::identify {

namespace {

/// The volume as the input of a motion record.
InputSignal signal_of(const ActuatorRecord& record) {
  MotionRecord motion;
  motion.time = record.time;
  motion.input = record.volume;
  return InputSignal(motion);
}

void check(std::span<const ActuatorRecord> records) {
  if (records.empty()) {
    throw Error(ErrorKind::empty_list, {.item = "records"}, "there is no record",
                "give one or more");
  }
  for (const ActuatorRecord& record : records) {
    const Eigen::Index n = record.time.size();
    if (record.volume.size() != n || record.torque.size() != n) {
      throw Error(ErrorKind::wrong_length, {.item = record.name},
                  fmt::format("{} times, {} volumes, {} torques", n, record.volume.size(),
                              record.torque.size()),
                  "give one of each");
    }
    MotionRecord motion;
    motion.name = record.name;
    motion.time = record.time;
    motion.input = record.volume;
    motion.position = MatrixX::Zero(n, 3);
    check(motion);
  }
}

}  // namespace

ActuatorFit fit_actuator(std::span<const ActuatorRecord> records, bool linear, double longest_delay,
                         const ParameterFitSettings& settings) {
  check(records);
  std::vector<InputSignal> signals;
  ForwardModel model;
  for (const ActuatorRecord& record : records) {
    signals.push_back(signal_of(record));
    model.observations += record.time.size();
  }
  VectorX measured(model.observations);
  Eigen::Index row = 0;
  for (const ActuatorRecord& record : records) {
    measured.segment(row, record.time.size()) = record.torque;
    row += record.time.size();
  }
  model.predict = [&](const VectorX& p, VectorX& prediction, MatrixX* jacobian) {
    const pcc::FluidicActuator actuator{p[2], p[0], p[1]};
    Eigen::Index at = 0;
    for (std::size_t k = 0; k < records.size(); ++k) {
      for (const double time : records[k].time) {
        const auto volume = signals[k].at(0, time - actuator.delay);
        prediction[at] = actuator.torque(volume.value);
        if (jacobian != nullptr) {
          jacobian->row(at) << std::pow(volume.value, 3),
              -actuator.slope(volume.value) * volume.rate, volume.value;
        }
        ++at;
      }
    }
  };
  // The cost has a local minimum in the delay for every period of the volume. The search starts
  // from the best delay of a scan, with the c that is best there.
  constexpr int kScan = 50;
  double best = std::numeric_limits<double>::infinity(), cubic = 0.0, delay = 0.0, largest = 0.0;
  VectorX unit(model.observations);
  for (int i = 0; i <= kScan; ++i) {
    const double tried = longest_delay * i / kScan;
    model.predict(VectorX{{1.0, tried, 0.0}}, unit, nullptr);
    double product = 0.0, square = 0.0;
    for (Eigen::Index r = 0; r < unit.size(); ++r) {
      largest = std::max(largest, std::cbrt(std::abs(unit[r])));
      if (std::isnan(measured[r])) continue;
      product += unit[r] * measured[r];
      square += unit[r] * unit[r];
    }
    const double gained = square > 0.0 ? product * std::max(product, 0.0) / square : 0.0;
    if (gained > 0.0 && -gained < best) {
      best = -gained;
      cubic = product / square;
      delay = tried;
    }
  }
  if (!(cubic > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "records"},
                "torque does not grow with the volume's cube at any delay",
                "check the volumes' signs and that they vary");
  }
  const std::vector<Parameter> parameters = {
      {"cubic", cubic, 0.0, kInfinity, "N m/m^9", false, cubic},
      {"delay", delay, 0.0, longest_delay, "s", false, 0.02 * longest_delay},
      {"linear", 0.0, 0.0, kInfinity, "N m/m^3", !linear, cubic * largest * largest}};
  ActuatorFit result;
  result.fit = fit_parameters(model, measured, parameters, settings);
  result.actuator = {result.fit.values[2], result.fit.values[0], result.fit.values[1]};
  return result;
}

}  // namespace sinew::identify
