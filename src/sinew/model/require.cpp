#include "sinew/model/require.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::model {

void require(bool holds, const char* what, double value, const char* remedy) {
  if (holds) return;
  throw Error(ErrorKind::out_of_range, {.item = what}, fmt::format("{} is {:g}", what, value),
              remedy);
}

}  // namespace sinew::model
