#include "sinew/identify/motion_record.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/csv.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/heading.hpp"
#include "sinew/identify/column_name.hpp"

namespace sinew::identify {

namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

/// "x_0 [mm]" is the word x with the number 0.
struct Heading {
  std::string word;
  int number = -1;
};

Heading heading_of(const std::string& column) {
  const std::string name = plain_name(column);
  std::size_t i = 0;
  Heading heading;
  while (i < name.size() && std::isalpha(static_cast<unsigned char>(name[i])) != 0) {
    heading.word += name[i++];
  }
  while (i < name.size() && name[i] == ' ') ++i;
  if (i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])) != 0) {
    int number = 0;
    // At most four digits: no arm has more segments.
    for (int k = 0; k < 4 && i < name.size() && std::isdigit(static_cast<unsigned char>(name[i]));
         ++k) {
      number = 10 * number + (name[i++] - '0');
    }
    heading.number = number;
  }
  return heading;
}

struct Source {
  Eigen::Index column = -1;
  double unit = 1.0;
};

struct Columns {
  Source time;
  std::vector<Source> position;  // 3 segments
  std::vector<Source> volume, torque;
};

void take_input(const Table& table, std::vector<Source>& inputs, int number, Source source) {
  if (number < 0 || number > 1000) {
    throw Error(
        ErrorKind::wrong_columns, table.place,
        fmt::format("'{}' has no number", table.names[static_cast<std::size_t>(source.column)]),
        "number inputs from 0, as volume_0 [ml]");
  }
  inputs.resize(std::max(inputs.size(), static_cast<std::size_t>(number) + 1));
  inputs[static_cast<std::size_t>(number)] = source;
}

Columns find_columns(const Table& table, int segments) {
  Columns columns;
  columns.position.resize(static_cast<std::size_t>(3 * segments));
  const auto source = [&](std::size_t i, Dimension dimension, const char* example) {
    const auto unit = heading_unit(table, static_cast<Eigen::Index>(i), dimension);
    if (!unit) {
      throw Error(ErrorKind::wrong_columns, table.place,
                  fmt::format("'{}' does not say {}", table.names[i], dimension_name(dimension)),
                  fmt::format("write it with its unit, as {}", example));
    }
    return Source{static_cast<Eigen::Index>(i), *unit};
  };
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const Heading heading = heading_of(table.names[i]);
    if (heading.word == "time" || (heading.word == "t" && columns.time.column < 0)) {
      columns.time = source(i, dimension::kTime, "time [s]");
    } else if (heading.word == "volume") {
      take_input(table, columns.volume, heading.number,
                 source(i, dimension::kVolume, "volume_0 [ml]"));
    } else if (heading.word == "torque") {
      take_input(table, columns.torque, heading.number,
                 source(i, dimension::kEnergy, "torque_0 [N m]"));
    } else if (heading.word == "x" || heading.word == "y" || heading.word == "z") {
      if (heading.number < 0 || heading.number >= segments) {
        throw Error(ErrorKind::wrong_columns, table.place,
                    fmt::format("'{}' names no segment of the arm's {}", table.names[i], segments),
                    fmt::format("number the segments' ends 0 to {}, as x_0 [mm]", segments - 1));
      }
      columns.position[static_cast<std::size_t>(3 * heading.number + (heading.word[0] - 'x'))] =
          source(i, dimension::kLength, "x_0 [mm]");
    }
  }
  const auto fail = [&](const char* what, const char* remedy) {
    throw Error(ErrorKind::wrong_columns, table.place,
                fmt::format("{}; the columns are {}", what, fmt::join(table.names, ", ")), remedy);
  };
  if (columns.time.column < 0) fail("no column is a time", "call one time [s]");
  if (std::ranges::none_of(columns.position, [](const Source& s) { return s.column >= 0; })) {
    fail("no column is a position", "call them x_0 [mm], y_0 [mm], z_0 [mm], x_1 [mm] ...");
  }
  if (!columns.volume.empty() && !columns.torque.empty()) {
    fail("it has volumes and torques", "keep what drives the arm");
  }
  for (const auto* inputs : {&columns.volume, &columns.torque}) {
    if (std::ranges::any_of(*inputs, [](const Source& s) { return s.column < 0; })) {
      fail("a number is left out among the inputs", "number them 0, 1, ...");
    }
  }
  return columns;
}

/// The table with its lines above the header, which names a time, left empty; they are a preamble.
std::string from_header(std::string_view bytes) {
  std::size_t line = 0;
  while (line < bytes.size()) {
    const std::string_view rest = bytes.substr(line);
    const std::string first = plain_name(rest.substr(0, std::min<std::size_t>(rest.size(), 256)));
    const std::string text = first.substr(0, first.find_first_of("\r\n"));
    if (text.find("time") != std::string::npos && text.find_first_of(",;") != std::string::npos) {
      return std::string(static_cast<std::size_t>(std::count(bytes.begin(), rest.begin(), '\n')),
                         '\n')
          .append(rest);
    }
    line = std::min(bytes.find('\n', line), bytes.size() - 1) + 1;
  }
  return std::string(bytes);
}

}  // namespace

Eigen::Index MotionRecord::seen() const {
  return position.size() - position.array().isNaN().count();
}

