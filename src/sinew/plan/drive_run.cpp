#include "sinew/plan/drive_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"

namespace sinew::plan {

std::array<double, 4> sample_weights(double fraction) {
  const double s = fraction, left = 1.0 - s;
  return {-0.5 * s * left * left, 1.0 + s * s * (1.5 * s - 2.5),
          1.0 + left * left * (1.5 * left - 2.5), -0.5 * left * s * s};
}

DriveRun::DriveRun(std::vector<DriveChannel> channels_given, MatrixX command_given,
                   double lead_given, VectorX rest)
    : channels(std::move(channels_given)), lead(lead_given), command(std::move(command_given)) {
  constexpr const char* kPlace = "drive run";
  check_channels(channels, command.cols(), lead, kPlace);
  const Eigen::Index count = command.rows();
  if (count < 2) {
    throw Error(ErrorKind::wrong_length, {.item = kPlace},
                fmt::format("{} samples are given", count), "give two or more");
  }
  if (rest.size() == 0) rest = VectorX::Zero(command.cols());
  if (rest.size() != command.cols()) {
    throw Error(ErrorKind::wrong_length, {.item = kPlace},
                fmt::format("{} commands at rest for {} inputs", rest.size(), command.cols()),
                "give one for each input, or none");
  }
  const double step = channels.front().cylinder.sample_time;
  times = VectorX::LinSpaced(count, 0.0, static_cast<double>(count - 1) * step);
  volume.resize(count, command.cols());
  for (Eigen::Index i = 0; i < command.cols(); ++i) {
    const pcc::DriveCylinder& cylinder = channels[static_cast<std::size_t>(i)].cylinder;
    volume.col(i) = cylinder.simulate(command.col(i), cylinder.rest(rest[i]));
  }
}

VectorX DriveRun::torque(double time) const {
  const Eigen::Index last = times.size() - 1;
  const double step = channels.front().cylinder.sample_time;
  VectorX result(command.cols());
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    const pcc::FluidicActuator& actuator = channels[static_cast<std::size_t>(i)].actuator;
    const double at =
        std::clamp((time + lead - actuator.delay) / step, 0.0, static_cast<double>(last));
    const auto j = whole<Eigen::Index>(at, 0, last - 1);
    const std::array<double, 4> weights = sample_weights(at - static_cast<double>(j));
    double value = 0.0;
    for (Eigen::Index m = 0; m < 4; ++m) {
      value += weights[static_cast<std::size_t>(m)] *
               volume(std::clamp<Eigen::Index>(j + m - 1, 0, last), i);
    }
    result[i] = actuator.torque(value);
  }
  return result;
}

}  // namespace sinew::plan
