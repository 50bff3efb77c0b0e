#include "sinew/plan/drive_channel.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"

namespace sinew::plan {

void check_channels(const std::vector<DriveChannel>& channels, Eigen::Index inputs, double lead,
                    const char* item) {
  if (channels.empty() || static_cast<Eigen::Index>(channels.size()) != inputs) {
    throw Error(ErrorKind::wrong_length, {.item = item},
                fmt::format("{} actuators and cylinders for {} inputs", channels.size(), inputs),
                "give one for each input");
  }
  for (const DriveChannel& channel : channels) {
    channel.actuator.check();
    channel.cylinder.check();
    if (channel.cylinder.sample_time != channels.front().cylinder.sample_time) {
      throw Error(ErrorKind::out_of_range, {.item = item},
                  fmt::format("cylinders are sampled by {:g} s and {:g} s",
                              channels.front().cylinder.sample_time, channel.cylinder.sample_time),
                  "give cylinders of one sample time");
    }
    if (!(lead >= channel.actuator.delay) || !std::isfinite(lead)) {
      throw Error(ErrorKind::out_of_range, {.item = item},
                  fmt::format("the lead is {:g} s, a delay {:g} s", lead, channel.actuator.delay),
                  "give a lead of at least the longest delay");
    }
  }
}

Eigen::Index sample_count(const pcc::DriveCylinder& cylinder, double seconds) {
  return whole_count<Eigen::Index>(std::ceil(seconds / cylinder.sample_time - 1e-9) + 1.0, 1e9,
                                   "samples of a drive", "shorten the plan");
}

}  // namespace sinew::plan
