/// @file
/// What several laws of materials share. Internal to this folder and to kinds of materials.
#pragma once

#include <memory>
#include <vector>

#include "sinew/material/hyperelastic.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {

/// A modulus. @param name,example,description of its key. @param required whether it must be given.
/// @param any_sign whether it may be zero or less.
Key modulus_key(const char* name, const char* example, const char* description,
                bool required = true, bool any_sign = false);
/// Keys young_modulus and poisson_ratio, both required.
std::vector<Key> small_strain_keys();
/// Keys of all hyperelastic laws: viscosity and softening.
std::vector<Key> history_keys();
/// A table of these keys, used only for the reference.
std::shared_ptr<const KeyTable> history_table();
/// The table of a hyperelastic law: its own keys, one of the two keys for its compressibility, and
/// its history. @param kind the law. @param own keys. @param alternatives of its own keys.
std::shared_ptr<const KeyTable> energy_table(const MaterialKind& kind, std::vector<Key> own,
                                             std::vector<Alternatives> alternatives = {});
/// The laws, selected by the key `model`.
Form law_form();

}  // namespace forms

/// The number under `key`; 0 if it is left out.
double read_number(const Fields& fields, const char* key);
/// Makes a material hyperelastic, with the bulk modulus of the key poisson_ratio or bulk_modulus.
/// @param fields of the law. @param energy without a bulk modulus. @param material receives it.
void set_energy(const Fields& fields, material::Hyperelastic energy, MaterialDescription& material);

}  // namespace sinew::scene
