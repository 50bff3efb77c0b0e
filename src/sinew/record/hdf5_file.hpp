/// @file
/// The little of HDF5 that recording needs: growing arrays of doubles, fixed arrays, attributes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sinew::record {

/// A file being written. Every array is chunked by frames and compressed; flush() makes what was
/// written so far readable even if the program is killed afterwards.
class Hdf5Writer {
 public:
  /// Creates or replaces the file. Throws Error(file-unwritable).
  explicit Hdf5Writer(const std::filesystem::path& path);
  ~Hdf5Writer();
  Hdf5Writer(Hdf5Writer&&) noexcept;
  Hdf5Writer& operator=(Hdf5Writer&&) noexcept;

  void text_attribute(const std::string& name, const std::string& value);
  void number_attribute(const std::string& name, double value);
  /// A whole array at once. @param path such as "/mesh/trunk/nodes"; groups are made.
  /// @param shape its dimensions. @param values row-major.
  void array(const std::string& path, const std::vector<std::size_t>& shape,
             std::span<const double> values);
  void array(const std::string& path, const std::vector<std::size_t>& shape,
             std::span<const std::int32_t> values);
  /// Declares an array that grows by frames. @param path,frame_shape its name, and the shape of
  /// one frame; {} for a number. @param unit stored as attribute `unit`. @return its number for append().
  int growing(const std::string& path, const std::vector<std::size_t>& frame_shape,
              const std::string& unit);
  /// Appends one frame. Throws Error(recording-failed).
  void append(int array, std::span<const double> frame);
  /// Throws Error(recording-failed).
  void flush();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// What is in a recorded run.
struct RunSummary {
  std::string version;  ///< of the program that wrote it
  std::string scene;    ///< YAML text
  std::size_t frames = 0;
  double first_time = 0.0, last_time = 0.0;  ///< s
  std::vector<std::string> bodies, actuators, effectors;
};

/// Reads the summary of a recorded run. Throws Error: file-not-found, malformed-file.
RunSummary read_run_summary(const std::filesystem::path& path);

}  // namespace sinew::record
