/// @file
/// Reading numbers of VTK legacy files, text or big-endian binary.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/mesh/byte_reader.hpp"

namespace sinew::mesh {

/// The text in lower case (keywords of VTK may be in either).
std::string lower_case(std::string_view text);

/// The number type with the name `word` in VTK legacy files; nothing if there is none.
std::optional<ScalarType> legacy_scalar_type(std::string_view word);

/// Reads the arrays of a legacy file in its encoding. `what` is the name of the data in messages.
class LegacyValues {
 public:
  /// @param bytes the whole file; the caller keeps it alive.
  /// @param name its name, for messages.
  LegacyValues(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  /// From here on, arrays are binary.
  void set_binary();

  /// Minimum size of one number in bytes; in text, a digit and a space.
  std::size_t item_size(ScalarType type) const { return binary_ ? bytes_of(type) : 2; }

  /// Ends a header: binary values start right after the line end, text may continue in the same
  /// line.
  void end_of_header();

  /// Reads the name of a number type. Throws Error(malformed-file).
  ScalarType scalar(std::string_view what);

  /// Reads `count` numbers; the caller has checked the count. Throws Error(truncated-file,
  /// malformed-file).
  std::vector<double> doubles(std::size_t count, ScalarType type, std::string_view what);

  /// Reads `count` integers, like doubles(). Throws Error(malformed-file) for a floating-point
  /// type.
  std::vector<std::int64_t> integers(std::size_t count, ScalarType type, std::string_view what);

  /// Skips `count` numbers.
  void skip(std::size_t count, ScalarType type);

  /// Skips an array of strings in a text file, one per line.
  void skip_strings(std::int64_t components, std::int64_t tuples);

 protected:
  ByteReader in_;
  bool binary_ = false;

 private:
  std::size_t block_size(std::size_t count, ScalarType type) const;
};

}  // namespace sinew::mesh
