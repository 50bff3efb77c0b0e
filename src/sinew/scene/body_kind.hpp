/// @file
/// The kinds of bodies in scenes. Each is a file, body_NAME.cpp, with its words, keys, reader and
/// builder, and a line in body_kind.cpp.
#pragma once

#include <memory>
#include <string_view>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// A body that is made.
struct BodySite {
  const SceneDescription& scene;
  const BodyDescription& body;
  const SharedMesh* shared = nullptr;  ///< its mesh; null: it makes one
};

/// A kind of body. Its functions have no state.
struct BodyKind {
  const char* word = "";         ///< in scenes
  const char* description = "";  ///< in the reference
  const char* noun = "";         ///< in messages: "an arm of constant curvature"
  std::shared_ptr<const KeyTable> (*table)() = nullptr;  ///< its keys
  /// Reads a body whose name and place are set: BodyDescription::own, and the members that the kind
  /// uses besides.
  void (*read)(const Fields& fields, const ReadContext& context, BodyDescription& body) = nullptr;
  /// Makes the body. Null: bodies of this kind stand for others, which replace them before.
  std::unique_ptr<mechanics::BodyModel> (*make)(const BodySite& site) = nullptr;
  /// Whether it consists of finite elements: it has a mesh, materials, a mass or a density, and
  /// takes point masses and membranes; its stiffness can be estimated.
  bool has_elements = false;
  bool is_rigid = false;  ///< whether it keeps its shape
  /// Whether `between: all` finds where it touches others; else its contacts need points.
  bool is_searched = true;
  /// Whether a body of this kind never moves freely. Null: none does.
  bool (*is_fixed)(const BodyDescription& body) = nullptr;
  /// What to do in place of point masses on it.
  const char* carry_masses = "make the body of type fem";
};

/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_body_kind(const BodyKind& kind);

/// Reads the keys of a finite-element body. @param fields,context,body see BodyKind::read.
void read_fem_body(const Fields& fields, const ReadContext& context, BodyDescription& body);

const BodyKind& fem_kind();
const BodyKind& pcc_kind();
const BodyKind& rigid_kind();
const BodyKind& urdf_kind();

}  // namespace sinew::scene
