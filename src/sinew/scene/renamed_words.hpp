/// @file
/// Words of scenes that have another name now: keys, and words of choices. A user who writes the
/// old one is told the new one; a scene that a recording holds is read.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// What a word that is no longer known is called now; nothing where it never meant one of `known`.
/// @param word as written.
/// @param known the keys or words that may stand in its place.
std::optional<std::string> current_word(std::string_view word,
                                        const std::vector<std::string>& known);

/// Replaces the old words of a scene. Names that users chose, and words that are still in use where
/// they stand, stay. @param scene as read; it need not be valid.
void replace_renamed_words(Node& scene);

}  // namespace sinew::scene
