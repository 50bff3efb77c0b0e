/// @file
/// run.csv: headings and rows of a simulation.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sinew/core/csv.hpp"
#include "sinew/inverse/inverse_controller.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

/// Writes run.csv; the columns are those of RunRecorder.
class RunTable {
 public:
  /// @param path of the file. @param simulation,controller as for RunRecorder.
  RunTable(const std::filesystem::path& path, sim::Simulation& simulation,
           const inverse::InverseController* controller);
  /// Appends the present state as a row. Evaluates the elements for their energy.
  void write();

 private:
  static std::vector<std::string> names(const sim::Simulation& simulation,
                                        const inverse::InverseController* controller);
  void collect();
  void collect_energies();

  sim::Simulation& simulation_;
  const inverse::InverseController* controller_;
  CsvWriter writer_;
  std::vector<double> values_;
  bool started_ = false;
  double first_energy_ = 0.0, first_work_ = 0.0, first_outside_ = 0.0,
         first_dissipation_ = 0.0;  // J, of the first row
  std::array<std::string_view, 2> words_;
};

/// Writes probes.csv: time and the numbers of every probe.
class ProbeTable {
 public:
  /// @param path of the file. @param simulation whose model has probes.
  ProbeTable(const std::filesystem::path& path, const sim::Simulation& simulation);
  /// Appends the present state as a row.
  void write();

 private:
  const sim::Simulation& simulation_;
  CsvWriter writer_;
};

}  // namespace sinew::record
