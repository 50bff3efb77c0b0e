/// @file
/// What `sinew info` says of bodies and of the solids that surfaces enclose.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::cli {

/// The same facts for people and for programs. (The JSON type's move asserts what cannot fail.)
struct Facts {  // NOLINT(bugprone-exception-escape)
  nlohmann::ordered_json json;
  std::string text;
};

/// The three numbers as a list.
nlohmann::ordered_json triple(const Vector3& v);

/// Adds what a surface encloses, or why it encloses nothing.
void add_solid(Facts& facts, const mesh::Surface& surface);

/// Adds an entry to `bodies`, and its lines.
void add_body(Facts& facts, const mechanics::BodyModel& body);

}  // namespace sinew::cli
