/// @file
/// Checked access to the bodies of a model under construction.
#pragma once

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew {
struct Location;
}

namespace sinew::model {
struct ModelData;
}

namespace sinew::builder {

/// A body by index. @param data with the bodies. @param index as given.
/// @param place source location of the reference. Throws Error(unknown-name).
mechanics::BodyModel& find_body(model::ModelData& data, int index, const Location& place);

/// Throws Error(wrong-type) for a body that lacks a capability.
/// @param place,what see find_capable().
[[noreturn]] void throw_not_capable(const Location& place, const char* what);

/// The capability of a body by index. @param data,index,place as for find_body().
/// @param what needs it, for the message: "loads". Throws Error: unknown-name, wrong-type.
template <class Capability>
Capability& find_capable(model::ModelData& data, int index, const Location& place,
                         const char* what) {
  auto* const found = mechanics::as<Capability>(find_body(data, index, place));
  if (found == nullptr) throw_not_capable(place, what);
  return *found;
}

}  // namespace sinew::builder
