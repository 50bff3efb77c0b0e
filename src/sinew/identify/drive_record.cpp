#include "sinew/identify/drive_record.hpp"

#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/heading.hpp"
#include "sinew/core/unit.hpp"
#include "sinew/identify/column_name.hpp"

namespace sinew::identify {

namespace {

Eigen::Index find_column(const Table& table, std::initializer_list<std::string_view> words,
                         const char* example) {
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string name = plain_name(table.names[i]);
    const std::string first = name.substr(0, name.find_first_of(" [("));
    for (const std::string_view word : words) {
      if (first == word) return static_cast<Eigen::Index>(i);
    }
  }
  throw Error(ErrorKind::wrong_columns, table.place,
              fmt::format("no column is called {}; the columns are {}", *words.begin(),
                          fmt::join(table.names, ", ")),
              fmt::format("call one {}", example));
}

double unit_of(const Table& table, Eigen::Index column, Dimension dimension, const char* example) {
  const std::string& name = table.names[static_cast<std::size_t>(column)];
  const auto unit = heading_unit(table, column, dimension);
  if (unit) return *unit;
  throw Error(ErrorKind::wrong_columns, table.place,
              fmt::format("'{}' does not say {}", name, dimension_name(dimension)),
              fmt::format("write it with its unit, as {}", example));
}

/// A command is a volume, a voltage, or whatever else the drive takes; the gain of the drive has
/// its unit.
double command_unit(const Table& table, Eigen::Index column) {
  const std::optional<std::string> unit =
      parse_heading(table.names[static_cast<std::size_t>(column)]).unit;
  const Dimension own =
      unit && *unit != "-"
          ? parse_unit_expression(*unit, {.file = table.place.file, .line = table.heading_line})
                .dimension
      : unit ? dimension::kNone
             : dimension::kVolume;
  return heading_unit(table, column, own).value_or(1.0);
}

}  // namespace

DriveRecord parse_drive_record(std::string_view bytes, const std::string& name) {
  const Table table = parse_csv(bytes, name);
  const Eigen::Index time = find_column(table, {"time", "t"}, "time [s]");
  const Eigen::Index input = find_column(table, {"command", "input"}, "command");
  const Eigen::Index output = find_column(table, {"volume", "output"}, "volume [ml]");
  DriveRecord record;
  record.name = std::filesystem::path(name).stem().string();
  record.input = table.values.col(input) * command_unit(table, input);
  record.output =
      table.values.col(output) * unit_of(table, output, dimension::kVolume, "volume [ml]");
  const VectorX times = table.values.col(time) * unit_of(table, time, dimension::kTime, "time [s]");
  const Eigen::Index n = times.size();
  if (n < 3) {
    throw Error(ErrorKind::too_few_points, table.place, fmt::format("the table has {} rows", n),
                "give a longer record");
  }
  record.sample_time = (times[n - 1] - times[0]) / static_cast<double>(n - 1);
  for (Eigen::Index i = 1; i < n; ++i) {
    if (times[i] > times[i - 1]) continue;
    throw Error(ErrorKind::non_monotonic_time, table.place,
                fmt::format("row {}: {:g} s comes after {:g} s", i + 1, times[i], times[i - 1]),
                "sort the rows and leave out repeated times");
  }
  for (Eigen::Index i = 1; i < n; ++i) {
    const double step = times[i] - times[i - 1];
    if (std::abs(step - record.sample_time) <= 0.01 * record.sample_time) continue;
    throw Error(ErrorKind::out_of_range, table.place,
                fmt::format("row {} comes {:g} s after the one before, others {:g} s", i + 1, step,
                            record.sample_time),
                "resample the record to even steps");
  }
  return record;
}

DriveRecord read_drive_record(const std::filesystem::path& path) {
  return parse_drive_record(read_file(path), path.string());
}

}  // namespace sinew::identify
