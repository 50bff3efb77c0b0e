/// @file
/// Kinds of parts in scenes that the library does not know.
#pragma once

namespace sinew::testing {

/// Adds the toys to the kinds of scenes: bodies of type spring-point, actuators of type strut,
/// sensors of type speedometer, loads of type couple, controllers of type proportional. Call it
/// before a scene is read; again, it does nothing.
void register_toys();

}  // namespace sinew::testing
