/// @file
/// What `sinew info` says of bodies and of the solids that surfaces enclose.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::cli {

/// The three numbers as a list.
nlohmann::ordered_json triple(const Vector3& v);

/// Adds what a surface encloses, or why it encloses nothing.
/// @param json,text the same facts for programs and for people.
void add_solid(nlohmann::ordered_json& json, std::string& text, const mesh::Surface& surface);

/// Adds an entry to `bodies`, and its lines. @param json,text as for add_solid().
void add_body(nlohmann::ordered_json& json, std::string& text, const mechanics::BodyModel& body);

}  // namespace sinew::cli
