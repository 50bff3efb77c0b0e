// The kind of error that a call throws, for tests of invalid input.
#pragma once

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew::testing {

/// The kind of the Error that `action` throws, whose message must not be empty; ErrorKind::internal
/// if it throws none.
inline ErrorKind kind_of(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_FALSE(error.message().empty());
    return error.kind();
  }
  return ErrorKind::internal;
}

}  // namespace sinew::testing
