/// @file
/// Renamed words of scene files: keys, words of choices, and keys that have moved to another place.
/// They are still read, with a notice that names the new one; inside a recorded run, without.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/notice.hpp"
#include "sinew/scene/node.hpp"

namespace sinew::scene {

struct KeyTable;

/// The current name of a renamed word; none if the word is still in use or never meant one of
/// `known`.
/// @param word as written.
/// @param known the keys or words that are allowed there.
std::optional<std::string> current_word(std::string_view word,
                                        const std::vector<std::string>& known);

/// The dotted path at which a key is written now, such as "pose.position"; empty if it has not
/// moved. @param key as written. @param table of the map that has it.
std::string_view moved_key(std::string_view key, const KeyTable& table);
/// A path as it is written in a scene: "pose: {position: ...}".
std::string written(std::string_view path);
/// The notice about a key that has moved. @param old,current what is written, and the path at which
/// it is written now. @param place of the key.
Notice moved_notice(std::string_view old, std::string_view current, const Location& place);

/// Replaces the renamed words of a scene, and moves keys to where they are written now, with a
/// notice for each. Names chosen by users stay, and so do words that are still in use where they
/// occur, and keys whose new place is taken. @param scene as read; it need not be valid.
std::vector<Notice> replace_old_words(Node& scene);

}  // namespace sinew::scene
