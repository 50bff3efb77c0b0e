/// @file
/// Renamed words of scene files: keys, and words of choices. A scene with an old word is refused
/// with an error that names the new one. A scene inside a recorded run is still read.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// The current name of a renamed word; none if the word is still in use or never meant one of
/// `known`.
/// @param word as written.
/// @param known the keys or words that are allowed there.
std::optional<std::string> current_word(std::string_view word,
                                        const std::vector<std::string>& known);

/// Replaces the renamed words of a scene. Names chosen by users stay, and so do words that are
/// still in use where they occur. @param scene as read; it need not be valid.
void replace_renamed_words(Node& scene);

}  // namespace sinew::scene
