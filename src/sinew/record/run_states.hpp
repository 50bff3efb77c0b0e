/// @file
/// Writes run.h5, the frames of a run for replay and h5py.
#pragma once

#include <filesystem>
#include <vector>

#include "sinew/record/hdf5_writer.hpp"
#include "sinew/record/run_recorder.hpp"
#include "sinew/sim/observables.hpp"

namespace sinew::record {

/// Writes run.h5 with the layout described at RunRecorder.
class RunStates {
 public:
  /// @param path of the file. @param observables outlive this. @param settings as for RunRecorder.
  RunStates(const std::filesystem::path& path, sim::Observables& observables,
            const RecordSettings& settings);
  /// Appends the current values of the observables as a frame.
  void write();
  void flush() { file_.flush(); }
  /// As Hdf5Writer::rename().
  void rename(const std::filesystem::path& path) { file_.rename(path); }

 private:
  void describe(const RecordSettings& settings);
  void write_meshes();
  void declare_series(bool states);
  void describe_owners();

  sim::Observables& observables_;
  Hdf5Writer file_;
  struct Series {
    std::size_t observable;
    int number;  // in the file
  };
  std::vector<Series> series_;
};

}  // namespace sinew::record
