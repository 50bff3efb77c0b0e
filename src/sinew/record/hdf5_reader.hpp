/// @file
/// Reads arrays from an HDF5 file that may be damaged. Types and sizes are checked first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sinew/record/hdf5_handle.hpp"

namespace sinew::record {

/// The remedies in errors about a file that cannot be read.
struct Hdf5Remedies {
  std::string unknown = "give a run.h5 that 'sinew run' wrote, and that no run is writing now";
  std::string malformed = "record the run again; the file is damaged or not of a run";
};

/// An HDF5 file open for reading. Functions throw Error(malformed-file) unless stated otherwise.
class Hdf5Reader {
 public:
  using Shape = std::vector<std::uint64_t>;

  /// Throws Error: file-not-found, unknown-format.
  /// @param path of the file. @param remedies for errors.
  explicit Hdf5Reader(const std::filesystem::path& path, Hdf5Remedies remedies = {});

  const std::string& path() const { return path_; }
  bool has(const std::string& object) const;
  /// Names of the objects in a group; empty if there is no such group. @param group its path.
  std::vector<std::string> names(const std::string& group) const;

  /// Paths of all numeric datasets below a group, in the order of their names.
  /// @param group its path; "/" is the root.
  std::vector<std::string> datasets(const std::string& group) const;

  /// Attributes of the file. If a text attribute is missing, the result is empty.
  /// @param name of the attribute.
  std::string text_attribute(const std::string& name) const;
  std::int64_t integer_attribute(const std::string& name) const;
  double number_attribute(const std::string& name) const;

  /// The extent of a dataset. @param dataset its path.
  Shape shape(const std::string& dataset) const;
  /// The content of a text dataset. @param dataset its path.
  std::string text(const std::string& dataset) const;
  /// The whole dataset, row-major. @param dataset its path. @param expected its extent.
  std::vector<double> numbers(const std::string& dataset, const Shape& expected) const;
  std::vector<std::int32_t> integers(const std::string& dataset, const Shape& expected) const;
  /// `count` rows (indices of the first dimension) of a dataset, from `begin` on.
  /// @param dataset its path. @param begin,count rows, within the extent.
  std::vector<double> rows(const std::string& dataset, std::uint64_t begin,
                           std::uint64_t count) const;
  /// Throws Error(malformed-file). @param what is wrong with the file.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  Hdf5Handle open(const std::string& dataset) const;
  void read_attribute(const std::string& name, hid_t type, H5T_class_t kind, void* value) const;
  std::uint64_t volume(const std::string& dataset, const Shape& shape) const;

  std::string path_;
  Hdf5Remedies remedies_;
  Hdf5Handle file_;
};

}  // namespace sinew::record
