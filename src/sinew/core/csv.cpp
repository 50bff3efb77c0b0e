#include "sinew/core/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/heading.hpp"
#include "sinew/core/text.hpp"
#include "sinew/core/unit.hpp"

namespace sinew {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// A cell as shown in messages: shortened and printable.
std::string shown(std::string_view cell) {
  constexpr std::size_t kLongest = 40;
  std::string text(cell.substr(0, kLongest));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return cell.size() > kLongest ? text + "..." : text;
}

std::string_view unquoted(std::string_view cell) {
  const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return quoted ? cell.substr(1, cell.size() - 2) : cell;
}

enum class CellKind { number, overflow, text };

CellKind read_number(std::string_view cell, double* value) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  const char* end = cell.data() + cell.size();
  const auto [rest, error] = std::from_chars(cell.data(), end, *value);
  if (rest != end || cell.empty()) return CellKind::text;
  if (error == std::errc::result_out_of_range) return CellKind::overflow;
  return error == std::errc{} ? CellKind::number : CellKind::text;
}

/// Whether a heading has a unit in brackets.
bool has_unit(std::string_view heading) {
  const std::optional<std::string> unit = parse_heading(heading).unit;
  if (!unit || unit->empty()) return false;
  try {
    parse_unit_expression(*unit, {});
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Splits text into lines and cells and fills a table.
class TableReader {
 public:
  TableReader(std::string_view bytes, const std::string& name, const CsvSettings& settings)
      : bytes_(bytes), settings_(settings) {
    place_.file = name;
  }

  Table read() {
    check_encoding();
    while (next_line()) {
      if (cells_.empty()) {
        if (columns_ == 0) keep_comment();
      } else if (columns_ == 0 && is_header()) {
        take_header();
      } else {
        if (columns_ == 0) take_comment();
        take_row();
      }
    }
    if (table_.lines.empty()) {
      place_.line = 0;
      fail(ErrorKind::malformed_table, 0, "the table has no rows of numbers",
           "write one row of numbers a line");
    }
    return finished();
  }

 private:
  [[noreturn]] void fail(ErrorKind kind, std::size_t column, const std::string& message,
                         const std::string& remedy) {
    place_.column = static_cast<int>(column);
    throw Error(kind, place_, message, remedy);
  }

  void check_encoding() {
    if (bytes_.starts_with(kByteOrderMark)) {
      bytes_.remove_prefix(kByteOrderMark.size());
      mark_ = true;
    }
    const bool utf16 = bytes_.starts_with("\xFF\xFE") || bytes_.starts_with("\xFE\xFF");
    if (utf16 || bytes_.find('\0') != std::string_view::npos) {
      fail(ErrorKind::bad_encoding, 0, utf16 ? "the table is UTF-16" : "the table is not text",
           "save it as UTF-8 text");
    }
  }

  bool next_line() {
    if (position_ >= bytes_.size()) return false;
    const std::size_t end = std::min(bytes_.find_first_of("\r\n", position_), bytes_.size());
    line_ = bytes_.substr(position_, end - position_);
    position_ = end + (bytes_.substr(end).starts_with("\r\n") ? 2 : 1);
    ++place_.line;
    split();
    return true;
  }

  void split() {
    cells_.clear();
    const std::string_view content = line_.substr(0, comment_start());
    if (trimmed(content).empty()) return;
    if (separator_ == '\0') {
      separator_ = content.find(';') != std::string_view::npos   ? ';'
                   : content.find(',') != std::string_view::npos ? ','
                                                                 : ' ';
    }
    split(content);
  }

  void split(std::string_view content) {
    std::size_t start = 0;
    bool in_quotes = false;
    if (separator_ == ' ') content = trimmed(content);
    for (std::size_t i = 0; i <= content.size(); ++i) {
      const bool end = i == content.size();
      if (!end && content[i] == '"') in_quotes = !in_quotes;
      const bool boundary =
          end ||
          (!in_quotes && (separator_ == ' ' ? is_blank(content[i]) : content[i] == separator_));
      if (!boundary) continue;
      const std::string_view cell = trimmed(content.substr(start, i - start));
      if (!cell.empty() || separator_ != ' ') cells_.push_back(cell);
      start = i + 1;
    }
    if (!in_quotes) return;
    fail(ErrorKind::malformed_table, column_of(cells_.back()),
         fmt::format("the quote of {} is not closed", shown(cells_.back())), "close it");
  }

  std::size_t comment_start() const {
    bool in_quotes = false;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      if (line_[i] == '"') in_quotes = !in_quotes;
      if (line_[i] == '#' && !in_quotes) return i;
    }
    return line_.size();
  }

  /// Column in the file, from 1, of a cell of the current line.
  std::size_t column_of(std::string_view cell) const {
    const auto offset = static_cast<std::size_t>(cell.data() - line_.data());
    return offset + 1 + (mark_ && place_.line == 1 ? kByteOrderMark.size() : 0);
  }

  bool is_header() const {
    double value = 0.0;
    return std::none_of(cells_.begin(), cells_.end(), [&](std::string_view cell) {
      return cell.empty() || read_number(cell, &value) != CellKind::text;
    });
  }

  void take_header() {
    join_units();
    for (const std::string_view cell : cells_) {
      table_.names.emplace_back(unquoted(cell));
      table_.heading_columns.push_back(static_cast<int>(column_of(cell)));
    }
    table_.heading_line = place_.line;
    check_columns();
    columns_ = cells_.size();
  }

  /// Between blanks, "x [mm]" is two cells but one name.
  void join_units() {
    if (separator_ != ' ') return;
    std::vector<std::string_view> joined;
    for (const std::string_view cell : cells_) {
      if (!joined.empty() && (cell.front() == '[' || cell.front() == '(')) {
        const char* begin = joined.back().data();
        const auto size = static_cast<std::size_t>(cell.data() + cell.size() - begin);
        joined.back() = std::string_view(begin, size);
      } else {
        joined.push_back(cell);
      }
    }
    cells_ = std::move(joined);
  }

  void keep_comment() {
    const std::size_t begin = comment_start();
    if (begin == line_.size()) return;
    comment_ = line_;
    comment_line_ = place_.line;
  }

  /// Takes the last comment as the header of the first row, if it is one with units.
  void take_comment() {
    if (std::ranges::count(comment_, '"') % 2 != 0 || comment_.empty()) return;
    const std::vector<std::string_view> row = cells_;
    const std::string_view line = std::exchange(line_, comment_);
    const int number = std::exchange(place_.line, comment_line_);
    cells_.clear();
    split(line_.substr(std::min(line_.find_first_not_of("# \t"), line_.size())));
    join_units();
    if (cells_.size() == row.size() && is_header() && std::ranges::any_of(cells_, has_unit)) {
      take_header();
    }
    line_ = line;
    place_.line = number;
    cells_ = row;
  }

  void check_columns() {
    const auto wanted =
        settings_.columns > 0 ? static_cast<std::size_t>(settings_.columns) : columns_;
    if (wanted == 0 || cells_.size() == wanted) return;
    const std::size_t at = cells_.size() > wanted ? column_of(cells_[wanted]) : line_.size();
    fail(ErrorKind::wrong_columns, std::max<std::size_t>(at, 1),
         fmt::format("expected {} column{}, got {}", wanted, wanted == 1 ? "" : "s", cells_.size()),
         "give every row the same number of cells, separated alike");
  }

  void take_row() {
    check_columns();
    columns_ = cells_.size();
    for (const std::string_view cell : cells_) numbers_.push_back(number(cell));
    table_.lines.push_back(place_.line);
  }

  double number(std::string_view cell) {
    double value = 0.0;
    const CellKind kind = read_number(cell, &value);
    if (kind == CellKind::number && (std::isfinite(value) || settings_.allow_non_finite))
      return value;
    if (cell.empty()) {
      if (settings_.allow_empty) return std::numeric_limits<double>::quiet_NaN();
      fail(ErrorKind::malformed_table, column_of(cell), "the cell is empty",
           "write a number, or leave the separator out");
    }
    if (kind == CellKind::text) {
      const bool comma = cell.find(',') != std::string_view::npos;
      fail(ErrorKind::malformed_table, column_of(cell),
           fmt::format("'{}' is not a number", shown(cell)),
           comma ? "write decimals with a point" : "write a number such as 0.01 or 1e-2");
    }
    fail(ErrorKind::not_finite, column_of(cell),
         fmt::format("'{}' is not a finite number", shown(cell)), "write a finite number");
  }

  Table finished() {
    const auto rows = static_cast<Eigen::Index>(table_.lines.size());
    const auto columns = static_cast<Eigen::Index>(columns_);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    table_.values = Eigen::Map<const RowMajor>(numbers_.data(), rows, columns);
    table_.place.file = place_.file;
    return std::move(table_);
  }

  std::string_view bytes_;
  CsvSettings settings_;
  Location place_;
  Table table_;
  std::string_view line_;
  std::string_view comment_;  // the last line before the first row that is only a comment
  int comment_line_ = 0;
  std::vector<std::string_view> cells_;
  std::vector<double> numbers_;
  std::size_t position_ = 0;
  std::size_t columns_ = 0;
  char separator_ = '\0';
  bool mark_ = false;
};

}  // namespace

