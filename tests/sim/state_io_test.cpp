#include "sinew/sim/state_io.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/core/state_hash.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::pull;

ErrorKind kind_of(Simulation& simulation, std::string_view bytes) {
  const auto before = simulation.state().hash();
  try {
    parse_state(simulation, bytes, "test.state");
  } catch (const Error& error) {
    EXPECT_EQ(simulation.state().hash(), before) << "a refused state changes nothing";
    EXPECT_EQ(error.place().file, "test.state");
    return error.kind();
  }
  return ErrorKind::internal;
}

TEST(StateIo, ARunGoesOnBitForBit) {
  const auto model = beam();
  Simulation first(model), second(model);
  first.command(0, pull(0.003));
  second.command(0, pull(0.003));
  for (int i = 0; i < 7; ++i) first.step();
  const auto path = std::filesystem::temp_directory_path() /
                    ("sinew_state_io_" + std::to_string(getpid()) + ".state");
  save_state(first, path);
  load_state(second, path);
  std::filesystem::remove(path);
  EXPECT_EQ(second.steps(), 7);
  EXPECT_EQ(second.state().hash(), first.state().hash());
  for (int i = 0; i < 5; ++i) {
    first.step();
    second.step();
  }
  EXPECT_EQ(second.state().hash(), first.state().hash());
}

TEST(StateIo, WrongBytesAreRefused) {
  Simulation simulation(beam());
  const std::string good = format_state(simulation);
  EXPECT_EQ(kind_of(simulation, ""), ErrorKind::state_corrupt);
  EXPECT_EQ(kind_of(simulation, "hello, this is no state at all, but long enough for one"),
            ErrorKind::state_corrupt);
  EXPECT_EQ(kind_of(simulation, good.substr(0, good.size() - 1)), ErrorKind::state_corrupt);
  EXPECT_EQ(kind_of(simulation, good + "x"), ErrorKind::state_corrupt);
  std::string version = good;
  version[8] = static_cast<char>(kStateVersion + 1);
  EXPECT_EQ(kind_of(simulation, version), ErrorKind::state_version);
  std::string damaged = good;
  damaged[100] = static_cast<char>(damaged[100] ^ 1);
  EXPECT_EQ(kind_of(simulation, damaged), ErrorKind::state_corrupt);
  BeamOptions other;
  other.cables = 3;
  Simulation smaller(beam(other));
  EXPECT_EQ(kind_of(smaller, good), ErrorKind::state_mismatch);
}

TEST(StateIo, NumbersThatAreNotFiniteAreRefused) {
  Simulation simulation(beam());
  std::string bytes = format_state(simulation);
  const double largest_energy = 0.125;  // occurs nowhere else
  run::State state = simulation.state();
  state.ledger.largest = largest_energy;
  simulation.restore(state);
  bytes = format_state(simulation);
  const auto* pattern = reinterpret_cast<const char*>(&largest_energy);
  const std::size_t at = bytes.find(std::string_view(pattern, 8));
  ASSERT_NE(at, std::string::npos);
  const double nan = std::nan("");
  std::memcpy(bytes.data() + at, &nan, 8);
  StateHash sum;
  for (std::size_t i = 0; i + 8 < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, 8);
    sum.add(word);
  }
  const std::uint64_t hash = sum.value();
  std::memcpy(bytes.data() + bytes.size() - 8, &hash, 8);
  try {
    parse_state(simulation, bytes, "test.state");
    ADD_FAILURE() << "read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::state_corrupt);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("not finite"));
  }
}

TEST(StateIo, ARefusedStateNamesWhatDiffers) {
  Simulation simulation(beam());
  const std::string bytes = format_state(simulation);
  const auto message = [&](const BeamOptions& options) -> std::string {
    Simulation other(beam(options));
    try {
      parse_state(other, bytes, "test.state");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::state_mismatch);
      return error.what();
    }
    return "accepted";
  };
  BeamOptions same;
  EXPECT_EQ(message(same), "accepted");
  BeamOptions stepped;
  stepped.step.time_step = 0.02;
  EXPECT_THAT(message(stepped), ::testing::HasSubstr("differs in: time step"));
  BeamOptions dynamic;
  dynamic.step.integrator = mechanics::Integrator::bdf2;
  EXPECT_THAT(message(dynamic), ::testing::HasSubstr("integrator"));
  BeamOptions fewer;
  fewer.cables = 1;
  EXPECT_THAT(message(fewer), ::testing::HasSubstr("(not in this robot)"));
}

TEST(StateIo, RandomDamageNeverPasses) {
  Simulation simulation(beam());
  const std::string good = format_state(simulation);
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = good;
    bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    EXPECT_NE(kind_of(simulation, bytes), ErrorKind::internal) << i;
  }
}

TEST(StateIo, AHeaderTellsOfAState) {
  Simulation simulation(beam());
  for (int i = 0; i < 3; ++i) simulation.step();
  const std::string bytes = format_state(simulation);
  EXPECT_TRUE(is_state(bytes));
  EXPECT_FALSE(is_state("SINEWS"));
  const StateHeader header = read_state_header(bytes, "test.state");
  EXPECT_EQ(header.version, kStateVersion);
  EXPECT_EQ(header.fingerprint, simulation.model().fingerprint());
  EXPECT_EQ(header.steps, 3);
  EXPECT_EQ(header.count, simulation.state().size());
  EXPECT_THROW(read_state_header(bytes.substr(0, 60), "test.state"), Error);
}

}  // namespace
}  // namespace sinew::sim
