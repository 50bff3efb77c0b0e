// A simulated parallel device with six motors, capstans and flex sensors at the other end of a
// socket, at 500 Hz of a simulated clock.
#include "sinew/high_rate/udp_device.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/LU>
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "sinew/core/random.hpp"
#include "sinew/high_rate/high_rate_loop.hpp"

#include "../support/error_kind.hpp"

namespace sinew::high_rate {
namespace {

using sinew::testing::kind_of;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kPeriod = 2e-3;  // s

/// A soft platform with six coordinates q on stiffening elastic legs,
///   f(q) = K q + k_3 |q|^2 q = H_a^T T + H_f^T f,
/// driven by six cable loops that motors wind over capstans, and pushed by a hand at its knob.
struct ParallelDevice {
  static constexpr double kRadius = 8e-3;    // m, of the capstans
  static constexpr double kTorque = 1e-4;    // N m, resolution of the motors
  static constexpr double kFlexStep = 2e-6;  // m, resolution of the flex sensors
  Matrix6 stiffness, cables, flex;
  Eigen::Matrix<double, 3, 6> knob;
  Vector6 q = Vector6::Zero();

  ParallelDevice() {
    Random random(3);
    const auto entry = [&] { return random.uniform(-1.0, 1.0); };
    Matrix6 mixed;
    for (double& number : mixed.reshaped()) number = entry();
    stiffness = 1000.0 * (Matrix6::Identity() + 0.2 * (mixed + mixed.transpose()));
    for (double& number : flex.reshaped()) number = 0.3 * entry();
    flex += Matrix6::Identity();
    for (int k = 0; k < 6; ++k) {  // legs of a tilted hexapod
      const double angle = k * std::numbers::pi / 3.0;
      cables.row(k) << std::cos(angle), std::sin(angle), 0.5, (k % 2 == 0 ? 0.7 : -0.7),
          0.4 * std::sin(2.0 * angle), 0.4 * std::cos(2.0 * angle);
    }
    knob.setZero();
    knob.leftCols<3>().setIdentity();
    knob(0, 4) = 0.2;
    knob(1, 3) = -0.2;
  }
  Vector6 force(const Vector6& at) const { return stiffness * at + 2e7 * at.squaredNorm() * at; }
  Matrix6 tangent(const Vector6& at) const {
    return stiffness + 2e7 * (at.squaredNorm() * Matrix6::Identity() + 2.0 * at * at.transpose());
  }
  void move(const VectorX& tensions, const Vector3& hand) {
    Vector6 load = knob.transpose() * hand;
    for (int k = 0; k < 6; ++k) {
      const double torque = kTorque * std::round(tensions[k] * kRadius / kTorque);
      load += cables.row(k).transpose() * torque / kRadius;
    }
    for (int i = 0; i < 20; ++i) q += tangent(q).lu().solve(load - force(q));
  }
  Vector6 read_flex(Random& random) const {
    Vector6 reading = flex * q;
    for (double& number : reading) {
      number = kFlexStep * std::round((number + 2e-6 * random.normal()) / kFlexStep);
    }
    return reading;
  }
  /// Rows: driven cables, the hand's force at the knob, flex sensors, the knob.
  Snapshot snapshot() const {
    Eigen::Matrix<double, 18, 6> rows;
    rows << cables, knob, flex, knob;
    const Matrix6 compliance = tangent(q).inverse();
    Snapshot result;
    result.compliance = rows * compliance * rows.transpose();
    result.free = rows * (q - compliance * force(q));
    result.effort = VectorX::Zero(18);
    result.size = 0.1;
    return result;
  }
};

HighRateSettings device_settings() {
  HighRateSettings settings;
  settings.driven.assign(6, {.effort_min = -30.0, .effort_max = 30.0});
  settings.unknown.assign(3, {.prior = 3.0});
  settings.observed = 9;
  for (int k = 0; k < 6; ++k) settings.sensors.push_back({9 + k, 2e-6});
  for (int k = 0; k < 3; ++k) settings.tasks.push_back({15 + k});
  settings.max_contacts = 0;
  settings.period = kPeriod;
  settings.largest_step = 1.0;
  return settings;
}

/// The device's end of the connection.
class Socket {
 public:
  explicit Socket(int port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(static_cast<std::uint16_t>(port));
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there), 0);
  }
  ~Socket() { ::close(socket_); }
  void send(std::span<const std::byte> bytes) {
    EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }
  void send(std::uint32_t sequence, const VectorX& sensors) {
    HighRateInput input;
    input.sensors = sensors;
    PacketHeader header;
    header.sequence = sequence;
    send(std::span(bytes_).first(write_measurement(header, input, bytes_)));
  }
  /// Waits for a command; on one machine none is lost.
  void receive(HighRateOutput& output) {
    pollfd waiting{socket_, POLLIN, 0};
    ASSERT_EQ(::poll(&waiting, 1, 10000), 1);
    const ssize_t size = ::recv(socket_, bytes_.data(), bytes_.size(), 0);
    PacketHeader header;
    ASSERT_EQ(read_command(std::span(bytes_).first(static_cast<std::size_t>(size)), header, output),
              PacketStatus::good);
  }

 private:
  int socket_;
  std::array<std::byte, kLargestPacket> bytes_{};
};

class StillClock : public Clock {
 public:
  double now() override { return time_; }
  void sleep_until(double time) override { time_ = time; }

