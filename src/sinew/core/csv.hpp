/// @file
/// Tables of numbers as text: a defensive reader, and a writer whose file is complete at any time.
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

/// Requirements on a table that is read.
struct CsvSettings {
  int columns = 0;  ///< exact number of columns; 0: any, the same in every row
  std::size_t max_bytes = std::size_t{256} << 20;  ///< larger files are rejected unread
  bool allow_non_finite = false;                   ///< accept nan and inf as cells
  bool allow_empty = false;                        ///< accept empty cells, as nan
};

/// A table of numbers, with the names of the header if there was one.
struct Table {
  std::vector<std::string> names;    ///< (columns,) or empty
  MatrixX values;                    ///< (rows, columns)
  Location place;                    ///< the file, for errors about its content
  std::vector<int> lines;            ///< (rows,) line of each row in the file, from 1
  int heading_line = 0;              ///< line of the header in the file, from 1; 0: none
  std::vector<int> heading_columns;  ///< (columns,) where each name begins in it, from 1

  /// Index of the column with this name. Throws Error(wrong-columns) with a list of the columns.
  Eigen::Index column(std::string_view name) const;
};

/// Reads a table of numbers. Cells are separated by semicolons, commas, or blanks and tabs: the
/// first of these that the first row uses. Blanks around cells and quotes around names are removed,
/// `#` starts a comment, and empty lines are skipped. Line ends may be LF or CRLF, and a UTF-8 byte
/// order mark is allowed. A first row without numbers is the header; in a table that has none, so
/// is the last comment before the rows if it names every column, and a unit of one ("# time [ms],
/// x [mm]", as NumPy writes it). Numbers use a decimal point in any locale.
/// Throws Error with file:line:column: malformed-table (a cell that is empty or not a number; no
/// rows), wrong-columns (rows of different lengths, or other than settings.columns), not-finite,
/// bad-encoding (UTF-16, binary), size-limit, file-not-found, file-unreadable.
Table read_csv(const std::filesystem::path& path, const CsvSettings& settings = {});

/// Reads a table from memory. `name` replaces the file name in errors.
Table parse_csv(std::string_view bytes, const std::string& name, const CsvSettings& settings = {});

/// Appends a header line to a text. Names with separators or blanks are quoted.
void append_csv_header(std::string& text, std::span<const std::string> names);
/// Appends a line of numbers, each as the shortest text that reads back bit for bit.
void append_csv_row(std::string& text, std::span<const double> values);

/// Writes a table row by row. Each row is passed to the operating system before write_row()
/// returns, so the file of an interrupted run is complete up to its last row. Each number is the
/// shortest text that reads back bit for bit.
class CsvWriter {
 public:
  /// Creates or replaces the file and writes the header. Throws what throw_unwritable() throws.
  /// `names` has one entry per column, at least one; names with separators or blanks are quoted.
  CsvWriter(const std::filesystem::path& path, std::span<const std::string> names);

  /// Appends one row. Does not allocate after the first row. Throws Error(recording-failed) if the
  /// disk is full, and Error(wrong-columns) unless there is one value per column.
  void write_row(std::span<const double> values);

  /// Appends one row with words, such as a status, in the last columns. read_csv() rejects words.
  /// @param values of the first columns. @param words without commas, quotes or line ends.
  void write_row(std::span<const double> values, std::span<const std::string_view> words);

  /// Number of columns.
  int columns() const { return columns_; }

  /// Renames the file, which replaces another one. Throws what throw_unwritable() throws.
  /// @param path its new name, on the same disk.
  void rename(const std::filesystem::path& path);

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
