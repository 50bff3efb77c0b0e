/// @file
/// Scenes made from levels of features: valid, and small enough to run by the hundred.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "features.hpp"

namespace sinew::combine {

/// One named item of a scene. In its text, references to others are written "<id>".
struct Item {
  std::string id;
  std::string text;  ///< YAML, in one line
};

/// A scene whose names and order are not fixed yet.
struct SceneDraft {
  std::string settings;  ///< top-level keys without names
  std::vector<std::pair<std::string, std::vector<Item>>> sections;
};

/// Drafts the scene of a selection. Levels that are incompatible give way: chambers bring their own
/// mesh, elements follow the material, and what only some bodies can have goes to one of these.
/// @param seed of the scene's numbers.
SceneDraft draft_scene(const Selection& selection, std::uint64_t seed);

/// Choice of names and order.
struct Layout {
  bool renamed = false;   ///< other names, in the same order
  bool reversed = false;  ///< bodies and actuators in the opposite order
  /// Newton's method converges fully in each step, unless the scene gives a tolerance.
  bool converged = false;
};

/// The text of the scene as a YAML file.
std::string write_scene(const SceneDraft& draft, const Layout& layout = {});

}  // namespace sinew::combine
