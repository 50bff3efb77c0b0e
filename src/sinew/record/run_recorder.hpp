/// @file
/// Writes a run as it goes: run.csv, run.h5, and a VTU series for ParaView.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/core/csv.hpp"
#include "sinew/inverse/inverse_controller.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/record/hdf5_file.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

struct RecordSettings {
  std::filesystem::path folder;  ///< made when missing
  int every = 1;                 ///< steps per record, >= 1
  bool states = true;            ///< positions of all nodes into run.h5
  bool vtk = false;              ///< a .pvd series per body
  std::string scene;             ///< YAML text, kept in run.h5 and scene.yaml
};

/// Columns of run.csv: time [s]; NAME.tension [N] (or .force) and NAME.displacement [m] of every
/// actuator; NAME.x, .y, .z [m] of every effector (rotation vector [rad] for orientations);
/// residual [N], relative_residual, violation [m], iterations, scale, volume_ratio; with a
/// controller also error [m], predicted_error [m] and status (0 on-target, 1 rate-limited,
/// 2 out-of-reach, 3 limits-conflict). run.h5 holds the same as arrays with a `unit` attribute,
/// /positions/BODY (frames, n, 3) and /mesh/BODY. Every row is on disk when record() returns;
/// run.h5 is flushed every second of wall time and at the end.
class RunRecorder {
 public:
  /// Creates the files. Throws Error(file-unwritable).
  /// @param simulation that is recorded; must outlive the recorder.
  /// @param controller that steers it, or null.
  /// @param settings where and what.
  RunRecorder(const sim::Simulation& simulation, const inverse::InverseController* controller,
              RecordSettings settings);
  ~RunRecorder();

  /// Call after every step (and once before the first); writes when it is due.
  /// Throws Error(recording-failed).
  void record();
  /// Flushes everything. Throws Error(recording-failed).
  void finish();
  int frames() const { return frames_; }

 private:
  std::vector<std::string> columns() const;
  void declare_arrays();
  void write_states();

  const sim::Simulation& simulation_;
  const inverse::InverseController* controller_;
  RecordSettings settings_;
  std::unique_ptr<CsvWriter> csv_;
  std::unique_ptr<Hdf5Writer> h5_;
  std::vector<std::unique_ptr<mesh::PvdWriter>> vtk_;
  std::vector<double> row_;
  std::vector<int> column_arrays_, position_arrays_;
  int frames_ = 0;
  double last_flush_ = 0.0;
};

}  // namespace sinew::record
