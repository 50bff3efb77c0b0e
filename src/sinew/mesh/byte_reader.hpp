/// @file
/// A defensive cursor over the bytes of a file: words and numbers of text, and binary blocks. Every
/// size is checked against the remaining bytes before memory is allocated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"

namespace sinew::mesh {

/// The number types that mesh files store.
enum class ScalarType {
  bit,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Byte order of numbers.
enum class ByteOrder { little, big };

/// Size of one stored number in bytes; 1 for `bit`, which is packed and handled separately.
std::size_t bytes_of(ScalarType type);

/// False for the floating-point types.
bool is_integer(ScalarType type);

/// Decodes the numbers of a binary block; an incomplete number at the end is ignored.
std::vector<double> decode_doubles(std::string_view block, ScalarType type, ByteOrder order);

/// Decodes integers. Numbers that are not integers or do not fit 64 signed bits become -1; range
/// checks reject them, since no size, index or tag is negative.
std::vector<std::int64_t> decode_integers(std::string_view block, ScalarType type, ByteOrder order);

/// Reads forward through bytes, which the caller keeps alive.
class ByteReader {
 public:
  /// @param bytes the whole file.
  /// @param name name of the file, for messages.
  /// @param first_line line number in the file at which `bytes` start.
  ByteReader(std::string_view bytes, std::string name, int first_line = 1);

  const std::string& name() const { return name_; }
  std::size_t offset() const { return offset_; }
  std::size_t remaining() const { return bytes_.size() - offset_; }

  /// Skips white space; returns whether nothing follows.
  bool at_end();

  /// The rest of the current line, without its end; moves to the next line.
  std::string_view line();

  /// The next word (bytes between white space), without moving the cursor; empty at the end of the
  /// file.
  std::string_view peek_word() const;

  /// The next word. Throws Error(truncated-file) at the end of the file.
  /// @param what the expected item, for the message: "the number of points".
  std::string_view word(std::string_view what);

  /// The next word as an integer. Throws Error(malformed-file, truncated-file).
  /// @param what as for word().
  std::int64_t integer(std::string_view what);

  /// The next word as a number; `nan` and `inf` are accepted, and reported by the mesh checks.
  /// @param what as for word().
  double number(std::string_view what);

  /// The next `size` bytes. Throws Error(truncated-file).
  /// @param size number of bytes.
  /// @param what as for word().
  std::string_view block(std::size_t size, std::string_view what);

  /// Checks a count from the file: not negative, at most 2^31 - 1, and `bytes_each` bytes per item
  /// are left in the file. Throws Error(malformed-file, size-limit, truncated-file).
  /// @param count the number as read.
  /// @param bytes_each minimum size of one item in the file.
  /// @param what the counted items, such as "points".
  std::size_t checked_count(std::int64_t count, std::size_t bytes_each, std::string_view what);

  /// Moves past the next occurrence of `text`. Returns false, without moving, if there is none.
  bool skip_past(std::string_view text);

  /// From here on, messages give byte offsets instead of lines.
  void mark_binary() { binary_ = true; }

  /// Position of the cursor: file and line, or file and byte.
  Location place() const;

  /// Throws an Error of this kind at the current position.
  /// @param kind kind of error.
  /// @param message what is wrong.
  /// @param remedy what to do.
  [[noreturn]] void fail(
      ErrorKind kind, const std::string& message,
      const std::string& remedy = "write the file again from the program that made it") const;

 private:
  std::string_view bytes_;
  std::string name_;
  std::size_t offset_ = 0;
  int first_line_ = 1;
  bool binary_ = false;
};

}  // namespace sinew::mesh
