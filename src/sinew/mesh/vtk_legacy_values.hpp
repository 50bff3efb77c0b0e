/// @file
/// Numbers of VTK legacy files, text or big-endian binary.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/mesh/byte_reader.hpp"

namespace sinew::mesh {

/// The text in lower case (VTK's keywords may be in either).
std::string lower_case(std::string_view text);

/// The type that a VTK legacy file calls `word`; nothing when there is none.
std::optional<ScalarType> legacy_scalar_type(std::string_view word);

/// Reads the arrays of a legacy file in its encoding. `what` names what is read, for messages.
class LegacyValues {
 public:
  /// @param bytes the whole file; the caller keeps it.
  /// @param name its name, for messages.
  LegacyValues(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  /// Arrays are binary from here on.
  void set_binary();

  /// Least bytes of one number: a digit and a space in text.
  std::size_t item_size(ScalarType type) const { return binary_ ? bytes_of(type) : 2; }

  /// Binary values start right after the line end; words may go on in the same line.
  void end_of_header();

  /// The type named by the next word. Throws Error(malformed-file).
  ScalarType scalar(std::string_view what);

  /// The next `count` numbers; the caller has checked the count. Throws Error(truncated-file,
  /// malformed-file).
  std::vector<double> doubles(std::size_t count, ScalarType type, std::string_view what);

  /// As doubles(), for integers. Throws Error(malformed-file) for a floating-point type.
  std::vector<std::int64_t> integers(std::size_t count, ScalarType type, std::string_view what);

  /// Passes over `count` numbers.
  void skip(std::size_t count, ScalarType type);

  /// Passes over an array of strings in a text file, one a line.
  void skip_strings(std::int64_t components, std::int64_t tuples);

 protected:
  ByteReader in_;
  bool binary_ = false;

 private:
  std::size_t block_size(std::size_t count, ScalarType type) const;
};

}  // namespace sinew::mesh