void check(const MotionRecord& record) {
  const auto require = [&](bool good, ErrorKind kind, const std::string& message,
                           const char* remedy) {
    if (!good) throw Error(kind, {.item = record.name}, message, remedy);
  };
  const Eigen::Index n = record.samples();
  require(n >= 3, ErrorKind::too_few_points, fmt::format("the record has {} samples", n),
          "motion needs three or more");
  require(record.position.rows() == n && record.position.cols() % 3 == 0 &&
              (record.input.cols() == 0 || record.input.rows() == n),
          ErrorKind::wrong_length,
          fmt::format("{} times, ({}, {}) positions, ({}, {}) inputs", n, record.position.rows(),
                      record.position.cols(), record.input.rows(), record.input.cols()),
          "give a row of positions and of inputs for each time");
  require(record.time.allFinite(), ErrorKind::not_finite, "a time is not finite",
          "leave out rows without a time");
  require(record.input.size() == 0 || record.input.allFinite(), ErrorKind::not_finite,
          "an input is not finite",
          "inputs must be known throughout; only positions may be missing");
  require(!record.position.array().isInf().any(), ErrorKind::not_finite, "a position is infinite",
          "write nan for what was not seen");
  for (Eigen::Index i = 1; i < n; ++i) {
    require(
        record.time[i] > record.time[i - 1], ErrorKind::non_monotonic_time,
        fmt::format("row {}: {:g} s comes after {:g} s", i + 1, record.time[i], record.time[i - 1]),
        "sort the rows and leave out repeated times");
  }
  require(record.seen() > 0, ErrorKind::out_of_range, "no position was seen",
          "give positions in at least one row");
}

MotionRecord parse_motion_record(std::string_view bytes, const std::string& name, int segments) {
  CsvSettings settings;
  settings.allow_non_finite = settings.allow_empty = true;
  const Table table = parse_csv(from_header(bytes), name, settings);
  const Columns columns = find_columns(table, segments);
  const Eigen::Index rows = table.values.rows();
  const auto value = [&](Eigen::Index row, const Source& source) {
    return source.column < 0 ? kGap : source.unit * table.values(row, source.column);
  };
  MotionRecord record;
  record.name = std::filesystem::path(name).stem().string();
  record.time.resize(rows);
  record.position.resize(rows, 3 * segments);
  const auto& inputs = columns.torque.empty() ? columns.volume : columns.torque;
  record.input.resize(rows, static_cast<Eigen::Index>(inputs.size()));
  for (Eigen::Index row = 0; row < rows; ++row) {
    record.time[row] = value(row, columns.time);
    for (Eigen::Index k = 0; k < record.position.cols(); ++k) {
      record.position(row, k) = value(row, columns.position[static_cast<std::size_t>(k)]);
    }
    for (Eigen::Index k = 0; k < record.input.cols(); ++k) {
      record.input(row, k) = value(row, inputs[static_cast<std::size_t>(k)]);
    }
  }
  try {
    check(record);
  } catch (const Error& error) {
    throw error.at(table.place);
  }
  return record;
}

MotionRecord read_motion_record(const std::filesystem::path& path, int segments) {
  return parse_motion_record(read_file(path), path.string(), segments);
}

std::string motion_csv(const MotionRecord& record, bool torque) {
  std::string text = "time [s]";
  for (Eigen::Index k = 0; k < record.position.cols(); ++k) {
    text += fmt::format(",{}_{} [m]", "xyz"[k % 3], k / 3);
  }
  for (Eigen::Index k = 0; k < record.input.cols(); ++k) {
    text += torque ? fmt::format(",torque_{} [N m]", k) : fmt::format(",volume_{} [m^3]", k);
  }
  text += '\n';
  for (Eigen::Index row = 0; row < record.samples(); ++row) {
    text += fmt::format("{}", record.time[row]);
    for (Eigen::Index k = 0; k < record.position.cols(); ++k) {
      const double x = record.position(row, k);
      text += std::isnan(x) ? "," : fmt::format(",{}", x);
    }
    for (Eigen::Index k = 0; k < record.input.cols(); ++k) {
      text += fmt::format(",{}", record.input(row, k));
    }
    text += '\n';
  }
  return text;
}

InputSignal::InputSignal(const MotionRecord& record)
    : time_(record.time), value_(record.input), slope_(value_.rows(), value_.cols()) {
  const Eigen::Index n = time_.size();
  for (Eigen::Index i = 0; i < n && value_.cols() > 0; ++i) {
    const Eigen::Index middle = std::clamp<Eigen::Index>(i, 1, n - 2);
    const double before = time_[middle] - time_[middle - 1],
                 after = time_[middle + 1] - time_[middle];
    for (Eigen::Index k = 0; k < value_.cols(); ++k) {
      const double left = (value_(middle, k) - value_(middle - 1, k)) / before;
      const double right = (value_(middle + 1, k) - value_(middle, k)) / after;
      const double curve = (right - left) / (before + after);
      slope_(i, k) = left + curve * ((time_[i] - time_[middle]) + (time_[i] - time_[middle - 1]));
    }
  }
}

InputSignal::Value InputSignal::at(Eigen::Index input, double time) const {
  const Eigen::Index n = time_.size();
  if (time < time_[0]) return {value_(0, input), 0.0};
  if (time >= time_[n - 1]) return {value_(n - 1, input), 0.0};
  const Eigen::Index i = std::upper_bound(time_.data(), time_.data() + n, time) - time_.data() - 1;
  const double h = time_[i + 1] - time_[i], s = (time - time_[i]) / h;
  const double a = value_(i, input), b = value_(i + 1, input);
  const double da = h * slope_(i, input), db = h * slope_(i + 1, input);
  const double c2 = 3.0 * (b - a) - 2.0 * da - db, c3 = da + db - 2.0 * (b - a);
  return {a + s * (da + s * (c2 + s * c3)), (da + s * (2.0 * c2 + 3.0 * s * c3)) / h};
}

}  // namespace sinew::identify
