#include "sinew/high_rate/udp_device.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"

namespace sinew::high_rate {

namespace {

// Maximum number of datagrams read per period, against floods.
constexpr int kMaxPackets = 64;
// Silence, s, after which a device may have restarted, with small sequence numbers.
constexpr double kRestart = 1.0;

void count(std::atomic<std::int64_t>& counter) {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

void require_size(std::size_t bytes, const char* packet) {
  if (bytes <= kLargestPacket) return;
  throw Error(ErrorKind::out_of_range, {.item = "UDP device"},
              fmt::format("a {} has {} bytes, more than the {} of one packet", packet, bytes,
                          kLargestPacket),
              "name fewer rows");
}

sockaddr_in to_address(const std::string& address, int port) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  if (port < 0 || port > 65535) {
    throw Error(ErrorKind::bad_argument, {.item = "UDP device: port"},
                fmt::format("there is no port {}", port), "give 0 to 65535, 0 for any");
  }
  if (inet_pton(AF_INET, address.c_str(), &place.sin_addr) == 1) return place;
  throw Error(ErrorKind::bad_argument, {.item = "UDP device: address"},
              fmt::format("'{}' is no IPv4 address", address), "give one such as 127.0.0.1");
}

}  // namespace

UdpDevice::UdpDevice(const HighRateSettings& settings, const std::string& address, int port)
    : read_(HighRateInput::none(settings)),
      restarts_after_(whole<int>(std::ceil(kRestart / settings.period))) {
  require_size(measurement_size(settings), "measurement");
  require_size(command_size(settings), "command");
  sockaddr_in place = to_address(address, port);
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  socklen_t size = sizeof place;
  const bool bound = socket_ >= 0 &&
                     ::bind(socket_, reinterpret_cast<const sockaddr*>(&place), size) == 0 &&
                     ::getsockname(socket_, reinterpret_cast<sockaddr*>(&place), &size) == 0;
  if (bound) {
    port_ = ntohs(place.sin_port);
    return;
  }
  const std::string why = std::strerror(errno);
  if (socket_ >= 0) ::close(socket_);
  throw Error(ErrorKind::address_in_use, {.item = "UDP device"},
              fmt::format("{}:{} cannot be bound ({})", address, port, why),
              "give an address of this machine and a port that is free, or 0");
}

UdpDevice::~UdpDevice() { ::close(socket_); }

UdpReport UdpDevice::report() const {
  const auto read = [](const auto& counter) { return counter.load(std::memory_order_relaxed); };
  return {read(received_), read(invalid_), read(outdated_), read(sent_), read(not_sent_)};
}

bool UdpDevice::read(HighRateInput& input) {
  bool fresh = false;
  for (int k = 0; k < kMaxPackets; ++k) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got = ::recvfrom(socket_, bytes_.data(), bytes_.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0 && (errno == ECONNREFUSED || errno == EINTR)) continue;  // of an earlier command
    if (got < 0) break;
    fresh |= take(std::span(bytes_).first(static_cast<std::size_t>(got)), from, input);
  }
  silent_ = fresh ? 0 : std::min(silent_ + 1, restarts_after_);
  return fresh;
}

bool UdpDevice::take(std::span<const std::byte> bytes, const sockaddr_in& from,
                     HighRateInput& input) {
  PacketHeader header;
  if (read_measurement(bytes, header, read_) != PacketStatus::good) {
    count(invalid_);
    return false;
  }
  // Sequence numbers wrap: the shorter distance tells which one is later.
  const bool later = static_cast<std::int32_t>(header.sequence - last_) > 0;
  if (has_peer_ && !later && silent_ < restarts_after_) {
    count(outdated_);
    return false;
  }
  input.sensors.swap(read_.sensors);
  input.hands.swap(read_.hands);
  input.driven.swap(read_.driven);
  count(received_);
  last_ = header.sequence;
  peer_ = from;
  has_peer_ = true;
  silent_ = 0;
  return true;
}

void UdpDevice::write(const HighRateOutput& output) {
  if (!has_peer_) return;
  PacketHeader header;
  header.sequence = ++sequence_;
  header.time = output.snapshot_time;
  const std::size_t size = write_command(header, output, bytes_);
  const ssize_t sent = ::sendto(socket_, bytes_.data(), size, 0,
                                reinterpret_cast<const sockaddr*>(&peer_), sizeof peer_);
  count(sent == static_cast<ssize_t>(size) ? sent_ : not_sent_);
}

}  // namespace sinew::high_rate
