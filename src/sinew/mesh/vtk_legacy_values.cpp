#include "sinew/mesh/vtk_legacy_values.hpp"

#include <cctype>
#include <utility>

#include <fmt/format.h>

namespace sinew::mesh {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::optional<ScalarType> legacy_scalar_type(std::string_view word) {
  static constexpr std::pair<std::string_view, ScalarType> kNames[] = {
      {"bit", ScalarType::bit},
      {"char", ScalarType::int8},
      {"signed_char", ScalarType::int8},
      {"unsigned_char", ScalarType::uint8},
      {"short", ScalarType::int16},
      {"unsigned_short", ScalarType::uint16},
      {"int", ScalarType::int32},
      {"unsigned_int", ScalarType::uint32},
      {"vtkidtype", ScalarType::int32},  // legacy files store it in 32 bits
      {"long", ScalarType::int64},
      {"unsigned_long", ScalarType::uint64},
      {"vtktypeint8", ScalarType::int8},
      {"vtktypeuint8", ScalarType::uint8},
      {"vtktypeint16", ScalarType::int16},
      {"vtktypeuint16", ScalarType::uint16},
      {"vtktypeint32", ScalarType::int32},
      {"vtktypeuint32", ScalarType::uint32},
      {"vtktypefloat32", ScalarType::float32},
      {"vtktypefloat64", ScalarType::float64},
      {"vtktypeint64", ScalarType::int64},
      {"vtktypeuint64", ScalarType::uint64},
      {"float", ScalarType::float32},
      {"double", ScalarType::float64},
  };
  const std::string wanted = lower_case(word);
  for (const auto& [name, type] : kNames) {
    if (name == wanted) return type;
  }
  return std::nullopt;
}

void LegacyValues::set_binary() {
  binary_ = true;
  in_.mark_binary();
}

std::size_t LegacyValues::block_size(std::size_t count, ScalarType type) const {
  return type == ScalarType::bit ? (count + 7) / 8 : count * bytes_of(type);
}

void LegacyValues::skip(std::size_t count, ScalarType type) {
  if (binary_) {
    in_.block(block_size(count, type), "values");
    return;
  }
  for (std::size_t i = 0; i < count; ++i) in_.number("a value");
}

void LegacyValues::skip_strings(std::int64_t components, std::int64_t tuples) {
  const std::size_t width = in_.checked_count(components, 1, "components");
  const std::size_t count = in_.checked_count(tuples, width, "tuples");
  in_.line();
  for (std::size_t i = 0; i < count * width; ++i) in_.line();
}

std::vector<double> LegacyValues::doubles(std::size_t count, ScalarType type,
                                          std::string_view what) {
  if (binary_) {
    return decode_doubles(in_.block(block_size(count, type), what), type, ByteOrder::big);
  }
  std::vector<double> values(count);
  for (double& value : values) value = in_.number("a coordinate");
  return values;
}

std::vector<std::int64_t> LegacyValues::integers(std::size_t count, ScalarType type,
                                                 std::string_view what) {
  if (!is_integer(type)) {
    in_.fail(ErrorKind::malformed_file, fmt::format("{} must be of an integer type", what));
  }
  if (binary_) {
    auto values = decode_integers(in_.block(block_size(count, type), what), type, ByteOrder::big);
    values.resize(count);
    return values;
  }
  std::vector<std::int64_t> values(count);
  for (auto& value : values) value = in_.integer("an integer");
  return values;
}

ScalarType LegacyValues::scalar(std::string_view what) {
  const std::string_view word = in_.word(what);
  const std::optional<ScalarType> type = legacy_scalar_type(word);
  if (!type) {
    in_.fail(ErrorKind::malformed_file,
             fmt::format("{} is the unknown `{}`", what, word.substr(0, 40)));
  }
  return *type;
}

void LegacyValues::end_of_header() {
  if (binary_) in_.line();
}

}  // namespace sinew::mesh
