#include "sinew/model/new_name.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::model {

void throw_same_name(const char* kind, const std::string& name, const Location& place) {
  throw Error(ErrorKind::duplicate_key, place, fmt::format("two {} are called '{}'", kind, name),
              "rename one");
}

}  // namespace sinew::model
