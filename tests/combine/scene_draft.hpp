/// @file
/// Makes scenes from levels of features. They are valid, and small enough to run hundreds of them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "features.hpp"

namespace sinew::combine {

/// A named part of a scene. Its text has references to other parts as "<id>".
struct Item {
  std::string id;
  std::string text;  ///< YAML on one line
};

/// A scene before names and order are chosen.
struct SceneDraft {
  std::string settings;  ///< the keys without named parts
  std::vector<std::pair<std::string, std::vector<Item>>> sections;
};

/// Makes the scene of a selection. Incompatible levels are adapted: chambers have their own mesh,
/// elements follow the material, and a part that only some bodies support goes to such a body.
/// @param selection level of each feature. @param seed of the numbers.
SceneDraft draft_scene(const Selection& selection, std::uint64_t seed);

/// Makes a scene that is symmetric about the plane y = kMiddle: one block or finger, whose loads,
/// commands and contacts are mirrored into themselves. Features that do not allow that are left
/// out, and so are patches of elements and zones of contact points, which are chosen in the order
/// of nodes. @param selection,seed as above.
SceneDraft draft_symmetric_scene(Selection selection, std::uint64_t seed);
inline constexpr double kMiddle = 0.01;  ///< m

/// Choice of names and order.
struct Layout {
  bool renamed = false;   ///< other names, with the same order
  bool reversed = false;  ///< bodies and actuators in the opposite order
  /// Newton's method converges fully, unless the scene gives a tolerance.
  bool converged = false;
};

/// Writes the scene as YAML.
std::string write_scene(const SceneDraft& draft, const Layout& layout = {});

}  // namespace sinew::combine
