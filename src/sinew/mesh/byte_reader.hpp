/// @file
/// A careful cursor over the bytes of a file: words and numbers of text, blocks of binary. Every
/// size is checked against what is left before anything is allocated.
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

/// Which byte of a number comes first.
enum class ByteOrder { little, big };

/// Bytes of one stored number; 1 for `bit`, which is packed and treated apart.
std::size_t bytes_of(ScalarType type);

/// False for the floating-point types.
bool is_integer(ScalarType type);

/// Numbers from a binary block; trailing bytes that make no whole number are left out.
std::vector<double> decode_doubles(std::string_view block, ScalarType type, ByteOrder order);

/// As decode_doubles; numbers that do not fit 64 signed bits or are not integers become -1 (no
/// size, index or tag is negative, so that range checks catch them).
std::vector<std::int64_t> decode_integers(std::string_view block, ScalarType type, ByteOrder order);

/// Reads forward through bytes held by the caller, who keeps them alive.
class ByteReader {
 public:
  /// @param bytes the whole file.
  /// @param name the file's name, for messages.
  /// @param first_line number of the line where `bytes` start in the file.
  ByteReader(std::string_view bytes, std::string name, int first_line = 1);

  const std::string& name() const { return name_; }
  std::size_t offset() const { return offset_; }
  std::size_t remaining() const { return bytes_.size() - offset_; }

  /// Skips white space; true when nothing follows.
  bool at_end();

  /// The rest of the present line, without its end; the cursor goes to the next line.
  std::string_view line();

  /// The next word (bytes between white space) without moving; empty at the end of the file.
  std::string_view peek_word() const;

  /// The next word. Throws Error(truncated-file) at the end of the file.
  /// @param what what stands here, for the message: "the number of points".
  std::string_view word(std::string_view what);

  /// The next word as an integer. Throws Error(malformed-file, truncated-file).
  /// @param what as for word().
  std::int64_t integer(std::string_view what);

  /// The next word as a number; `nan` and `inf` are read, for the mesh checks to name them.
  /// @param what as for word().
  double number(std::string_view what);

  /// The next `size` bytes. Throws Error(truncated-file).
  /// @param size number of bytes.
  /// @param what as for word().
  std::string_view block(std::size_t size, std::string_view what);

  /// A count that the file gives, checked: not negative, at most 2^31 - 1, and `bytes_each` bytes
  /// of each are left in the file. Throws Error(malformed-file, size-limit, truncated-file).
  /// @param count the number as read.
  /// @param bytes_each least size of one item in the file.
  /// @param what what is counted: "points".
  std::size_t checked_count(std::int64_t count, std::size_t bytes_each, std::string_view what);

  /// Moves past the next occurrence of `text`; false, without moving, when there is none.
  bool skip_past(std::string_view text);

  /// From here on messages give byte offsets instead of lines.
  void mark_binary() { binary_ = true; }

  /// Where the cursor stands: file and line, or file and byte.
  Location place() const;

  /// Throws Error of this kind at the present place.
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
