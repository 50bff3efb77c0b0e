#include "sinew/mesh/byte_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/whole.hpp"

namespace sinew::mesh {

namespace {

bool is_space(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\v' || c == '\f';
}

/// A word as shown in messages: shortened and printable.
std::string shown(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text(word.substr(0, kLongest));
  for (char& c : text) {
    if (c < 32 || c > 126) c = '?';
  }
  return word.size() > kLongest ? text + "..." : text;
}

template <typename Stored>
Stored load(const char* bytes, bool swap) {
  std::array<char, sizeof(Stored)> buffer;
  std::memcpy(buffer.data(), bytes, sizeof(Stored));
  if (swap) std::reverse(buffer.begin(), buffer.end());
  return std::bit_cast<Stored>(buffer);
}

template <typename Wanted, typename Stored>
Wanted converted(Stored value) {
  if constexpr (std::is_integral_v<Wanted>) {
    if constexpr (std::is_floating_point_v<Stored>) {
      const auto given = static_cast<double>(value);
      const Wanted result = whole<Wanted>(given);
      return static_cast<double>(result) == given ? result : Wanted(-1);
    } else if (std::cmp_greater(value, std::numeric_limits<Wanted>::max())) {
      return Wanted(-1);
    }
  }
  return static_cast<Wanted>(value);
}

template <typename Wanted, typename Stored>
std::vector<Wanted> decode_as(std::string_view block, bool swap) {
  std::vector<Wanted> values(block.size() / sizeof(Stored));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = converted<Wanted>(load<Stored>(block.data() + i * sizeof(Stored), swap));
  }
  return values;
}

template <typename Wanted>
std::vector<Wanted> decode_bits(std::string_view block) {
  std::vector<Wanted> values(block.size() * 8);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<Wanted>((static_cast<unsigned char>(block[i / 8]) >> (7 - i % 8)) & 1);
  }
  return values;
}

template <typename Wanted>
std::vector<Wanted> decode(std::string_view block, ScalarType type, ByteOrder order) {
  const bool swap = (order == ByteOrder::big) != (std::endian::native == std::endian::big);
  switch (type) {
    case ScalarType::bit:
      return decode_bits<Wanted>(block);
    case ScalarType::int8:
      return decode_as<Wanted, std::int8_t>(block, swap);
    case ScalarType::uint8:
      return decode_as<Wanted, std::uint8_t>(block, swap);
    case ScalarType::int16:
      return decode_as<Wanted, std::int16_t>(block, swap);
    case ScalarType::uint16:
      return decode_as<Wanted, std::uint16_t>(block, swap);
    case ScalarType::int32:
      return decode_as<Wanted, std::int32_t>(block, swap);
    case ScalarType::uint32:
      return decode_as<Wanted, std::uint32_t>(block, swap);
    case ScalarType::int64:
      return decode_as<Wanted, std::int64_t>(block, swap);
    case ScalarType::uint64:
      return decode_as<Wanted, std::uint64_t>(block, swap);
    case ScalarType::float32:
      return decode_as<Wanted, float>(block, swap);
    case ScalarType::float64:
      return decode_as<Wanted, double>(block, swap);
  }
  return {};
}

}  // namespace

std::size_t bytes_of(ScalarType type) {
  switch (type) {
    case ScalarType::bit:
    case ScalarType::int8:
    case ScalarType::uint8:
      return 1;
    case ScalarType::int16:
    case ScalarType::uint16:
      return 2;
    case ScalarType::int32:
    case ScalarType::uint32:
    case ScalarType::float32:
      return 4;
    default:
      return 8;
  }
}

bool is_integer(ScalarType type) {
  return type != ScalarType::float32 && type != ScalarType::float64;
}

std::vector<double> decode_doubles(std::string_view block, ScalarType type, ByteOrder order) {
  return decode<double>(block, type, order);
}

std::vector<std::int64_t> decode_integers(std::string_view block, ScalarType type,
                                          ByteOrder order) {
  return decode<std::int64_t>(block, type, order);
}

ByteReader::ByteReader(std::string_view bytes, std::string name, int first_line)
    : bytes_(bytes), name_(std::move(name)), first_line_(first_line) {}

