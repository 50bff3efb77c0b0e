/// @file
/// Reads a scene from a YAML file, YAML text or a tree made by hand (a Python dict), checks it
/// against the grammar (grammar.hpp), and makes a SceneDescription.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/description.hpp"
#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// Whether reading a scene opens the files that it refers to.
enum class Files {
  check,   ///< CSV tables are read; a mesh file must exist
  ignore,  ///< no file is opened: lists and signals from files stay empty
};

/// Reads a scene file. Relative paths in it start at its folder. Throws Error with
/// file:line:column, the dotted path, the offending value and the remedy.
SceneDescription parse_scene(const std::filesystem::path& path);

/// Reads a scene from text.
/// @param text YAML, UTF-8.
/// @param name used in messages in place of a file name.
/// @param base_dir folder at which relative paths start.
/// @param files Files::ignore opens no file at all, for editors and fuzzing.
SceneDescription parse_scene_text(std::string_view text, const std::string& name,
                                  const std::filesystem::path& base_dir,
                                  Files files = Files::check);

/// Reads the scene inside a recorded run. Words renamed since then are replaced
/// (renamed_words.hpp).
/// @param text,name as for parse_scene_text(); paths in the text are absolute.
SceneDescription parse_recorded_scene(std::string_view text, const std::string& name);

/// Reads a scene from a tree. Locations in the tree are kept, and dotted paths are filled in. Keys
/// that have moved are read with a notice.
/// @param tree a map, from read_yaml() or made by hand.
/// @param base_dir folder at which relative paths start.
/// @param files see Files.
SceneDescription parse_scene_tree(Node tree, const std::filesystem::path& base_dir = {},
                                  Files files = Files::check);

/// Sets one value of a tree: "actuators.long_0.command.displacement=10mm". The keys of the path are
/// checked against the grammar and the tree. Alternatives to the key are removed, such as density
/// when mass is set, or tension when displacement is. The value may be any YAML ("{sine: ...}").
/// Throws Error(bad-argument) without "=", Error(unknown-key) or Error(unknown-name) with a
/// suggestion, Error(syntax-error) in the value. The value itself is checked by parse_scene_tree().
/// Keys of the tree and of the path that have moved are replaced, with a notice for each
/// (renamed_words.hpp).
std::vector<Notice> apply_override(Node& tree, const std::string& assignment);

/// Reads a scene from a tree after overrides. Throws what apply_override() and parse_scene_tree()
/// throw. @param tree,base_dir as for parse_scene_tree(). @param overrides as for apply_override().
SceneDescription parse_changed_scene(Node tree, const std::vector<std::string>& overrides,
                                     const std::filesystem::path& base_dir);

/// Makes every file path of the tree absolute, so that the tree can be read in another folder.
/// Throws what check_scene() throws.
void resolve_paths(Node& tree, const std::filesystem::path& base_dir);

/// The names of built-in mesh shapes, in the order of the reference.
std::vector<std::string> shape_names();

/// Describes the mesh of a built-in shape. Omitted measures have the defaults of mesh/shapes.hpp.
/// Throws Error: unknown-choice (the shape), bad-argument, unknown-key (a measure), and the errors
/// of scenes for the value of a measure.
/// @param shape one of shape_names(). @param measures assignments such as "radius=15 mm".
MeshDescription read_shape(const std::string& shape, const std::vector<std::string>& measures);

}  // namespace sinew::scene
