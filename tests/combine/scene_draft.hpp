/// @file
/// Scenes from levels of features: valid ones, small enough to run by the hundred.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "features.hpp"

namespace sinew::combine {

/// One named thing of a scene. References to others stand as "<id>" in its text.
struct Item {
  std::string id;
  std::string text;  ///< YAML, in one line
};

/// A scene whose names and order are still open.
struct SceneDraft {
  std::string settings;  ///< the keys without names
  std::vector<std::pair<std::string, std::vector<Item>>> sections;
};

/// What a selection means. Levels that cannot stand together give way: chambers bring their own
/// mesh, elements follow the material, what only some bodies have goes to one that can.
/// @param seed of the numbers.
SceneDraft draft_scene(const Selection& selection, std::uint64_t seed);

/// How names and order are chosen.
struct Layout {
  bool renamed = false;   ///< other names, in the same order
  bool reversed = false;  ///< bodies and actuators in the opposite order
  /// Newton's method leaves nothing to the next step, where the scene gives no tolerance.
  bool converged = false;
};

/// The scene as a YAML file.
std::string write_scene(const SceneDraft& draft, const Layout& layout = {});

}  // namespace sinew::combine
