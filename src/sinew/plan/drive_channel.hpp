/// @file
/// The drive of one input of an arm: a cylinder that delivers a volume, and an actuator that turns
/// it into a torque.
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

/// Checks the channels of an arm. Throws Error: wrong-length (not one channel per input),
/// out-of-range (different sample times, a lead shorter than a delay), and what the checks of
/// actuator and cylinder throw.
/// @param channels of the inputs. @param inputs number of inputs of the arm. @param lead s, time by
/// which commands precede torques. @param item named in errors.
void check_channels(const std::vector<DriveChannel>& channels, Eigen::Index inputs, double lead,
                    const char* item);

/// Number of samples of a run at the sample time of a cylinder; the last sample is at or after the
/// end. @param cylinder that is driven. @param seconds duration of the run, including the lead.
Eigen::Index sample_count(const pcc::DriveCylinder& cylinder, double seconds);

}  // namespace sinew::plan
