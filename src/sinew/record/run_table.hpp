/// @file
/// run.csv: headings and rows of a simulation.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/csv.hpp"
#include "sinew/inverse/inverse_controller.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

/// "solved", "limits-conflict", "failed".
/// @param status of a step's law.
std::string_view law_status_name(sim::LawStatus status);

/// Writes run.csv; the columns are those of RunRecorder.
class RunTable {
 public:
  /// @param path of the file. @param simulation,controller as for RunRecorder.
  RunTable(const std::filesystem::path& path, const sim::Simulation& simulation,
           const inverse::InverseController* controller);
  /// Appends the present state as a row. Allocates nothing after the first.
  void write();

 private:
  static std::vector<std::string> names(const sim::Simulation& simulation,
                                        const inverse::InverseController* controller);
  void collect();

  const sim::Simulation& simulation_;
  const inverse::InverseController* controller_;
  CsvWriter writer_;
  std::vector<double> values_;
  std::array<std::string_view, 2> words_;
};

}  // namespace sinew::record
