/// @file
/// Series of numbers that grow by a frame at a time, in one HDF5 file that survives a crash.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::record {

/// Writes one HDF5 file. What was flushed stays readable when the program is killed: chunks never
/// move once written (no compression), and the library's metadata reach the file only by flush().
/// All methods throw Error(recording-failed) when the disk is full or gone.
class Hdf5Writer {
 public:
  /// Creates or replaces the file. Throws Error(file-unwritable).
  /// @param path of the file.
  explicit Hdf5Writer(const std::filesystem::path& path);
  ~Hdf5Writer();
  Hdf5Writer(Hdf5Writer&&) noexcept;
  Hdf5Writer& operator=(Hdf5Writer&&) noexcept;

  /// Attributes of an object that exists; "/" is the file itself.
  /// @param object path of a group or dataset. @param name,value of the attribute.
  void attribute(const std::string& object, const std::string& name, std::string_view value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, std::int64_t value);

  /// A group, with those above it.
  /// @param path from the root: "/actuators".
  void group(const std::string& path);

  /// A dataset that does not grow. Groups above it are made.
  /// @param path from the root. @param shape of the array. @param values row by row.
  void dataset(const std::string& path, const std::vector<std::uint64_t>& shape,
               std::span<const double> values);
  void dataset(const std::string& path, const std::vector<std::uint64_t>& shape,
               std::span<const std::int32_t> values);

  /// A dataset of one UTF-8 text of any length.
  /// @param path from the root. @param text its content.
  void text(const std::string& path, std::string_view text);

  /// A dataset (frames, shape...) of float64 that grows by append().
  /// @param path from the root. @param shape of one frame; empty for a number.
  /// @return its number.
  int series(const std::string& path, const std::vector<std::uint64_t>& shape);
  /// Adds a frame to a series. Small ones wait in memory for others, at most until flush().
  /// @param series its number. @param values row by row.
  void append(int series, std::span<const double> values);

  /// Hands everything to the operating system: readers see all frames so far.
  void flush();
  /// flush() if the last one is at least this long ago.
  /// @param interval least time between two.
  void flush_after(std::chrono::milliseconds interval);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace sinew::record
