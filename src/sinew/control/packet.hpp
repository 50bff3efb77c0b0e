/// @file
/// What a high-rate loop and a device send each other: version 1 of the packets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "sinew/control/high_rate_step.hpp"

namespace sinew::control {

/// One packet is one datagram. Everything is little endian; numbers are IEEE 754 doubles in SI
/// units. The first 32 bytes:
///
/// | byte | type | what |
/// |---|---|---|
/// | 0 | u32 | 0x52484E53, the letters "SNHR" |
/// | 4 | u16 | version, 1 |
/// | 6 | u16 | 1: measurement, to the loop; 2: command, to the device |
/// | 8 | u32 | sequence: grows from packet to packet of a sender, and may wrap |
/// | 12 | 3 x u16 | counts, below |
/// | 18 | u16 | of a command: state, HighRateState from 0 (waiting) to 4 (released); else 0 |
/// | 20 | u32 | 0 |
/// | 24 | f64 | s, on the sender's clock; of information only |
///
/// Measurement: counts sensors, hands, driven (0: efforts are not measured); then the numbers of
/// HighRateInput::sensors, hands and driven. NaN: not measured.
/// Command: counts driven, hands, unknown; then HighRateOutput::driven, driven_motion, hands
/// (hands feel the opposite) and unknown.
struct PacketHeader {
  enum class Kind : std::uint16_t { measurement = 1, command = 2 };
  Kind kind = Kind::measurement;
  std::uint32_t sequence = 0;
  std::array<std::uint16_t, 3> counts{};
  std::uint16_t state = 0;
  double time = 0.0;  ///< s
};

inline constexpr std::size_t kPacketHeader = 32;  ///< bytes
/// Bytes of the largest packet: fits into one Ethernet frame.
inline constexpr std::size_t kLargestPacket = 1400;

enum class PacketStatus {
  good,
  wrong_size,     ///< not that of its counts, or without a header
  wrong_magic,    ///< not of this protocol
  wrong_version,  ///< of another version
  wrong_kind,     ///< not of the kind that is waited for
  wrong_counts,   ///< of another device
  not_finite,     ///< a number is infinite
};
/// "good", "wrong-size", "wrong-magic", ...
std::string_view packet_status_name(PacketStatus status);

/// Bytes of a measurement with everything.
std::size_t measurement_size(const HighRateSettings& settings);
/// Bytes of a command.
std::size_t command_size(const HighRateSettings& settings);

/// @param header its kind and counts are set here. @param input what is sent. @param bytes as many
/// as the packet has, or more. @return bytes of the packet.
std::size_t write_measurement(PacketHeader header, const HighRateInput& input,
                              std::span<std::byte> bytes);
/// @param header its kind, counts and state are set here. @param output what is sent. @param bytes
/// as many as the packet has, or more. @return bytes of the packet.
std::size_t write_command(PacketHeader header, const HighRateOutput& output,
                          std::span<std::byte> bytes);

/// @param bytes a whole datagram. @param header gets the header. @param input gets the numbers
/// where the packet is good, and is left alone otherwise; its sizes are those of the loop.
PacketStatus read_measurement(std::span<const std::byte> bytes, PacketHeader& header,
                              HighRateInput& input);
/// @param bytes a whole datagram. @param header gets the header. @param output gets numbers and
/// state where the packet is good, and is left alone otherwise; its sizes are those of the loop.
PacketStatus read_command(std::span<const std::byte> bytes, PacketHeader& header,
                          HighRateOutput& output);

}  // namespace sinew::control
