#include "arguments.hpp"

#include <fmt/format.h>

namespace sinew::cli {

double positive_quantity(const std::string& option, const std::string& text, Dimension dimension) {
  const double value = parse_quantity(text, dimension, {.item = option});
  if (value > 0.0) return value;
  throw Error(ErrorKind::out_of_range, {.item = option}, fmt::format("'{}' is not positive", text),
              fmt::format("write for example {}", dimension_example(dimension)));
}

double length_unit(const std::string& option, const std::string& text) {
  return parse_unit(text, dimension::kLength, {.item = option});
}

void require_range(const std::string& option, long value, long low, long high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorKind::out_of_range, {.item = option}, fmt::format("{} is out of range", value),
              fmt::format("write a number from {} to {}", low, high));
}

}  // namespace sinew::cli
