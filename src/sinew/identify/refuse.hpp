/// @file
/// The error of an input that cannot be fitted.
#pragma once

#include <string>
#include <utility>

#include "sinew/core/error.hpp"

namespace sinew::identify {

/// Throws this error.
[[noreturn]] inline void refuse(ErrorKind kind, const std::string& item, std::string message,
                                std::string remedy) {
  throw Error(kind, {.item = item}, std::move(message), std::move(remedy));
}

}  // namespace sinew::identify
