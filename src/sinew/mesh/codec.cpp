#include "sinew/mesh/codec.hpp"

#include <array>
#include <cstdint>

#include <zlib.h>

namespace sinew::mesh {

namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<int, 256> make_values() {
  std::array<int, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int>(i);
  }
  return values;
}
constexpr std::array<int, 256> kValues = make_values();

char byte_of(std::uint32_t bits) { return static_cast<char>(bits & 0xff); }

}  // namespace

std::optional<std::string> decode_base64(std::string_view text, std::size_t max_bytes) {
  std::string bytes;
  std::uint32_t quad = 0;
  int characters = 0, padding = 0;
  for (const char c : text) {
    if (bytes.size() >= max_bytes) break;
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const int value = c == '=' ? 0 : kValues[static_cast<unsigned char>(c)];
    if (value < 0 || (padding > 0 && c != '=')) return std::nullopt;
    padding += c == '=' ? 1 : 0;
    quad = (quad << 6) | static_cast<std::uint32_t>(value);
    if (++characters < 4) continue;
    if (padding > 2) return std::nullopt;
    bytes += byte_of(quad >> 16);
    if (padding < 2) bytes += byte_of(quad >> 8);
    if (padding < 1) bytes += byte_of(quad);
    quad = 0;
    characters = padding = 0;
  }
  if (characters != 0) return std::nullopt;
  if (bytes.size() > max_bytes) bytes.resize(max_bytes);
  return bytes;
}

std::string encode_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t triple = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t byte =
          i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
      triple = (triple << 8) | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kAlphabet[(triple >> (18 - 6 * k)) & 63];
    }
  }
  return text;
}

std::optional<std::string> inflate(std::string_view packed, std::size_t size) {
  constexpr std::size_t kBestRatio = 1032;
  if (size / kBestRatio > packed.size()) return std::nullopt;
  std::string bytes(size, '\0');
  auto length = static_cast<uLongf>(size);
  const int status =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (status != Z_OK || length != size) return std::nullopt;
  return bytes;
}

std::string deflate(std::string_view bytes) {
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(length, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &length,
           reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  packed.resize(length);
  return packed;
}

}  // namespace sinew::mesh