Eigen::Index Table::column(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return found - names.begin();
  const std::string nearest = nearest_word(name, names);
  throw Error(ErrorKind::wrong_columns, place,
              names.empty()
                  ? fmt::format("there is no column '{}': the table has no header", name)
                  : fmt::format("there is no column '{}' among {}", name, fmt::join(names, ", ")),
              nearest.empty() ? "name the columns in the first row"
                              : fmt::format("did you mean '{}'?", nearest));
}

Table parse_csv(std::string_view bytes, const std::string& name, const CsvSettings& settings) {
  if (bytes.size() > settings.max_bytes) {
    throw Error(
        ErrorKind::size_limit, {.file = name},
        fmt::format("the table has {} bytes, more than {}", bytes.size(), settings.max_bytes),
        "thin it out");
  }
  return TableReader(bytes, name, settings).read();
}

Table read_csv(const std::filesystem::path& path, const CsvSettings& settings) {
  const Location place{.file = path.string()};
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw Error(ErrorKind::file_not_found, place, "the file does not exist",
                "check the path; it is taken relative to the file that names it");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(ErrorKind::file_unreadable, place, "this is not a regular file",
                "name a text file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > settings.max_bytes) {
    throw Error(ErrorKind::size_limit, place,
                fmt::format("the file has {} bytes, more than {}", size, settings.max_bytes),
                "thin it out");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(error ? 0 : static_cast<std::size_t>(size), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (error || !file) {
    throw Error(ErrorKind::file_unreadable, place, "the file cannot be read",
                "check its permissions");
  }
  return parse_csv(bytes, path.string(), settings);
}

}  // namespace sinew
