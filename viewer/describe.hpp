/// @file
/// Makes the description of a robot that a page receives before the first frame.
#pragma once

#include <string>
#include <vector>

#include "sinew/scene/build.hpp"
#include "sinew/sim/observables.hpp"

#include "frame.hpp"

namespace sinew::mechanics {
class BodyModel;
}

namespace sinew::viewer {

/// Whether Frame::signals contains the numbers of an observable. Signals are in the order of the
/// list.
bool is_signal(const run::Observable& observable);

/// The surface of a body as it is drawn.
DisplaySurface display_surface(const mechanics::BodyModel& body);

/// Makes the whole description. @param robot to be shown. @param observables of its simulation.
Description describe(const scene::Robot& robot, const sim::Observables& observables);

}  // namespace sinew::viewer
