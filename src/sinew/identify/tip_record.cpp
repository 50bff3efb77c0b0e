#include "sinew/identify/tip_record.hpp"

#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/heading.hpp"
#include "sinew/identify/column_name.hpp"

namespace sinew::identify {

namespace {

struct TipColumn {
  Eigen::Index index = -1;
  double unit = 1.0;
};

/// The first column whose first word is one of `words`.
TipColumn find_column(const Table& table, std::initializer_list<std::string_view> words,
                      Dimension dimension, const char* example, bool needed) {
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string name = plain_name(table.names[i]);
    const std::string_view first = std::string_view(name).substr(0, name.find_first_of(" [("));
    for (const std::string_view word : words) {
      if (first != word) continue;
      const auto unit = heading_unit(table, static_cast<Eigen::Index>(i), dimension);
      if (unit) return {static_cast<Eigen::Index>(i), *unit};
      throw Error(ErrorKind::wrong_columns, table.place,
                  fmt::format("'{}' does not say {}", table.names[i], dimension_name(dimension)),
                  fmt::format("write it with its unit, as {}", example));
    }
  }
  if (!needed) return {};
  throw Error(ErrorKind::wrong_columns, table.place,
              fmt::format("no column is called {}; the columns are {}", *words.begin(),
                          fmt::join(table.names, ", ")),
              fmt::format("call one {}", example));
}

}  // namespace

void check(const TipRecord& record) {
  const auto require = [&](bool good, ErrorKind kind, const std::string& message,
                           const char* remedy) {
    if (!good) throw Error(kind, {.item = record.name}, message, remedy);
  };
  const std::size_t n = record.time.size();
  require(n >= 3, ErrorKind::too_few_points, fmt::format("the record has {} rows", n),
          "a fit needs three or more");
  require(record.tip.rows() == static_cast<Eigen::Index>(n) &&
              (record.pressure.empty() || record.pressure.size() == n),
          ErrorKind::wrong_length,
          fmt::format("{} times, {} pressures, {} points", n, record.pressure.size(),
                      record.tip.rows()),
          "give a pressure and a point for each time");
  require(record.tip.allFinite(), ErrorKind::not_finite, "a point of the tip is not finite",
          "leave out rows where the tip was not seen");
  for (std::size_t i = 0; i < n; ++i) {
    require(std::isfinite(record.time[i]) &&
                (record.pressure.empty() || std::isfinite(record.pressure[i])),
            ErrorKind::not_finite, fmt::format("row {} is not finite", i + 1), "leave it out");
    require(i == 0 || record.time[i] > record.time[i - 1], ErrorKind::non_monotonic_time,
            fmt::format("row {}: {:g} s comes after {:g} s", i + 1, record.time[i],
                        record.time[i == 0 ? 0 : i - 1]),
            "sort the rows and leave out repeated times");
  }
}

TipRecord parse_tip_record(std::string_view bytes, const std::string& name) {
  const Table table = parse_csv(bytes, name);
  const TipColumn time = find_column(table, {"time", "t"}, dimension::kTime, "time_s", true);
  const TipColumn x = find_column(table, {"x"}, dimension::kLength, "x_m", true);
  const TipColumn y = find_column(table, {"y", "z"}, dimension::kLength, "y_m", true);
  const TipColumn pressure =
      find_column(table, {"pressure", "p"}, dimension::kPressure, "pressure_kPa", false);
  TipRecord record;
  record.name = std::filesystem::path(name).stem().string();
  record.tip.resize(table.values.rows(), 2);
  for (Eigen::Index row = 0; row < table.values.rows(); ++row) {
    record.time.push_back(time.unit * table.values(row, time.index));
    record.tip(row, 0) = x.unit * table.values(row, x.index);
    record.tip(row, 1) = y.unit * table.values(row, y.index);
    if (pressure.index >= 0) {
      record.pressure.push_back(pressure.unit * table.values(row, pressure.index));
    }
  }
  try {
    check(record);
  } catch (const Error& error) {
    throw error.at(table.place);
  }
  return record;
}

TipRecord read_tip_record(const std::filesystem::path& path) {
  return parse_tip_record(read_file(path), path.string());
}

}  // namespace sinew::identify
