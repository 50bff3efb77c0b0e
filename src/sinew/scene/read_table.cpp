#include <optional>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"
#include "sinew/core/heading.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

Location row_place(const Table& table, Eigen::Index row, const Location& written) {
  return {table.place.file, table.lines[static_cast<std::size_t>(row)], 0, written.item};
}

// Reads the table under `file`, with columns from `first` on in SI units.
Table read_scaled(const Fields& fields, int columns, Eigen::Index first,
                  const ReadContext& context) {
  const std::filesystem::path path = context.path(fields, "file");
  CsvSettings settings;
  settings.columns = columns;
  Table table = at_place(fields.place("file"), [&] { return read_csv(path, settings); });
  for (Eigen::Index k = first; k < table.values.cols(); ++k) {
    table.values.col(k) *= column_unit(fields, table, k);
  }
  return table;
}

// Whether the scene or a heading has the unit of a column.
bool has_unit(const Fields& fields, const Table& table, Eigen::Index column) {
  const Key* key = fields.table().find("unit");
  const Dimension expected = key != nullptr ? key->forms.front().dimension : dimension::kNone;
  const bool written = key != nullptr && fields.find("unit") != nullptr;
  return written || heading_unit(table, column, expected).has_value();
}

// The column with the heading "NAME" or "NAME [unit]".
Eigen::Index column_of(const Table& table, const std::string& name, const Location& place) {
  for (std::size_t k = 1; k < table.names.size(); ++k) {
    if (table.names[k] == name || parse_heading(table.names[k]).name == name) {
      return static_cast<Eigen::Index>(k);
    }
  }
  throw Error(ErrorKind::wrong_columns, place, fmt::format("there is no column {}", show(name)),
              table.names.size() < 2
                  ? "give the table a first row of headings"
                  : fmt::format("the columns behind the time are {}",
                                fmt::join(table.names.begin() + 1, table.names.end(), ", ")));
}

// Reads the time and one column of a table with headings.
Table read_column(const Fields& fields, const ReadContext& context, bool& unit_given) {
  const std::filesystem::path path = context.path(fields, "file");
  Table table = at_place(fields.place("file"), [&] { return read_csv(path); });
  std::string name;
  fields.read("column", name);
  const Eigen::Index column = column_of(table, name, fields.place("column"));
  unit_given = has_unit(fields, table, column);
  MatrixX values(table.values.rows(), 2);
  values << table.values.col(0), column_unit(fields, table, column) * table.values.col(column);
  table.values = std::move(values);
  return table;
}

}  // namespace

double column_unit(const Fields& fields, const Table& table, Eigen::Index column) {
  const Key* key = fields.table().find("unit");
  const Dimension expected = key != nullptr ? key->forms.front().dimension : dimension::kNone;
  const std::optional<double> said =
      heading_unit(table, column, expected, fields.place("file").item);
  double unit = said.value_or(1.0);
  if (key == nullptr || !fields.read("unit", unit) || !said || unit == *said) return unit;
  const std::string& heading = table.names[static_cast<std::size_t>(column)];
  if (!parse_heading(heading).unit) return unit;  // its last word was no unit after all
  throw Error(ErrorKind::conflicting_keys, fields.place("unit"),
              fmt::format("`unit` and the heading '{}' name different units", heading),
              "leave `unit` out, or correct it");
}

double time_unit(const Fields& fields, const Table& table, Eigen::Index column) {
  return heading_unit(table, column, dimension::kTime, fields.place("file").item).value_or(1.0);
}

std::filesystem::path ReadContext::path(const Fields& fields, std::string_view key) const {
  std::string written;
  fields.read(key, written);
  std::filesystem::path path = base_dir / written;
  if (files == Files::ignore) return path;
  std::error_code status;
  if (!std::filesystem::exists(path, status)) {
    throw Error(ErrorKind::file_not_found, fields.place(key),
                fmt::format("there is no file {}", show(written)),
                fmt::format("paths are relative to the scene's folder; looked for {}",
                            std::filesystem::absolute(path, status).lexically_normal().string()));
  }
  if (!std::filesystem::is_regular_file(path, status)) {
    throw Error(ErrorKind::file_unreadable, fields.place(key),
                fmt::format("{} is not a file", show(written)), "give the path of a file");
  }
  return path;
}

TimeTable read_time_table(const Fields& fields, int columns, const ReadContext& context) {
  TimeTable result;
  if (context.files == Files::ignore) return result;
  const bool named = columns == 1 && fields.find("column") != nullptr;
  Table table = named ? read_column(fields, context, result.unit_given)
                      : read_scaled(fields, columns + 1, 1, context);
  if (!named) result.unit_given = has_unit(fields, table, 1);
  table.values.col(0) *= time_unit(fields, table, 0);
  for (Eigen::Index row = 0; row < table.values.rows(); ++row) {
    const double time = table.values(row, 0);
    if (row > 0 && time <= result.times.back()) {
      throw Error(ErrorKind::non_monotonic_time, row_place(table, row, fields.place("file")),
                  fmt::format("time {} s follows {} s", time, result.times.back()),
                  "times in the first column must increase");
    }
    result.times.push_back(time);
  }
  result.values = table.values.rightCols(columns);
  return result;
}

PointList read_points(const Fields& fields, std::string_view key, const ReadContext& context) {
  PointList list;
  list.place = fields.place(key);
  const Node& node = *fields.find(key);
  const Form& form = fields.form(key);
  if (form.shape == Shape::list) {
    list.points.resize(static_cast<Eigen::Index>(node.items().size()), 3);
    for (const Node& item : node.items()) {
      const Form& written = select_form(item, form.items, {});
      Vector3 point;
      if (written.shape == Shape::table) {
        const Fields other(item, written);
        list.bodies.resize(static_cast<std::size_t>(list.points.rows()));
        other.read("body", list.bodies[list.places.size()]);
        other.read("point", point);
      } else {
        point = Vector3(read_numbers(item, written).data());
      }
      list.points.row(static_cast<Eigen::Index>(list.places.size())) = point.transpose();
      list.places.push_back(item.place());
    }
    return list;
  }
  if (context.files == Files::ignore) return list;
  const Fields file = fields.below(key);
  list.place = file.place("file");
  const Table table = read_scaled(file, 3, 0, context);
  list.points = table.values;
  for (Eigen::Index row = 0; row < table.values.rows(); ++row) {
    list.places.push_back(row_place(table, row, list.place));
  }
  return list;
}

}  // namespace sinew::scene
