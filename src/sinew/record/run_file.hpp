/// @file
/// Reads a run.h5 that RunRecorder wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::record {

/// A recorded run, open for reading. Sizes are checked for consistency before anything is
/// allocated. If a run was interrupted, the file is read up to the last frame that all series have.
class RunFile {
 public:
  /// Throws Error: file-not-found, unknown-format (not an HDF5 file, or not of a run),
  /// unsupported-version, malformed-file.
  /// @param path of run.h5.
  explicit RunFile(const std::filesystem::path& path);
  ~RunFile();
  RunFile(RunFile&&) noexcept;
  RunFile& operator=(RunFile&&) noexcept;

  /// Whether the file starts with the HDF5 signature; false also if it cannot be read.
  /// @param path any file.
  static bool is_hdf5(const std::filesystem::path& path);

  std::int64_t format_version() const;  ///< kOldestRunFormatVersion to kRunFormatVersion
  /// Describes what a recording in an older format lacks: "recorded without commands, ...
  /// (format 2)"; empty for the current format.
  std::string lacks() const;
  const std::string& sinew_version() const;
  const std::string& scene_name() const;
  const std::string& scene() const;          ///< YAML, as resolved
  double time_step() const;                  ///< s
  std::int64_t frames() const;               ///< number of complete frames
  const std::vector<double>& times() const;  ///< (frames,) s
  const std::vector<std::string>& bodies() const;
  const std::vector<std::string>& actuators() const;
  const std::vector<std::string>& effectors() const;
  const std::vector<std::string>& probes() const;
  const std::vector<std::string>& contacts() const;  ///< whose points were recorded
  /// Whether positions of all nodes were recorded.
  bool has_states() const;

  /// Nodes and elements of a body's mesh at rest, without mesh checks. Throws Error(unknown-name),
  /// Error(malformed-file).
  /// @param body its name.
  mesh::Mesh rest_mesh(std::string_view body) const;
  /// Node positions (n, 3) m of a body in a frame. Throws Error: unknown-name, out-of-range,
  /// missing-key if states were not recorded, malformed-file.
  /// @param body its name. @param frame from 0.
  Points positions(std::string_view body, std::int64_t frame) const;
  /// A series (frames,) of an actuator. Throws Error: unknown-name, malformed-file, and missing-key
  /// for commands in an older format, which has none.
  /// @param actuator its name. @param what "effort", "motion", "effort_command", "motion_command"
  /// or "input_command", in the units of the actuator (docs/conventions.md).
  std::vector<double> actuator(std::string_view actuator, std::string_view what) const;
  /// Positions (frames, 3) of an effector, m, or rotation vectors of an orientation, rad. Throws
  /// Error: unknown-name, malformed-file.
  /// @param effector its name.
  Points effector(std::string_view effector) const;
  /// Values of a probe: (frames,) in m or rad, where that of a line is its length, or (frames 3,) m
  /// for a point. Throws Error: unknown-name, malformed-file.
  /// @param probe its name.
  std::vector<double> probe(std::string_view probe) const;
  /// Paths of all series, in the order of their names: "/actuators/long_0/effort".
  const std::vector<std::string>& datasets() const;
  /// Whether a dataset was recorded. @param dataset its path, see record::dataset_of().
  bool has(const std::string& dataset) const;
  /// All numbers (frames, shape...) of a dataset, frame by frame. Throws Error(malformed-file),
  /// also if there is no such dataset.
  /// @param dataset its path.
  std::vector<double> series(const std::string& dataset) const;
  /// Numbers (shape...) of a dataset in one frame. Throws what series() throws, and
  /// Error(out-of-range).
  /// @param dataset its path. @param frame from 0.
  std::vector<double> numbers(const std::string& dataset, std::int64_t frame) const;

 private:
  void require_frame(std::int64_t frame) const;
  void require_state(std::string_view body, std::int64_t frame) const;

  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sinew::record
