#include "sinew/builder/find_body.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

mechanics::BodyModel& find_body(model::ModelData& data, int index, const Location& place) {
  if (index >= 0 && index < static_cast<int>(data.bodies.size())) return data.body(index);
  throw Error(ErrorKind::unknown_name, place, fmt::format("there is no body {}", index),
              "add the body first");
}

void throw_not_capable(const Location& place, const char* what) {
  throw Error(ErrorKind::wrong_type, place, fmt::format("this body takes no {}", what),
              "name a finite-element body");
}

}  // namespace sinew::builder
