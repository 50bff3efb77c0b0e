/// @file
/// Notices about numbers whose unit was probably forgotten.
#pragma once

#include <vector>

#include "sinew/core/notice.hpp"
#include "sinew/scene/node.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// Finds numbers whose size is usual (core/usual_range.hpp), such as pressures, that are written
/// without a unit, are hence in SI units, and are far from those of robots: `pressure: 30` is 30
/// Pa. Of the numbers of one quantity in a map, such as the ends of a ramp or the moduli of a law,
/// the largest counts. Files of signals count with their values, unless their headings or the scene
/// have units.
/// @param tree of a scene that check_scene() accepted. @param context of its files.
std::vector<Notice> suspicious_units(const Node& tree, const ReadContext& context);

}  // namespace sinew::scene
