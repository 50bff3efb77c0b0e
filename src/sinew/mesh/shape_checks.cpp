#include "sinew/mesh/shape_checks.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::mesh {

void require(bool holds, const std::string& shape, const std::string& message) {
  if (!holds) {
    throw Error(
        ErrorKind::out_of_range, {.item = shape}, message,
        "give positive, finite lengths and an element size that they are not too large for");
  }
}

void require_length(double value, const std::string& shape, const char* what) {
  require(std::isfinite(value) && value > 0.0, shape, fmt::format("{} = {} m", what, value));
}

void require_cells(int value, int least, const std::string& shape, const char* what) {
  constexpr int kMaxCount = 2000;
  require(value >= least && value <= kMaxCount, shape,
          fmt::format("{} = {} (from {} to {})", what, value, least, kMaxCount));
}

void require_rings(int rings, Cells cells, const std::string& shape) {
  require_cells(rings, cells == Cells::hexahedra ? 2 : 1, shape, "rings");
}

}  // namespace sinew::mesh
