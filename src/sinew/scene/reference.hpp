/// @file
/// What comes out of the grammar for readers and editors: docs/scene.md and docs/scene.schema.json.
#pragma once

#include <string>

namespace sinew::scene {

/// The reference of scene files as Markdown: every table, key, form, default and meaning.
std::string reference_page();

/// A JSON Schema (draft 2020-12) of scene files, for completion and checking in editors. It knows
/// keys, types, words, units' dimensions (by the units' spelling) and alternatives; references
/// between parts and the contents of files are checked by the parser alone.
std::string json_schema();

}  // namespace sinew::scene
