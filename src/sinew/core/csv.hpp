/// @file
/// Tables of numbers as text: a defensive reader and a writer whose file is readable at any time.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew {

/// What a table must look like, and how large it may be.
struct CsvSettings {
  int columns = 0;  ///< exact number of columns; 0: any, the same in every row
  std::size_t max_bytes = std::size_t{256} << 20;  ///< larger files are refused before reading
  bool allow_non_finite = false;                   ///< accept nan and inf as cells
  bool allow_empty = false;                        ///< accept empty cells, as nan
};

/// Numbers in rows, with the header's names if there was a header.
struct Table {
  std::vector<std::string> names;  ///< (columns) or empty
  MatrixX values;                  ///< (rows, columns)
  Location place;                  ///< the file, for errors about its content
  std::vector<int> lines;          ///< (rows) line of each row in the file, from 1

  /// The column of that name. Throws Error(wrong-columns) naming the columns there are.
  Eigen::Index column(std::string_view name) const;
};

/// Reads a table of numbers. Cells stand between commas, semicolons, or blanks and tabs, whichever
/// the first row uses (in this order of precedence); blanks around cells and quotes around names
/// are dropped; `#` starts a comment; empty lines are skipped; LF, CRLF and a UTF-8 byte order mark
/// are understood. A first row without any number is the header. Numbers use a decimal point,
/// whatever the locale.
/// Throws Error with file:line:column: malformed-table (a cell that is no number, or empty; no
/// rows), wrong-columns (a row of another length, or other than settings.columns), not-finite,
/// bad-encoding (UTF-16, binary), size-limit, file-not-found, file-unreadable.
Table read_csv(const std::filesystem::path& path, const CsvSettings& settings = {});

/// The same for text in memory; `name` stands for the file in errors.
Table parse_csv(std::string_view bytes, const std::string& name, const CsvSettings& settings = {});

/// Appends a header line to a text; names with commas or blanks are quoted.
void append_csv_header(std::string& text, std::span<const std::string> names);
/// Appends a line of numbers, each the shortest text that reads back bit for bit.
void append_csv_row(std::string& text, std::span<const double> values);

/// Writes rows as they come. Each row is handed to the operating system before write_row returns,
/// so the file of an interrupted run is whole up to its last row. Numbers are the shortest text
/// that reads back bit for bit.
class CsvWriter {
 public:
  /// Creates or replaces the file and writes the header. Throws Error(file-unwritable).
  /// `names` has one entry per column, at least one; those with commas or blanks are quoted.
  CsvWriter(const std::filesystem::path& path, std::span<const std::string> names);

  /// Appends one row. Allocates nothing after the first row. Throws Error(recording-failed) when
  /// the disk is full, and Error(wrong-columns) when the count differs from the header's.
  void write_row(std::span<const double> values);

  /// As above with words in the last columns (statuses); read_csv() reads numbers only.
  /// @param values of the first columns. @param words without commas, quotes or line ends.
  void write_row(std::span<const double> values, std::span<const std::string_view> words);

  /// Number of columns.
  int columns() const { return columns_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void flush_line();

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::string line_;
  int columns_ = 0;
};

}  // namespace sinew
