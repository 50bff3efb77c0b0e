/// @file
/// run.h5: the frames of a run for replay and for h5py.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sinew/inverse/inverse_controller.hpp"
#include "sinew/record/hdf5_writer.hpp"
#include "sinew/record/run_recorder.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

/// Writes run.h5, laid out as RunRecorder says.
class RunStates {
 public:
  /// @param path of the file. @param simulation,controller,settings as for RunRecorder.
  RunStates(const std::filesystem::path& path, const sim::Simulation& simulation,
            const inverse::InverseController* controller, const RecordSettings& settings);
  /// Appends the present state as a frame.
  void write();
  void flush() { file_.flush(); }

 private:
  void describe(const RecordSettings& settings);
  void declare_bodies(bool states);
  void declare_actuators();
  void declare_effectors();
  void declare_probes();
  void declare_contacts();
  void declare_report();
  void write_probe(int index);
  void write_contact(int index);
  int declare(const std::string& path, const std::vector<std::uint64_t>& shape, const char* unit);
  void append(int series, double value) { file_.append(series, {&value, 1}); }
  void append(int series, const Vector3& value) { file_.append(series, {value.data(), 3}); }

  const sim::Simulation& simulation_;
  const inverse::InverseController* controller_;
  Hdf5Writer file_;
  int time_ = -1;
  std::vector<int> positions_, velocities_, efforts_, motions_, effectors_, targets_, errors_;
  std::vector<int> coordinates_;  // one a body, of arms; -1 of others
  struct ProbeSeries {
    int value, positions;  // the latter of a line, else -1
  };
  std::vector<ProbeSeries> probes_;
  struct ContactSeries {
    int pose, position, gap, normal, normal_force, friction_force, state;
  };
  std::vector<ContactSeries> contacts_;  // empty without states
  std::array<int, 6> report_{};
};

}  // namespace sinew::record
