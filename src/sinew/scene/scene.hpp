/// @file
/// Reads scenes: YAML file, YAML text, or a tree made by hand (a Python dict), checked against the
/// grammar (grammar.hpp) into a SceneDescription.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/description.hpp"
#include "sinew/scene/node.hpp"

namespace sinew::scene {

/// Whether files that a scene refers to are opened while it is read.
enum class Files {
  check,   ///< CSV tables are read; a mesh file must exist
  ignore,  ///< nothing outside the text is touched: lists and signals from files stay empty
};

/// Reads a scene file; relative paths in it are relative to its folder. Throws Error with
/// file:line:column, the dotted path, the offending value and the remedy.
SceneDescription parse_scene(const std::filesystem::path& path);

/// Reads a scene from text.
/// @param text YAML, UTF-8.
/// @param name stands for the file name in messages.
/// @param base_dir where relative paths start.
/// @param files Files::ignore touches no file at all (checking editors, fuzzing).
SceneDescription parse_scene_text(std::string_view text, const std::string& name,
                                  const std::filesystem::path& base_dir,
                                  Files files = Files::check);

/// The scene that a recording holds. Words that have another name since it was written are replaced
/// (renamed_words.hpp). @param text,name as for parse_scene_text(). Paths in it are absolute.
SceneDescription parse_recorded_scene(std::string_view text, const std::string& name);

/// Reads a scene from a tree. Places of the tree are kept; dotted paths are filled in.
/// @param tree a map, as read_yaml() gives it or made by hand.
/// @param base_dir where relative paths start.
/// @param files see Files.
SceneDescription parse_scene_tree(Node tree, const std::filesystem::path& base_dir = {},
                                  Files files = Files::check);

/// Sets one value of a tree: "actuators.long_0.command.displacement=10mm". The path's keys are
/// checked against the grammar and the tree; what is an alternative to the key set (density where
/// mass is set, tension where displacement is) is removed. Values may be any YAML ("{sine: ...}").
/// Throws Error(bad-argument) without "=", Error(unknown-key) or Error(unknown-name) with a
/// suggestion, Error(syntax-error) in the value. The value itself is checked by parse_scene_tree().
void apply_override(Node& tree, const std::string& assignment);

/// Makes every file path of the tree absolute, so that it means the same in another folder.
void resolve_paths(Node& tree, const std::filesystem::path& base_dir);

/// The words under `shape` of a mesh, in the order of the reference.
std::vector<std::string> shape_names();

/// The mesh of a shape, whose measures have the defaults of mesh/shapes.hpp where none is given.
/// Throws Error: unknown-choice (the shape), bad-argument, unknown-key (a measure), and what a
/// scene throws for its value.
/// @param shape one of shape_names(). @param measures "radius=15 mm" each.
MeshDescription read_shape(const std::string& shape, const std::vector<std::string>& measures);

}  // namespace sinew::scene
