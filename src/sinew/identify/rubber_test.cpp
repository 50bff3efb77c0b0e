#include "sinew/identify/rubber_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/heading.hpp"
#include "sinew/identify/column_name.hpp"

namespace sinew::identify {

namespace {

using material::DeformationMode;

bool has(std::string_view text, std::string_view word) {
  return text.find(word) != std::string_view::npos;
}

struct Column {
  Eigen::Index index = -1;
  bool is_true = false;
  bool is_stretch = false;
  double unit = 1.0;
};

void consider(Column& best, const Column& found) {
  if (best.index < 0 || (best.is_true && !found.is_true)) best = found;
}

std::pair<Column, Column> find_columns(const Table& table) {
  Column strain, stress;
  std::string unreadable;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string name = plain_name(table.names[i]);
    Column column{static_cast<Eigen::Index>(i), has(name, "true") || has(name, "cauchy"), false, 1};
    if (has(name, "stress")) {
      const auto unit = heading_unit(table, column.index, dimension::kPressure);
      if (!unit) {
        unreadable = table.names[i];
        continue;
      }
      column.unit = *unit;
      consider(stress, column);
    } else if (has(name, "stretch") || has(name, "strain")) {
      column.is_stretch = has(name, "stretch");
      column.unit =
          heading_unit(table, column.index, dimension::kNone).value_or(has(name, "%") ? 0.01 : 1.0);
      consider(strain, column);
    }
  }
  const auto fail = [&](const std::string& what, const std::string& remedy) {
    throw Error(ErrorKind::wrong_columns, table.place,
                fmt::format("{}; the columns are {}", what, fmt::join(table.names, ", ")), remedy);
  };
  if (strain.index < 0) {
    fail("no column is a strain", "call one stretch, engineering strain or true strain");
  }
  if (stress.index < 0 && !unreadable.empty()) {
    fail(fmt::format("'{}' has no unit of stress", unreadable), "write it as stress [MPa]");
  }
  if (stress.index < 0) fail("no column is a stress", "call one nominal stress [MPa]");
  return {strain, stress};
}

DeformationMode mode_of(const std::string& file) {
  const std::string name = plain_name(std::filesystem::path(file).filename().string());
  if (has(name, "biaxial")) return DeformationMode::equibiaxial;
  if (has(name, "planar") || has(name, "pure shear")) return DeformationMode::planar;
  return DeformationMode::uniaxial;
}

bool is_number(std::string_view cell) {
  const std::string text(cell);
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end != text.c_str() &&
         text.find_first_not_of(" \t\r", static_cast<std::size_t>(end - text.c_str())) ==
             std::string::npos;
}

/// The table with the lines above its header left empty. The header is the last line before the
/// first that has only numbers.
std::string without_preamble(std::string_view bytes) {
  std::size_t header = 0, line = 0;
  while (line < bytes.size()) {
    const std::size_t end = std::min(bytes.find('\n', line), bytes.size());
    const std::string_view text = bytes.substr(line, end - line);
    bool numbers = !text.empty();
    std::size_t cell = 0;
    while (numbers && cell <= text.size()) {
      const std::size_t stop = std::min(text.find_first_of(";,\t", cell), text.size());
      numbers = is_number(text.substr(cell, stop - cell));
      cell = stop + 1;
    }
    if (numbers) {
      const auto above = std::count(bytes.begin(), bytes.begin() + std::ptrdiff_t(header), '\n');
      return std::string(static_cast<std::size_t>(above), '\n').append(bytes.substr(header));
    }
    header = line;
    line = end + 1;
  }
  return std::string(bytes);
}

}  // namespace

double RubberTest::largest_stress() const {
  double largest = 0.0;
  for (const double s : stress) largest = std::max(largest, std::abs(s));
  return largest;
}

std::string_view mode_name(DeformationMode mode) {
  switch (mode) {
    case DeformationMode::uniaxial:
      return "uniaxial";
    case DeformationMode::equibiaxial:
      return "equibiaxial";
    case DeformationMode::planar:
      return "planar";
  }
  return "unknown";
}

RubberTest parse_rubber_test(std::string_view bytes, const std::string& name,
                             std::optional<DeformationMode> mode) {
  const Table table = parse_csv(without_preamble(bytes), name);
  const auto [strain, stress] = find_columns(table);
  RubberTest test;
  test.name = std::filesystem::path(name).stem().string();
  test.mode = mode.value_or(mode_of(name));
  for (Eigen::Index row = 0; row < table.values.rows(); ++row) {
    const double e = strain.unit * table.values(row, strain.index);
    const double stretch = strain.is_stretch ? e : strain.is_true ? std::exp(e) : 1.0 + e;
    if (!(stretch > 0.0)) {
      throw Error(ErrorKind::out_of_range, table.place,
                  fmt::format("row {} has the stretch {:g}", row + 1, stretch),
                  "strains are -1 or more, percent only where the header says %");
    }
    const double s = stress.unit * table.values(row, stress.index);
    test.stretch.push_back(stretch);
    test.stress.push_back(stress.is_true ? s / stretch : s);
  }
  if (test.stretch.size() < 3) {
    throw Error(ErrorKind::too_few_points, table.place,
                fmt::format("the table has {} rows", test.stretch.size()),
                "a fit needs three or more");
  }
  return test;
}

RubberTest read_rubber_test(const std::filesystem::path& path,
                            std::optional<DeformationMode> mode) {
  return parse_rubber_test(read_file(path), path.string(), mode);
}

}  // namespace sinew::identify
