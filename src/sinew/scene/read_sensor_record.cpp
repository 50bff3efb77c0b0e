#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"
#include "sinew/core/heading.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

// Number of periods after which a sample counts as missing.
constexpr double kGap = 1.5;

// Finds a column by its heading, with or without unit; -1 if there is none.
Eigen::Index find_column(const Table& table, const std::string& name) {
  const auto found = std::ranges::find_if(table.names, [&](const std::string& heading) {
    return heading == name || parse_heading(heading).name == name;
  });
  return found == table.names.end() ? -1 : found - table.names.begin();
}

class RecordReader {
 public:
  RecordReader(const Fields& fields, const SensorDescription& sensor,
               const std::vector<std::string>& numbers, const ReadContext& context)
      : fields_(fields), sensor_(sensor), numbers_(numbers), place_(fields.place("file")) {
    std::string missing;
    if (fields.read_word("missing", missing)) lost_ = missing == "lost";
    CsvSettings settings;
    settings.allow_non_finite = settings.allow_empty = lost_;
    const std::filesystem::path path = context.path(fields, "file");
    table_ = at_place(place_, [&] { return read_csv(path, settings); });
    table_.values.col(0) *= time_unit(fields, table_, 0);
  }

  sense::SensorRecord read() {
    const std::vector<Eigen::Index> columns = choose();
    // sensors.csv has the time of each sample, which also shows whether a row has a new sample.
    const Eigen::Index taken = find_column(table_, sensor_.name + ".sample_time");
    if (taken > 0) table_.values.col(taken) *= time_unit(fields_, table_, taken);
    std::vector<Eigen::Index> rows;
    sense::SensorRecord record;
    for (Eigen::Index row = 0; row < table_.values.rows(); ++row) {
      const double time = table_.values(row, taken < 0 ? 0 : taken);
      if (taken >= 0 && (std::isnan(time) || (!rows.empty() && time == record.times.back()))) {
        continue;
      }
      check_time(row, time, record.times);
      record.arrivals.push_back(taken < 0 ? time + sensor_.channel.delay : table_.values(row, 0));
      record.times.push_back(time);
      rows.push_back(row);
    }
    record.values.resize(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double unit = column_unit(fields_, table_, columns[c]);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        record.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) =
            unit * table_.values(rows[k], columns[c]);
      }
    }
    return record;
  }

 private:
  std::size_t size() const { return std::max<std::size_t>(1, numbers_.size()); }

  std::vector<std::string> named() const {
    std::vector<std::string> names;
    if (const Node* columns = fields_.find("columns")) {
      for (const Node& name : columns->items()) names.push_back(name.spelling());
      return names;
    }
    const std::string own = sensor_.name + ".measured";
    if (numbers_.empty()) return {own};
    for (const std::string& number : numbers_) names.push_back(fmt::format("{}_{}", own, number));
    return names;
  }

  std::vector<Eigen::Index> choose() const {
    const std::vector<std::string> names = named();
    std::vector<Eigen::Index> columns;
    for (const std::string& name : names) columns.push_back(find_column(table_, name));
    const bool asked = fields_.find("columns") != nullptr;
    const auto lacking = std::ranges::find(columns, -1);
    if (lacking == columns.end() && columns.size() == size()) return columns;
    if (asked && lacking == columns.end()) {
      throw Error(ErrorKind::wrong_length, fields_.place("columns"),
                  fmt::format("{} columns for the {} number(s) of sensor '{}'", columns.size(),
                              size(), sensor_.name),
                  "name one for each");
    }
    if (asked) {
      throw Error(ErrorKind::wrong_columns, fields_.place("columns"),
                  fmt::format("there is no column {}",
                              show(names[static_cast<std::size_t>(lacking - columns.begin())])),
                  fmt::format("the columns are {}", join(table_.names)));
    }
    if (table_.values.cols() != static_cast<Eigen::Index>(1 + size())) {
      throw Error(ErrorKind::wrong_columns, place_,
                  fmt::format("the table has {} columns, sensor '{}' needs a time and {}",
                              table_.values.cols(), sensor_.name, size()),
                  "name its columns under `columns`");
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      columns[c] = static_cast<Eigen::Index>(1 + c);
    }
    return columns;
  }

  void check_time(Eigen::Index row, double time, const std::vector<double>& before) const {
    const Location at{table_.place.file, table_.lines[static_cast<std::size_t>(row)], 0,
                      place_.item};
    if (!std::isfinite(time)) {
      throw Error(ErrorKind::not_finite, at, "the time is missing",
                  "give every row its time, also where values are missing");
    }
    if (before.empty()) return;
    if (time <= before.back()) {
      throw Error(ErrorKind::non_monotonic_time, at,
                  fmt::format("time {} s follows {} s", time, before.back()),
                  "times must increase");
    }
    const double period = sensor_.channel.rate > 0.0 ? 1.0 / sensor_.channel.rate : 0.0;
    if (lost_ || period == 0.0 || time - before.back() <= kGap * period) return;
    throw Error(ErrorKind::bad_signal, at,
                fmt::format("no sample between {} s and {} s, at a rate of {:g} Hz", before.back(),
                            time, sensor_.channel.rate),
                "write `missing: lost` where samples may be missing, or give the true rate");
  }

  const Fields& fields_;
  const SensorDescription& sensor_;
  const std::vector<std::string>& numbers_;
  Location place_;
  bool lost_ = false;
  Table table_;
};

}  // namespace

std::shared_ptr<const sense::SensorRecord> read_sensor_record(
    const Fields& fields, const SensorDescription& sensor, const std::vector<std::string>& numbers,
    const ReadContext& context) {
  if (context.files == Files::ignore) return nullptr;
  return std::make_shared<const sense::SensorRecord>(
      RecordReader(fields, sensor, numbers, context).read());
}

}  // namespace sinew::scene
