/// @file
/// A device that is connected by UDP, with the packets of high_rate/packet.hpp.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <netinet/in.h>

#include "sinew/high_rate/device.hpp"
#include "sinew/high_rate/packet.hpp"

namespace sinew::high_rate {

/// Counters of a socket since it was opened.
struct UdpReport {
  std::int64_t received = 0;  ///< good measurements
  std::int64_t invalid = 0;   ///< bad packets, ignored
  std::int64_t outdated = 0;  ///< packets repeated or overtaken by a later one, ignored
  std::int64_t sent = 0;      ///< commands
  std::int64_t not_sent = 0;  ///< commands that the operating system refused
};

/// A device on a UDP socket. In each period it reads the latest measurement received, and sends a
/// command to its sender. Bad packets are counted and ignored. Anyone who can reach the address can
/// control the robot: packets are neither authenticated nor encrypted. The default address accepts
/// packets from this machine only.
class UdpDevice : public Device {
 public:
  /// Binds the socket. @param settings of the loop.
  /// @param address IPv4 of this machine, "0.0.0.0" for all of them. @param port 0: any.
  /// Throws Error: bad-argument, address-in-use, out-of-range (packets would be too large).
  explicit UdpDevice(const HighRateSettings& settings, const std::string& address = "127.0.0.1",
                     int port = 0);
  ~UdpDevice() override;
  UdpDevice(const UdpDevice&) = delete;
  UdpDevice& operator=(const UdpDevice&) = delete;

  int port() const { return port_; }
  UdpReport report() const;  ///< thread-safe

  bool read(HighRateInput& input) override;
  void write(const HighRateOutput& output) override;

 private:
  bool take(std::span<const std::byte> bytes, const sockaddr_in& from, HighRateInput& input);

  int socket_ = -1;
  int port_ = 0;
  std::array<std::byte, kLargestPacket + 1> bytes_{};
  HighRateInput read_;
  sockaddr_in peer_{};
  bool has_peer_ = false;
  int silent_ = 0;  // number of periods without a good packet
  int restarts_after_;
  std::uint32_t last_ = 0, sequence_ = 0;
  std::atomic<std::int64_t> received_{0}, invalid_{0}, outdated_{0}, sent_{0}, not_sent_{0};
};

}  // namespace sinew::high_rate
