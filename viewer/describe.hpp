/// @file
/// What a page is told of a robot before the first frame.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/scene/build.hpp"

#include "frame.hpp"

namespace sinew::viewer {

/// Fields that finite-element bodies can be coloured by, in the order of Description::fields.
enum class Field { displacement, strain, stress, force };
inline constexpr int kFieldCount = 4;

/// In the order in which sources fill Frame::signals.
std::vector<SignalInfo> list_signals(const sim::Model& model);

/// The outside of a body's mesh, its vertices numbered anew.
Surface surface_of(const mesh::Mesh& mesh);

/// Everything at once. @param robot whose bodies are of finite elements.
Description describe(const scene::Robot& robot);

}  // namespace sinew::viewer
