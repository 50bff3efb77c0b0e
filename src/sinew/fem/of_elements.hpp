/// @file
/// Access to the capabilities of finite-element bodies, with an error for other bodies.
#pragma once

#include <string>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew::fem {

/// Throws Error(wrong-type). @param name of the body of another kind.
[[noreturn]] void throw_not_of_elements(const std::string& name);

/// mechanics::as<Capability>(body). Throws Error(wrong-type) if the body lacks the capability.
template <class Capability, class Body>
Capability& of_elements(Body& body) {
  auto* const found = mechanics::as<Capability>(body);
  if (found == nullptr) throw_not_of_elements(body.model().name());
  return *found;
}

}  // namespace sinew::fem
