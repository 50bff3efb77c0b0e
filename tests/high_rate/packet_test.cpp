// Packets byte by byte as documented, and rejection of bad ones.
#include "sinew/high_rate/packet.hpp"

#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace sinew::high_rate {
namespace {

HighRateSettings small_settings() {
  HighRateSettings settings;
  settings.driven.resize(2);
  settings.unknown.resize(1);
  settings.hands.resize(1);
  settings.sensors = {{0}, {1}};
  settings.max_contacts = 0;
  return settings;
}

HighRateInput some_input() {
  HighRateInput input = HighRateInput::none(small_settings());
  input.sensors << 1.0, std::nan("");
  input.hands << -2.0;
  input.driven << 3.0, 4.0;
  return input;
}

using Bytes = std::vector<std::byte>;

Bytes measurement() {
  Bytes bytes(measurement_size(small_settings()));
  PacketHeader header;
  header.sequence = 0x01020304;
  header.time = 1.5;
  EXPECT_EQ(write_measurement(header, some_input(), bytes), bytes.size());
  return bytes;
}

unsigned at(const Bytes& bytes, std::size_t k) { return std::to_integer<unsigned>(bytes[k]); }

TEST(Packet, HasTheDocumentedBytes) {
  const Bytes bytes = measurement();
  ASSERT_EQ(bytes.size(), 32u + 5u * 8u);
  EXPECT_EQ(std::memcmp(bytes.data(), "SNHR", 4), 0);
  const std::vector<unsigned> header = {1, 0, 1, 0, 4, 3, 2, 1, 2, 0, 1, 0, 2, 0, 0, 0, 0, 0, 0, 0};
  for (std::size_t k = 0; k < header.size(); ++k) EXPECT_EQ(at(bytes, 4 + k), header[k]) << k;
  // 1.5 is 3FF8000000000000, 1 is 3FF0000000000000, -2 is C000000000000000.
  EXPECT_EQ(at(bytes, 31), 0x3fu);
  EXPECT_EQ(at(bytes, 30), 0xf8u);
  EXPECT_EQ(at(bytes, 38), 0xf0u);
  EXPECT_EQ(at(bytes, 55), 0xc0u);
}

TEST(Packet, ComesBackAsItWent) {
  PacketHeader header;
  HighRateInput input = HighRateInput::none(small_settings());
  ASSERT_EQ(read_measurement(measurement(), header, input), PacketStatus::good);
  EXPECT_EQ(header.sequence, 0x01020304u);
  EXPECT_EQ(header.time, 1.5);
  EXPECT_EQ(input.sensors[0], 1.0);
  EXPECT_TRUE(std::isnan(input.sensors[1]));
  EXPECT_EQ(input.hands[0], -2.0);
  EXPECT_EQ(input.driven[1], 4.0);

  HighRateOutput sent = HighRateOutput::none(small_settings()), got = sent;
  sent.driven << 1.0, 2.0;
  sent.driven_motion << 3.0, 4.0;
  sent.hands << 5.0;
  sent.unknown << 6.0;
  sent.state = HighRateState::holding;
  Bytes bytes(command_size(small_settings()));
  EXPECT_EQ(write_command({}, sent, bytes), bytes.size());
  ASSERT_EQ(read_command(bytes, header, got), PacketStatus::good);
  EXPECT_EQ(got.driven, sent.driven);
  EXPECT_EQ(got.driven_motion, sent.driven_motion);
  EXPECT_EQ(got.hands, sent.hands);
  EXPECT_EQ(got.unknown, sent.unknown);
  EXPECT_EQ(got.state, HighRateState::holding);
}

TEST(Packet, EffortsMayBeLeftOut) {
  HighRateInput input = some_input();
  HighRateInput sent = input;
  sent.driven.resize(0);
  Bytes bytes(measurement_size(small_settings()));
  bytes.resize(write_measurement({}, sent, bytes));
  EXPECT_EQ(bytes.size(), 32u + 3u * 8u);
  PacketHeader header;
  ASSERT_EQ(read_measurement(bytes, header, input), PacketStatus::good);
  EXPECT_TRUE(std::isnan(input.driven[0]));
}

TEST(Packet, NamesWhatIsWrong) {
  const auto status = [](const auto& change) {
    Bytes bytes = measurement();
    change(bytes);
    PacketHeader header;
    HighRateInput input = HighRateInput::none(small_settings());
    const PacketStatus found = read_measurement(bytes, header, input);
    if (found != PacketStatus::good) {
      EXPECT_TRUE(std::isnan(input.sensors[0])) << "left alone";
    }
    return found;
  };
  EXPECT_EQ(status([](Bytes&) {}), PacketStatus::good);
  EXPECT_EQ(status([](Bytes& b) { b.clear(); }), PacketStatus::wrong_size);
  EXPECT_EQ(status([](Bytes& b) { b.resize(31); }), PacketStatus::wrong_size);
  EXPECT_EQ(status([](Bytes& b) { b.pop_back(); }), PacketStatus::wrong_size);
  EXPECT_EQ(status([](Bytes& b) { b.push_back({}); }), PacketStatus::wrong_size);
  EXPECT_EQ(status([](Bytes& b) { b[0] = {}; }), PacketStatus::wrong_magic);
  EXPECT_EQ(status([](Bytes& b) { b[4] = std::byte{2}; }), PacketStatus::wrong_version);
  EXPECT_EQ(status([](Bytes& b) { b[6] = std::byte{2}; }), PacketStatus::wrong_kind);
  EXPECT_EQ(status([](Bytes& b) { b[12] = std::byte{3}; }), PacketStatus::wrong_counts);
  EXPECT_EQ(status([](Bytes& b) {
              const double infinity = kInfinity;
              std::memcpy(b.data() + 32, &infinity, 8);
            }),
            PacketStatus::not_finite);
}

}  // namespace
}  // namespace sinew::high_rate
