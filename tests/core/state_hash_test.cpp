#include "sinew/core/state_hash.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(StateHash, DependsOnBitsOrderAndCount) {
  const std::vector<double> numbers = {1.0, 2.0, 3.0};
  const std::uint64_t hash = hash_doubles(numbers);
  EXPECT_EQ(hash_doubles(numbers), hash);
  EXPECT_NE(hash_doubles(std::vector{2.0, 1.0, 3.0}), hash);
  EXPECT_NE(hash_doubles(std::vector{1.0, 2.0}), hash);
  EXPECT_NE(hash_doubles(std::vector{1.0, 2.0, std::nextafter(3.0, 4.0)}), hash);
  EXPECT_NE(hash_doubles(std::vector{0.0}), hash_doubles(std::vector{-0.0}));
  EXPECT_NE(hash_doubles(std::vector{0.0}), hash_doubles(std::vector{0.0, 0.0}));
  EXPECT_NE(hash_doubles(std::vector<double>{}), hash_doubles(std::vector{0.0}));
}

TEST(StateHash, IsTheSameInParts) {
  const std::vector<double> numbers = {0.1, -7.5, 1e300, std::numeric_limits<double>::quiet_NaN()};
  StateHash hash;
  hash.add(numbers[0]);
  hash.add(std::span(numbers).subspan(1));
  EXPECT_EQ(hash.value(), hash_doubles(numbers));
  const std::uint64_t before = hash.value();
  hash.add(std::uint64_t{5});
  EXPECT_NE(hash.value(), before);
}

TEST(StateHash, IsPinned) {
  // Stored hashes must remain comparable between versions: change this number only together with a
  // state version.
  EXPECT_EQ(hash_doubles(std::vector{1.0, -2.5, 1e-3}), 0x65c55b952f031719ULL);
}

TEST(StateHash, FlipsHalfOfItsBitsForAnyBitOfInput) {
  double flips = 0.0;
  const StateHash empty;
  StateHash reference = empty;
  reference.add(std::uint64_t{0});
  for (int bit = 0; bit < 64; ++bit) {
    StateHash hash = empty;
    hash.add(std::uint64_t{1} << bit);
    flips += std::popcount(hash.value() ^ reference.value());
  }
  EXPECT_NEAR(flips / 64.0, 32.0, 2.0);
}

TEST(StateHash, DoesNotCollideOnSmallStates) {
  std::set<std::uint64_t> seen;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) seen.insert(hash_doubles(std::vector<double>{1.0 * i, 1.0 * j}));
  }
  EXPECT_EQ(seen.size(), 10000u);
}

}  // namespace
}  // namespace sinew
