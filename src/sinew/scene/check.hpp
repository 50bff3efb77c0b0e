/// @file
/// Checks a scene tree against the grammar.
#pragma once

#include "sinew/scene/grammar.hpp"
#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// Checks a whole scene. Throws Error for the first mistake in the order of the file: unknown-key,
/// missing-key, wrong-type, wrong-dimension, unknown-unit, not-a-number, not-finite, out-of-range,
/// invalid-material, unknown-choice, unknown-name, bad-argument (a name), unsupported-version,
/// not-in-this-version, conflicting-keys, empty-list, wrong-length. The message names the value,
/// and the remedy says what to write.
void check_scene(const Node& tree);

/// Checks a single value, such as one in a file of its own.
/// @param node,forms the value, and the forms that it may have.
void check_value(const Node& node, const std::vector<Form>& forms);

/// The key table of a map that is written in a table or variants form. Throws Error(missing-key),
/// Error(unknown-choice), Error(not-in-this-version) for the word of a variants form.
const KeyTable& table_of(const Node& map, const Form& form);

/// Throws Error(unknown-key) at `place`, with a suggestion and the keys of the table.
[[noreturn]] void throw_unknown_key(const std::string& key, const KeyTable& table,
                                    const Location& place);

/// Throws Error(not-in-this-version) at `place`.
[[noreturn]] void throw_later(const std::string& what, const std::string& instead,
                              const Location& place);

/// Throws Error(unknown-name) at `place`, since `name` is not among `known`, the names under the
/// top-level key `section`.
[[noreturn]] void throw_unknown_name(const std::string& name, const std::string& section,
                                     const std::vector<std::string>& known, const Location& place);

/// The names under a top-level key of the scene; empty if the scene does not have the key.
std::vector<std::string> names_under(const Node& scene, const std::string& section);

}  // namespace sinew::scene