 private:
  double time_ = 0.0;
};

TEST(UdpDevice, SixMotorsFollowAndFlexSensorsFeel) {
  const HighRateSettings settings = device_settings();
  const auto port = std::make_shared<UdpDevice>(settings);
  HighRateLoop loop(settings, port);
  Socket socket(port->port());
  ParallelDevice device;
  Random random(1);
  StillClock clock;
  HighRateOutput command = HighRateOutput::none(settings);
  HighRateInput asked = HighRateInput::none(settings);
  double force_error = 0.0, force_size = 0.0, place_error = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double time = k * kPeriod;
    const Vector3 hand(1.5 * std::sin(3.0 * time), 1.0 * std::cos(2.0 * time) - 1.0,
                       0.8 * std::sin(5.0 * time));
    asked.targets << 1e-3 * std::sin(1.3 * time), 1e-3 * (1.0 - std::cos(1.7 * time)), 2e-3;
    loop.set_input(asked);
    if (k % 5 == 0) loop.publish(device.snapshot());  // 100 Hz
    socket.send(static_cast<std::uint32_t>(k + 1), device.read_flex(random));
    loop.run(clock, 1);
    ASSERT_NO_FATAL_FAILURE(socket.receive(command));
    if (k >= 200) {
      force_error += (command.unknown - hand).squaredNorm();
      force_size += hand.squaredNorm();
      place_error = std::max(place_error, (device.knob * device.q - asked.targets).norm());
    }
    device.move(command.driven, hand);
  }
  const double relative = std::sqrt(force_error / force_size);
  RecordProperty("relative_force_error", std::to_string(relative));
  RecordProperty("largest_place_error", std::to_string(place_error));
  EXPECT_LT(relative, 0.02);
  EXPECT_LT(place_error, 0.1e-3);
  EXPECT_EQ(port->report().received, 2000);
  EXPECT_EQ(port->report().sent, 2000);
  EXPECT_EQ(port->report().invalid + port->report().outdated + port->report().not_sent, 0);
}

TEST(UdpDevice, CountsAndIgnoresBadPackets) {
  const HighRateSettings settings = device_settings();
  UdpDevice port(settings);
  Socket socket(port.port());
  HighRateInput input = HighRateInput::none(settings);
  EXPECT_FALSE(port.read(input));
  const VectorX first = VectorX::Constant(6, 1.0), second = VectorX::Constant(6, 2.0);
  socket.send(0xfffffffeu, first);
  EXPECT_TRUE(port.read(input));
  const std::array<std::byte, 5> noise{};
  socket.send(noise);
  socket.send(5, VectorX::Constant(7, 1.0));  // wrong length
  socket.send(6, VectorX::Constant(6, kInfinity));
  socket.send(0xfffffffeu, second);  // duplicate
  socket.send(0xfffffffdu, second);  // out of order
  EXPECT_FALSE(port.read(input));
  EXPECT_EQ(input.sensors, first);
  EXPECT_EQ(port.report().invalid, 3);
  EXPECT_EQ(port.report().outdated, 2);
  socket.send(3, second);  // after the counter wraps
  EXPECT_TRUE(port.read(input));
  EXPECT_EQ(input.sensors, second);
  EXPECT_EQ(port.report().received, 2);
  // A restarted device is accepted after a second.
  for (int k = 0; k < 500; ++k) port.read(input);
  socket.send(1, first);
  EXPECT_TRUE(port.read(input));
  EXPECT_EQ(input.sensors, first);
}

TEST(UdpDevice, WithoutMeasurementsTheLoopLetsGo) {
  HighRateSettings settings = device_settings();
  settings.stale_after = 0.05;
  settings.release_time = 0.1;
  const auto port = std::make_shared<UdpDevice>(settings);
  HighRateLoop loop(settings, port);
  Socket socket(port->port());
  const ParallelDevice device;
  StillClock clock;
  loop.publish(device.snapshot());
  HighRateOutput command = HighRateOutput::none(settings);
  std::array<int, 5> seen{};
  socket.send(1, VectorX::Zero(6));
  loop.run(clock, 130);  // the socket buffers this many commands
  for (int k = 0; k < 130; ++k) {
    ASSERT_NO_FATAL_FAILURE(socket.receive(command));
    ++seen[static_cast<std::size_t>(command.state)];
  }
  EXPECT_EQ(command.state, HighRateState::released);
  for (const auto state :
       {HighRateState::running, HighRateState::holding, HighRateState::releasing}) {
    EXPECT_GT(seen[static_cast<std::size_t>(state)], 10);
  }
  EXPECT_EQ(command.driven.norm(), 0.0);
}

TEST(UdpDevice, NamesWhatIsWrong) {
  const HighRateSettings settings = device_settings();
  EXPECT_EQ(kind_of([&] { UdpDevice(settings, "nowhere"); }), ErrorKind::bad_argument);
  EXPECT_EQ(kind_of([&] { UdpDevice(settings, "127.0.0.1", 70000); }), ErrorKind::bad_argument);
  const UdpDevice first(settings);
  EXPECT_EQ(kind_of([&] { UdpDevice(settings, "127.0.0.1", first.port()); }),
            ErrorKind::address_in_use);
  HighRateSettings large = settings;
  large.driven.resize(100);
  EXPECT_EQ(kind_of([&] { UdpDevice{large}; }), ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::high_rate
