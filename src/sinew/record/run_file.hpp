/// @file
/// Reads back what RunRecorder wrote into run.h5.
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

/// A recorded run, open for reading. Sizes are checked against each other before anything is
/// allocated. A file whose run was cut off is read as far as all of its series go.
class RunFile {
 public:
  /// Throws Error: file-not-found, unknown-format (no HDF5 file, or not of a run),
  /// unsupported-version, malformed-file.
  /// @param path of run.h5.
  explicit RunFile(const std::filesystem::path& path);
  ~RunFile();
  RunFile(RunFile&&) noexcept;
  RunFile& operator=(RunFile&&) noexcept;

  /// Whether the file starts as HDF5 files do; false also when it cannot be read.
  /// @param path any file.
  static bool is_hdf5(const std::filesystem::path& path);

  std::int64_t format_version() const;  ///< kOldestRunFormatVersion to kRunFormatVersion
  /// What a recording of an older format has not: "recorded without commands, ... (format 2)";
  /// empty for the present format.
  std::string lacks() const;
  const std::string& sinew_version() const;
  const std::string& scene_name() const;
  const std::string& scene() const;          ///< YAML, as resolved
  double time_step() const;                  ///< s
  std::int64_t frames() const;               ///< complete ones
  const std::vector<double>& times() const;  ///< (frames,) s
  const std::vector<std::string>& bodies() const;
  const std::vector<std::string>& actuators() const;
  const std::vector<std::string>& effectors() const;
  const std::vector<std::string>& probes() const;
  const std::vector<std::string>& contacts() const;  ///< whose points were recorded
  /// Whether positions of all nodes were recorded.
  bool has_states() const;

  /// The mesh of a body at rest, unchecked: nodes and elements. Throws Error(unknown-name),
  /// Error(malformed-file).
  /// @param body its name.
  mesh::Mesh rest_mesh(std::string_view body) const;
  /// Positions (n, 3) m of a body's nodes in a frame. Throws Error: unknown-name, out-of-range,
  /// missing-key when states were not recorded, malformed-file.
  /// @param body its name. @param frame from 0.
  Points positions(std::string_view body, std::int64_t frame) const;
  /// (frames,) of "long_0/effort" and its like. Throws as positions(), and Error(missing-key) for
  /// commands of a recording that lacks them.
  /// @param actuator its name. @param what "effort" (N), "motion" (m), "effort_command",
  ///   "motion_command" or "input_command".
  std::vector<double> actuator(std::string_view actuator, std::string_view what) const;
  /// (frames, 3) m, or rad for orientations; throws as positions().
  /// @param effector its name.
  Points effector(std::string_view effector) const;
  /// (frames,) m or rad, (frames 3,) m of a point, of a line its length; throws as positions().
  /// @param probe its name.
  std::vector<double> probe(std::string_view probe) const;
  /// Paths of all series, in the order of their names: "/actuators/long_0/effort".
  const std::vector<std::string>& datasets() const;
  /// Whether a dataset was recorded. @param dataset its path, see record::dataset_of().
  bool has(const std::string& dataset) const;
  /// (frames, shape...) numbers of a dataset, one frame after the other. Throws Error:
  /// malformed-file, also when there is none.
  /// @param dataset its path.
  std::vector<double> series(const std::string& dataset) const;
  /// (shape...) numbers of one frame; throws as series(), and Error(out-of-range).
  /// @param dataset its path. @param frame from 0.
  std::vector<double> numbers(const std::string& dataset, std::int64_t frame) const;

 private:
  void require_frame(std::int64_t frame) const;
  void require_state(std::string_view body, std::int64_t frame) const;

  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sinew::record
