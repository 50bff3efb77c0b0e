/// @file
/// Generates documents from the grammar: docs/scene.md, docs/scene/*.md and docs/scene.schema.json.
#pragma once

#include <string>
#include <vector>

namespace sinew::scene {

/// One page of the reference.
struct ReferencePage {
  std::string path;  ///< below docs/, such as "scene/sensors.md"
  std::string text;  ///< Markdown
};

/// The reference of scene files: every table, key, form, default and meaning. The first page has
/// the top-level keys and links to the others, one for each section of a scene. A table is
/// described once: on the page of the section that uses it, or on "scene/shared.md" if several
/// sections do.
std::vector<ReferencePage> reference_pages();

/// A JSON Schema (draft 2020-12) of scene files, for completion and checking in editors. It covers
/// keys, types, words, dimensions (by the spelling of units) and alternatives. Only the parser
/// checks references between parts and the contents of files.
std::string json_schema();

}  // namespace sinew::scene
