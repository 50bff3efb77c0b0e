/// @file
/// What a page is told of a robot before the first frame.
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

/// Whether the numbers of an observable are among Frame::signals. Signals have the order of the
/// list.
bool is_signal(const sim::Observable& observable);

/// What is drawn of a body.
DisplaySurface display_surface(const mechanics::BodyModel& body);

/// Everything at once. @param robot what is shown. @param observables of its simulation.
Description describe(const scene::Robot& robot, const sim::Observables& observables);

}  // namespace sinew::viewer
