/// @file
/// What only bodies of finite elements can do, asked of a body that must be one.
#pragma once

#include <string>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew::fem {

/// Throws Error(wrong-type). @param name of a body that is of another kind.
[[noreturn]] void throw_not_of_elements(const std::string& name);

/// mechanics::as<Capability>(body). Throws Error(wrong-type) where it has not got it.
template <class Capability, class Body>
Capability& of_elements(Body& body) {
  auto* const found = mechanics::as<Capability>(body);
  if (found == nullptr) throw_not_of_elements(body.model().name());
  return *found;
}

}  // namespace sinew::fem
