#include "sinew/high_rate/packet.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>

namespace sinew::high_rate {

namespace {

static_assert(std::endian::native == std::endian::little, "packets are little endian");

constexpr std::uint32_t kMagic = 0x52484E53;
constexpr std::uint16_t kVersion = 1;

template <typename Number>
void put(std::span<std::byte> bytes, std::size_t at, Number number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

template <typename Number>
Number get(std::span<const std::byte> bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

std::uint16_t count(const VectorX& numbers) { return static_cast<std::uint16_t>(numbers.size()); }

void put_header(const PacketHeader& header, std::span<std::byte> bytes) {
  put(bytes, 0, kMagic);
  put(bytes, 4, kVersion);
  put(bytes, 6, static_cast<std::uint16_t>(header.kind));
  put(bytes, 8, header.sequence);
  for (std::size_t k = 0; k < 3; ++k) put(bytes, 12 + 2 * k, header.counts[k]);
  put(bytes, 18, header.state);
  put(bytes, 20, std::uint32_t{0});
  put(bytes, 24, header.time);
}

std::size_t put_numbers(std::initializer_list<const VectorX*> lists, std::span<std::byte> bytes) {
  std::size_t at = kPacketHeader;
  for (const VectorX* list : lists) {
    for (const double number : *list) {
      put(bytes, at, number);
      at += sizeof number;
    }
  }
  return at;
}

PacketStatus get_header(std::span<const std::byte> bytes, PacketHeader::Kind kind,
                        PacketHeader& header) {
  if (bytes.size() < kPacketHeader) return PacketStatus::wrong_size;
  if (get<std::uint32_t>(bytes, 0) != kMagic) return PacketStatus::wrong_magic;
  if (get<std::uint16_t>(bytes, 4) != kVersion) return PacketStatus::wrong_version;
  if (get<std::uint16_t>(bytes, 6) != static_cast<std::uint16_t>(kind)) {
    return PacketStatus::wrong_kind;
  }
  header.kind = kind;
  header.sequence = get<std::uint32_t>(bytes, 8);
  for (std::size_t k = 0; k < 3; ++k) header.counts[k] = get<std::uint16_t>(bytes, 12 + 2 * k);
  header.state = get<std::uint16_t>(bytes, 18);
  header.time = get<double>(bytes, 24);
  return PacketStatus::good;
}

// Reads the numbers after the header into the lists; reads none of a bad packet.
PacketStatus get_numbers(std::span<const std::byte> bytes, std::initializer_list<VectorX*> lists) {
  std::size_t size = kPacketHeader;
  for (const VectorX* list : lists) size += sizeof(double) * static_cast<std::size_t>(list->size());
  if (bytes.size() != size) return PacketStatus::wrong_size;
  for (std::size_t at = kPacketHeader; at < size; at += sizeof(double)) {
    if (std::isinf(get<double>(bytes, at))) return PacketStatus::not_finite;
  }
  std::size_t at = kPacketHeader;
  for (VectorX* list : lists) {
    for (double& number : *list) {
      number = get<double>(bytes, at);
      at += sizeof number;
    }
  }
  return PacketStatus::good;
}

}  // namespace

std::size_t measurement_size(const HighRateSettings& settings) {
  return kPacketHeader + sizeof(double) * (settings.sensors.size() + settings.hands.size() +
                                           settings.driven.size());
}

std::size_t command_size(const HighRateSettings& settings) {
  return kPacketHeader + sizeof(double) * (2 * settings.driven.size() + settings.hands.size() +
                                           settings.unknown.size());
}

std::size_t write_measurement(PacketHeader header, const HighRateInput& input,
                              std::span<std::byte> bytes) {
  header.kind = PacketHeader::Kind::measurement;
  header.counts = {count(input.sensors), count(input.hands), count(input.driven)};
  put_header(header, bytes);
  return put_numbers({&input.sensors, &input.hands, &input.driven}, bytes);
}

std::size_t write_command(PacketHeader header, const HighRateOutput& output,
                          std::span<std::byte> bytes) {
  header.kind = PacketHeader::Kind::command;
  header.counts = {count(output.driven), count(output.hands), count(output.unknown)};
  header.state = static_cast<std::uint16_t>(output.state);
  put_header(header, bytes);
  return put_numbers({&output.driven, &output.driven_motion, &output.hands, &output.unknown},
                     bytes);
}

PacketStatus read_measurement(std::span<const std::byte> bytes, PacketHeader& header,
                              HighRateInput& input) {
  const PacketStatus status = get_header(bytes, PacketHeader::Kind::measurement, header);
  if (status != PacketStatus::good) return status;
  const bool efforts = header.counts[2] != 0;
  if (header.counts[0] != count(input.sensors) || header.counts[1] != count(input.hands) ||
      (efforts && header.counts[2] != count(input.driven))) {
    return PacketStatus::wrong_counts;
  }
  if (efforts) return get_numbers(bytes, {&input.sensors, &input.hands, &input.driven});
  const PacketStatus numbers = get_numbers(bytes, {&input.sensors, &input.hands});
  if (numbers == PacketStatus::good) input.driven.setConstant(std::nan(""));
  return numbers;
}

PacketStatus read_command(std::span<const std::byte> bytes, PacketHeader& header,
                          HighRateOutput& output) {
  const PacketStatus status = get_header(bytes, PacketHeader::Kind::command, header);
  if (status != PacketStatus::good) return status;
  if (header.counts[0] != count(output.driven) || header.counts[1] != count(output.hands) ||
      header.counts[2] != count(output.unknown) ||
      header.state > static_cast<std::uint16_t>(HighRateState::released)) {
    return PacketStatus::wrong_counts;
  }
  const PacketStatus numbers =
      get_numbers(bytes, {&output.driven, &output.driven_motion, &output.hands, &output.unknown});
  if (numbers == PacketStatus::good) output.state = static_cast<HighRateState>(header.state);
  return numbers;
}

}  // namespace sinew::high_rate
