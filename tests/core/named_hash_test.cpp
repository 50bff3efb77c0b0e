#include "sinew/core/named_hash.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace sinew {
namespace {

std::uint64_t hash_of(double number) { return ValueHash().add(number).value(); }

// Integers and decimal literals, and their halves, quarters, ..., where digits jump.
TEST(ValueHash, IsTheSameForWhatRoundingMakesOfANumber) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int differ = 0;
  for (int k = 0; k < 100000; ++k) {
    const double number = k < 1000   ? k
                          : k < 2000 ? 1e-3 * k
                                     : std::ldexp(any(generator), k % 40 - 20);
    double off = number;
    for (int ulp = 0; ulp < 4; ++ulp) off = std::nextafter(off, k % 2 == 0 ? 1e9 : -1e9);
    differ += hash_of(off) == hash_of(number) ? 0 : 1;
    if (k < 2000) {
      EXPECT_EQ(hash_of(off), hash_of(number)) << number;
    }
  }
  EXPECT_LE(differ, 1);  // chance: 4 ulp of 2^29 per digit, 1e-8 of all
}

TEST(ValueHash, TellsNumbersApart) {
  for (const double number : {1.0, 0.5, 3.25e5, 1e-9, -2.0}) {
    EXPECT_NE(hash_of(number), hash_of(number * (1.0 + 1e-6))) << number;
    EXPECT_NE(hash_of(number), hash_of(-number));
  }
  EXPECT_EQ(hash_of(0.0), hash_of(-0.0));
  EXPECT_EQ(hash_of(0.0), hash_of(1e-14)) << "what is left of a difference";
  EXPECT_NE(hash_of(std::numeric_limits<double>::infinity()), hash_of(1e30));
}

TEST(ValueHash, WholeNumbersCountWhole) {
  EXPECT_NE(ValueHash().add(100000001).value(), ValueHash().add(100000002).value());
  EXPECT_NE(ValueHash().add(std::vector{1, 2}).value(), ValueHash().add(std::vector{2, 1}).value());
}

}  // namespace
}  // namespace sinew
