/// @file
/// Writes series of numbers, frame by frame, to an HDF5 file that survives a crash.
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

/// Writes one HDF5 file. Flushed data stay readable if the program is killed: chunks never move
/// once written (no compression), and metadata of the library reach the file only in flush(). All
/// functions throw Error(recording-failed) if the disk is full or missing.
class Hdf5Writer {
 public:
  /// Creates or replaces the file. Throws what throw_unwritable() throws.
  /// @param path of the file.
  explicit Hdf5Writer(const std::filesystem::path& path);
  ~Hdf5Writer();
  Hdf5Writer(Hdf5Writer&&) noexcept;
  Hdf5Writer& operator=(Hdf5Writer&&) noexcept;

  /// Writes an attribute of an existing object; "/" is the file itself.
  /// @param object path of a group or dataset. @param name,value of the attribute.
  void attribute(const std::string& object, const std::string& name, std::string_view value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, std::int64_t value);

  /// Creates a group, with the groups above it.
  /// @param path from the root: "/actuators".
  void group(const std::string& path);

  /// Writes a dataset of fixed size, and creates the groups above it.
  /// @param path from the root. @param shape of the array. @param values row-major.
  void dataset(const std::string& path, const std::vector<std::uint64_t>& shape,
               std::span<const double> values);
  void dataset(const std::string& path, const std::vector<std::uint64_t>& shape,
               std::span<const std::int32_t> values);

  /// Writes a dataset of one UTF-8 text of any length.
  /// @param path from the root. @param text its content.
  void text(const std::string& path, std::string_view text);

  /// Creates a dataset (frames, shape...) of float64 that grows by append().
  /// @param path from the root. @param shape of one frame; empty for a scalar.
  /// @return the number of the series, for append().
  int series(const std::string& path, const std::vector<std::uint64_t>& shape);
  /// Appends a frame to a series. Small frames are collected in memory, at most until flush().
  /// @param series its number. @param values row-major.
  void append(int series, std::span<const double> values);

  /// Hands all data to the operating system, so that readers see all frames so far.
  void flush();
  /// Calls flush() if the last one was at least `interval` ago.
  /// @param interval minimum time between two flushes.
  void flush_after(std::chrono::milliseconds interval);

  /// Renames the file, which replaces another one. Throws what throw_unwritable() throws.
  /// @param path its new name, on the same disk.
  void rename(const std::filesystem::path& path);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace sinew::record
