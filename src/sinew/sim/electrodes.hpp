/// @file
/// Electrodes of capacitive sensors on the bodies of a model under construction.
#pragma once

#include <vector>

#include "sinew/constraint/electrode_probe.hpp"
#include "sinew/sim/sensor_settings.hpp"

namespace sinew::sim {

class Attacher;

/// Triangles of an electrode; opposite each middle the place of the other one that is nearest at
/// rest. @param attacher of the sensor. @param own,other both electrodes. @param place of the
/// sensor. Throws Error(zero-volume) where they touch or one has no faces.
std::vector<constraint::ElectrodeTriangle> attach_electrode(
    Attacher& attacher, const SensorCapacitance::Electrode& own,
    const SensorCapacitance::Electrode& other, const Location& place);

}  // namespace sinew::sim
