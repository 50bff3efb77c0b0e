#include "sinew/identify/column_unit.hpp"

#include <cctype>

#include "sinew/core/error.hpp"

namespace sinew::identify {

namespace {

/// The text in brackets in a column's name, or its last word, in its original case.
std::string unit_of(const std::string& name) {
  const std::size_t open = name.find_first_of("[(");
  const std::size_t close = name.find_last_of("])");
  if (open != std::string::npos && close != std::string::npos && close > open) {
    return name.substr(open + 1, close - open - 1);
  }
  const std::size_t last = name.find_last_of("_ ");
  return last == std::string::npos ? "" : name.substr(last + 1);
}

}  // namespace

std::string plain_name(std::string_view name) {
  std::string result(name);
  for (char& c : result) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (c == '_' || c == '-') c = ' ';
  }
  return result;
}

std::optional<double> column_unit(const std::string& name, Dimension dimension) {
  try {
    return parse_unit(unit_of(name), dimension);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace sinew::identify
