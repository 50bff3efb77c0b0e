/// @file
/// Writes run.csv, probes.csv and sensors.csv.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "sinew/core/csv.hpp"
#include "sinew/record/run_layout.hpp"
#include "sinew/sim/observables.hpp"

namespace sinew::record {

/// Writes a table of the observables that is_in_table() selects, in their order; statuses come
/// last, as words.
class RunTable {
 public:
  /// Throws Error(file-unwritable).
  /// @param path of the file. @param observables must outlive this. @param table which one.
  RunTable(const std::filesystem::path& path, sim::Observables& observables, TableKind table);
  /// Appends the current values of the observables as a row. Throws what CsvWriter::write_row()
  /// throws.
  void write();
  /// As CsvWriter::rename().
  void rename(const std::filesystem::path& path) { writer_.rename(path); }

 private:
  sim::Observables& observables_;
  std::vector<std::size_t> numbers_, words_;  // of the list
  CsvWriter writer_;
  std::vector<double> row_;
  std::vector<std::string_view> row_words_;
};

}  // namespace sinew::record
