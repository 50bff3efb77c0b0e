#include "sinew/core/heading.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/text.hpp"
#include "sinew/core/unit.hpp"

namespace sinew {

namespace {

// What follows the last of the separators; empty if there is none.
std::string_view after_last(std::string_view name, const char* separators) {
  const std::size_t before = name.find_last_of(separators);
  return before == std::string_view::npos ? std::string_view() : name.substr(before + 1);
}

// The unit that a name ends with, if it is one of this dimension; most words are not, and a
// `pull_in` is not in inches.
std::optional<double> unit_at_end(std::string_view name, Dimension expected) {
  std::string_view word = after_last(name, "_ ");
  if (word.empty()) word = after_last(name, "/");
  if (word.empty() || word == "in") return std::nullopt;
  try {
    return parse_unit(word, expected);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

Heading parse_heading(std::string_view text) {
  text = trimmed(text);
  for (const char* pair : {"[]", "()"}) {
    const std::size_t open = text.find(pair[0]);
    const std::size_t close = text.rfind(pair[1]);
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) continue;
    std::string name(trimmed(text.substr(0, open)));
    const std::string_view rest = trimmed(text.substr(close + 1));
    if (!name.empty() && !rest.empty()) name += ' ';
    name += rest;
    return {std::move(name), std::string(trimmed(text.substr(open + 1, close - open - 1)))};
  }
  return {std::string(text), std::nullopt};
}

std::optional<double> heading_unit(const Table& table, Eigen::Index column, Dimension expected,
                                   const std::string& item) {
  const auto k = static_cast<std::size_t>(column);
  if (k >= table.names.size()) return std::nullopt;
  const Heading heading = parse_heading(table.names[k]);
  if (!heading.unit) return unit_at_end(heading.name, expected);
  if (heading.unit->empty()) return std::nullopt;
  if (*heading.unit == "-" && expected == dimension::kNone) return 1.0;
  const Location place{.file = table.place.file,
                       .line = table.heading_line,
                       .column = table.heading_columns[k],
                       .item = item};
  try {
    return parse_unit(*heading.unit, expected, place);
  } catch (const Error& error) {
    throw Error(error.kind(), place,
                fmt::format("in the heading '{}': {}", table.names[k], error.message()),
                fmt::format("write the unit of {} in brackets, as [{}], or leave the brackets out",
                            dimension_name(expected), si_unit_name(expected)));
  }
}

}  // namespace sinew
