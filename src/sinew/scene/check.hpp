/// @file
/// Checks a tree against the grammar.
#pragma once

#include "sinew/scene/grammar.hpp"
#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// Throws Error for the first thing wrong, in the order of the file: unknown-key, missing-key,
/// wrong-type, wrong-dimension, unknown-unit, not-a-number, not-finite, out-of-range,
/// invalid-material, unknown-choice, unknown-name, not-in-this-version, conflicting-keys,
/// empty-list, wrong-length. The message names the value, the remedy what to write.
void check_scene(const Node& tree);

/// The same for one value that stands in a file of its own.
/// @param node,forms the value, and what it may be.
void check_value(const Node& node, const std::vector<Form>& forms);

/// The table that holds for a map written in a table or variants form. Throws Error(missing-key),
/// Error(unknown-choice), Error(not-in-this-version) for the word of a variants form.
const KeyTable& table_of(const Node& map, const Form& form);

/// Error(unknown-key) at `place`, with a suggestion and the keys of the table.
[[noreturn]] void throw_unknown_key(const std::string& key, const KeyTable& table,
                                    const Location& place);

/// Error(not-in-this-version) at `place`.
[[noreturn]] void throw_later(const std::string& what, const std::string& instead,
                              const Location& place);

/// Error(unknown-name) at `place`: `name` is none of `known`, the names under the top-level key
/// `section`.
[[noreturn]] void throw_unknown_name(const std::string& name, const std::string& section,
                                     const std::vector<std::string>& known, const Location& place);

/// The names under a top-level key of the scene; empty when it is not there.
std::vector<std::string> names_under(const Node& scene, const std::string& section);

}  // namespace sinew::scene
