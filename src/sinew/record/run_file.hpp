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
#include "sinew/sim/contact_state.hpp"

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
  /// Coordinates (n,) rad, extensions in m, of a constant-curvature arm; empty of other bodies.
  /// Throws as positions().
  /// @param body its name. @param frame from 0.
  VectorX coordinates(std::string_view body, std::int64_t frame) const;
  /// (frames,) of "long_0/effort" or "long_0/motion"; throws as positions().
  /// @param actuator its name. @param what "effort" (N) or "motion" (m).
  std::vector<double> actuator(std::string_view actuator, std::string_view what) const;
  /// (frames, 3) m, or rad for orientations; throws as positions().
  /// @param effector its name.
  Points effector(std::string_view effector) const;
  /// (frames,) m or rad, (frames 3,) m of a point, of a line its length; throws as positions().
  /// @param probe its name.
  std::vector<double> probe(std::string_view probe) const;
  /// The points of a contact and the pose of its surface in a frame; throws as positions().
  /// @param contact its name. @param frame from 0.
  sim::ContactMoment contact(std::string_view contact, std::int64_t frame) const;

 private:
  void require_frame(std::int64_t frame) const;
  void require_state(std::string_view body, std::int64_t frame) const;

  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace sinew::record
