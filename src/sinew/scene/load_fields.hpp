/// @file
/// What the tables of several kinds of loads share. Internal to this folder and to kinds of loads.
#pragma once

#include <memory>
#include <vector>

#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

/// The table of a load: the key `body`, and its own.
/// @param type its word. @param description of it. @param own keys.
std::shared_ptr<const KeyTable> load_table(const char* type, const char* description,
                                           std::vector<Key> own);
/// Key `factor`, the signal of a load.
Key factor_key();
/// Key `surface`. @param description of it. @param required whether it must be given.
Key surface_key(const char* description, bool required);
/// A vector that is required. @param name,measure,example,description of it.
Key vector_key(const char* name, const Measure& measure, const char* example,
               const char* description);

}  // namespace sinew::scene::forms
