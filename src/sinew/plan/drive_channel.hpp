/// @file
/// What drives an input of an arm: a cylinder that delivers a volume, and an actuator that makes a
/// torque of it.
#pragma once

#include <vector>

#include "sinew/pcc/drive_cylinder.hpp"
#include "sinew/pcc/fluidic_actuator.hpp"

namespace sinew::plan {

/// An actuator and the cylinder that drives it.
struct DriveChannel {
  pcc::FluidicActuator actuator;
  pcc::DriveCylinder cylinder;
};

/// Throws Error(wrong-length: not one a channel for each input | out-of-range: cylinders of several
/// sample times, a lead below a delay) and what the channels' own checks throw.
/// @param channels of the inputs. @param inputs of the arm. @param lead s, by which commands begin
/// before torques. @param item what the error names.
void check_channels(const std::vector<DriveChannel>& channels, Eigen::Index inputs, double lead,
                    const char* item);

/// Samples of a run of so many seconds, in a cylinder's sample time: the last is at its end or the
/// next after it.
/// @param cylinder that is driven. @param seconds of the run, lead included.
Eigen::Index sample_count(const pcc::DriveCylinder& cylinder, double seconds);

}  // namespace sinew::plan
