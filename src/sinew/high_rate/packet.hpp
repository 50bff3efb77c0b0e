/// @file
/// Packets between a high-rate loop and a device, version 1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sinew/high_rate/high_rate_step.hpp"

namespace sinew::high_rate {

/// Header of a packet. One packet is one datagram. All fields are little endian; numbers are IEEE
/// 754 doubles in SI units. The first 32 bytes:
///
/// | byte | type | what |
/// |---|---|---|
/// | 0 | u32 | 0x52484E53, the letters "SNHR" |
/// | 4 | u16 | version, 1 |
/// | 6 | u16 | 1: measurement, to the loop; 2: command, to the device |
/// | 8 | u32 | sequence number, increasing from packet to packet of a sender; it may wrap |
/// | 12 | 3 x u16 | counts, see below |
/// | 18 | u16 | command: HighRateState from 0 (waiting) to 4 (released); measurement: 0 |
/// | 20 | u32 | 0 |
/// | 24 | f64 | s, on the sender's clock; for information only |
///
/// Measurement: the counts are those of sensors, hands, driven (0: efforts are not measured). Then
/// come the numbers of HighRateInput::sensors, hands and driven. NaN: not measured.
///
/// Command: the counts are those of driven, hands, unknown. Then come HighRateOutput::driven,
/// driven_motion, hands (which feel the opposite) and unknown.
struct PacketHeader {
  enum class Kind : std::uint16_t { measurement = 1, command = 2 };
  Kind kind = Kind::measurement;
  std::uint32_t sequence = 0;
  std::array<std::uint16_t, 3> counts{};
  std::uint16_t state = 0;
  double time = 0.0;  ///< s
};

inline constexpr std::size_t kPacketHeader = 32;  ///< bytes
/// Bytes of the largest packet, which fits into one Ethernet frame.
inline constexpr std::size_t kLargestPacket = 1400;

/// Result of reading a packet.
enum class PacketStatus {
  good,
  wrong_size,     ///< does not match its counts, or has no header
  wrong_magic,    ///< of another protocol
  wrong_version,  ///< of another version
  wrong_kind,     ///< not of the expected kind
  wrong_counts,   ///< of another device, or an unknown state
  not_finite,     ///< a number is infinite
};

/// Bytes of a measurement with all numbers.
std::size_t measurement_size(const HighRateSettings& settings);
/// Bytes of a command.
std::size_t command_size(const HighRateSettings& settings);

/// Writes a measurement. @param header its kind and counts are set here. @param input the numbers.
/// @param bytes at least as many as the packet has. @return bytes of the packet.
std::size_t write_measurement(PacketHeader header, const HighRateInput& input,
                              std::span<std::byte> bytes);
/// Writes a command. @param header its kind, counts and state are set here.
/// @param output the numbers. @param bytes at least as many as the packet has.
/// @return bytes of the packet.
std::size_t write_command(PacketHeader header, const HighRateOutput& output,
                          std::span<std::byte> bytes);

/// Reads a measurement. @param bytes a whole datagram. @param header gets the header.
/// @param input of the loop's sizes; gets the numbers of a good packet, otherwise is unchanged.
PacketStatus read_measurement(std::span<const std::byte> bytes, PacketHeader& header,
                              HighRateInput& input);
/// Reads a command. @param bytes a whole datagram. @param header gets the header.
/// @param output of the loop's sizes; gets the numbers and the state of a good packet, otherwise is
///   unchanged.
PacketStatus read_command(std::span<const std::byte> bytes, PacketHeader& header,
                          HighRateOutput& output);

}  // namespace sinew::high_rate
