/// @file
/// Throws the error for an invalid number in a task.
#pragma once

#include <string>
#include <utility>

#include "sinew/core/error.hpp"

namespace sinew::plan {

[[noreturn]] inline void refuse(const std::string& item, std::string what, std::string remedy) {
  throw Error(ErrorKind::out_of_range, {.item = item}, std::move(what), std::move(remedy));
}

}  // namespace sinew::plan
