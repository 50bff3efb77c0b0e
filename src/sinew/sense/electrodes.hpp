/// @file
/// Attachment of the electrodes of capacitive sensors.
#pragma once

#include <vector>

#include "sinew/constraint/electrode_probe.hpp"
#include "sinew/sense/sensor_settings.hpp"

namespace sinew::builder {
class Attacher;
}

namespace sinew::sense {

/// The triangles of an electrode. Opposite the middle of each, the point of the other electrode
/// that is nearest at rest is attached. @param attacher of the sensor.
/// @param own,other the two electrodes.
/// @param place source location of the sensor. Throws Error(zero-volume) if the electrodes touch or
///   have no faces.
std::vector<constraint::ElectrodeTriangle> attach_electrode(
    builder::Attacher& attacher, const SensorCapacitance::Electrode& own,
    const SensorCapacitance::Electrode& other, const Location& place);

}  // namespace sinew::sense
