/// @file
/// The laws of materials in scenes. Each is a file, material_NAME.cpp, with its words, keys and
/// reader, and a line in material_kind.cpp. Which elements they need is MaterialModel.
#pragma once

#include <memory>
#include <string_view>

#include "sinew/scene/description.hpp"
#include "sinew/scene/fields.hpp"
#include "sinew/scene/grammar.hpp"

namespace sinew::scene {

/// A law, the word of the key `model`. Its functions have no state.
struct MaterialKind {
  const char* word = "";         ///< in scenes
  const char* description = "";  ///< in the reference: "Small displacements and strains."
  std::shared_ptr<const KeyTable> (*table)() = nullptr;  ///< its keys
  /// Reads the law: MaterialDescription::model and its constants. The history of a hyperelastic law
  /// (viscosity, softening) is read after.
  void (*read)(const Fields& fields, MaterialDescription& material) = nullptr;
};

/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_material_kind(const MaterialKind& kind);
/// The kind with a word. Throws Error(internal) if there is none.
const MaterialKind& material_kind(std::string_view word);

const MaterialKind& corotational_kind();
const MaterialKind& linear_kind();
const MaterialKind& neo_hookean_kind();
const MaterialKind& mooney_rivlin_kind();
const MaterialKind& yeoh_kind();
const MaterialKind& ogden_kind();
const MaterialKind& arruda_boyce_kind();
const MaterialKind& saint_venant_kind();

}  // namespace sinew::scene
