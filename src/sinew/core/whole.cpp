#include "sinew/core/whole.hpp"

#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew {

void require_count(double count, double most, std::string_view what, std::string_view remedy) {
  if (count >= 1.0 && count <= most) return;
  throw Error(ErrorKind::out_of_range, {},
              fmt::format("{:.4g} {}, of 1 to {:g}", count, what, most), std::string(remedy));
}

}  // namespace sinew
