/// @file
/// Names and units in the headings of tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sinew/core/csv.hpp"
#include "sinew/core/quantity.hpp"

namespace sinew {

/// A heading such as "x [mm]" or "x (mm)".
struct Heading {
  std::string name;                 ///< "x"
  std::optional<std::string> unit;  ///< "mm"; the text in brackets, whatever it says
};

/// Takes a heading apart. Brackets come before parentheses: "stress (true) [MPa]" has the unit MPa.
Heading parse_heading(std::string_view text);

/// SI value of the unit of a column: of "stress [MPa]" and "stress (MPa)", and of "stress_MPa" and
/// "stress MPa", where the last word is a unit of the dimension. None if the heading has none, or
/// the table no headings. Every reader of a table uses this, so that no unit is ignored.
/// Throws Error(unknown-unit, wrong-dimension) at the heading for a text in brackets that is no
/// unit of the dimension.
/// @param table,column of it. @param expected dimension of the column.
/// @param item of the error, such as the key of the scene that names the file.
std::optional<double> heading_unit(const Table& table, Eigen::Index column, Dimension expected,
                                   const std::string& item = {});

}  // namespace sinew