bool ByteReader::skip_past(std::string_view text) {
  const std::size_t found = bytes_.find(text, offset_);
  if (found == std::string_view::npos) return false;
  offset_ = found + text.size();
  return true;
}

bool ByteReader::at_end() {
  while (offset_ < bytes_.size() && is_space(bytes_[offset_])) ++offset_;
  return offset_ == bytes_.size();
}

std::string_view ByteReader::line() {
  const std::size_t end = std::min(bytes_.find('\n', offset_), bytes_.size());
  std::string_view text = bytes_.substr(offset_, end - offset_);
  offset_ = std::min(end + 1, bytes_.size());
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

std::string_view ByteReader::peek_word() const {
  std::size_t begin = offset_;
  while (begin < bytes_.size() && is_space(bytes_[begin])) ++begin;
  std::size_t end = begin;
  while (end < bytes_.size() && !is_space(bytes_[end])) ++end;
  return bytes_.substr(begin, end - begin);
}

std::string_view ByteReader::word(std::string_view what) {
  const std::string_view text = peek_word();
  if (text.empty()) {
    fail(ErrorKind::truncated_file, fmt::format("the file ends where {} should stand", what),
         "write the file again; it was probably cut short");
  }
  offset_ = static_cast<std::size_t>(text.data() - bytes_.data()) + text.size();
  return text;
}

std::int64_t ByteReader::integer(std::string_view what) {
  const std::string_view text = word(what);
  std::int64_t value = 0;
  const char* begin = text.data() + (text.front() == '+' ? 1 : 0);
  const auto [end, problem] = std::from_chars(begin, text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size()) {
    fail(ErrorKind::malformed_file,
         fmt::format("expected {} (an integer), got `{}`", what, shown(text)));
  }
  return value;
}

double ByteReader::number(std::string_view what) {
  const std::string_view text = word(what);
  double value = 0.0;
  const char* begin = text.data() + (text.front() == '+' ? 1 : 0);
  const auto [end, problem] = std::from_chars(begin, text.data() + text.size(), value);
  const bool whole = end == text.data() + text.size();
  if (problem == std::errc::result_out_of_range && whole) {
    return std::strtod(std::string(text).c_str(), nullptr);  // 0 or infinity
  }
  if (problem != std::errc{} || !whole) {
    fail(ErrorKind::malformed_file,
         fmt::format("expected {} (a number), got `{}`", what, shown(text)));
  }
  return value;
}

std::string_view ByteReader::block(std::size_t size, std::string_view what) {
  if (size > remaining()) {
    fail(ErrorKind::truncated_file,
         fmt::format("{} need {} bytes, but the file has only {} left", what, size, remaining()),
         "write the file again; it was probably cut short");
  }
  const std::string_view bytes = bytes_.substr(offset_, size);
  offset_ += size;
  return bytes;
}

std::size_t ByteReader::checked_count(std::int64_t count, std::size_t bytes_each,
                                      std::string_view what) {
  if (count < 0) fail(ErrorKind::malformed_file, fmt::format("{} {} make no sense", count, what));
  if (count > std::numeric_limits<std::int32_t>::max()) {
    fail(ErrorKind::size_limit,
         fmt::format("{} {} are more than 2^31 - 1, the most that can be numbered", count, what));
  }
  const auto wanted = static_cast<std::size_t>(count);
  // The last item of a text file needs no space after it, so one byte less is accepted.
  if (bytes_each > 0 && wanted > (remaining() + 1) / bytes_each) {
    fail(ErrorKind::truncated_file,
         fmt::format("{} {} need at least {} bytes each, but the file has only {} bytes left",
                     count, what, bytes_each, remaining()),
         "write the file again; it was probably cut short, or the number is wrong");
  }
  return wanted;
}

Location ByteReader::place() const {
  if (binary_) return {.file = name_, .item = fmt::format("byte {}", offset_)};
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(offset_);
  return {.file = name_,
          .line = first_line_ + static_cast<int>(std::count(bytes_.begin(), end, '\n'))};
}

void ByteReader::fail(ErrorKind kind, const std::string& message, const std::string& remedy) const {
  throw Error(kind, place(), message, remedy);
}

}  // namespace sinew::mesh
