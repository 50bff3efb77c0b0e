/// @file
/// Attachment of the electrodes of capacitive sensors.
#pragma once

#include <vector>

#include "sinew/constraint/electrode_probe.hpp"
#include "sinew/sim/sensor_settings.hpp"

namespace sinew::sim {

class Attacher;

/// The triangles of an electrode. Opposite the middle of each, the point of the other electrode
/// that is nearest at rest is attached. @param attacher of the sensor.
/// @param own,other the two electrodes.
/// @param place source location of the sensor. Throws Error(zero-volume) if the electrodes touch or
///   have no faces.
std::vector<constraint::ElectrodeTriangle> attach_electrode(
    Attacher& attacher, const SensorCapacitance::Electrode& own,
    const SensorCapacitance::Electrode& other, const Location& place);

}  // namespace sinew::sim
