/// @file
/// The output of `sinew info` about bodies and about the solids that surfaces enclose.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::cli {

/// A vector as a JSON list.
nlohmann::ordered_json triple(const Vector3& v);

/// Adds the properties of the solid that a surface encloses, or the reason why it encloses none.
/// @param json,text output for programs and for people. @param surface of the solid.
void add_solid(nlohmann::ordered_json& json, std::string& text, const mesh::Surface& surface);

/// Adds a body to `bodies`, and its lines. @param json,text as for add_solid(). @param body to
/// describe.
void add_body(nlohmann::ordered_json& json, std::string& text, const mechanics::BodyModel& body);

}  // namespace sinew::cli
