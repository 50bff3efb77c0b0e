/// @file
/// Entries of the material library as text.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sinew/material/library.hpp"

namespace sinew::scene {
struct BodyDescription;
}

namespace sinew::cli {

/// "0.75 to 2", or "not stated". @param law of the library.
std::string tested_text(const material::NamedMaterial& law);
/// "7 %", "15 % above 1.5", or "not stated". @param law of the library.
std::string error_text(const material::NamedMaterial& law);

/// Adds the library laws of a body and its parts, with the stretches at which they were tested.
/// @param json,text added to. @param body of a scene.
void add_laws(nlohmann::ordered_json& json, std::string& text, const scene::BodyDescription& body);

}  // namespace sinew::cli
