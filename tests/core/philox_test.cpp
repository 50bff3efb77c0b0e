#include "sinew/core/philox.hpp"

#include <gtest/gtest.h>

namespace sinew {
namespace {

constexpr std::uint64_t kOnes = ~std::uint64_t{0};

// Test vectors for philox4x64-10 from the authors' Random123, and one more from
// numpy.random.Philox.
TEST(Philox, GivesThePublishedBits) {
  EXPECT_EQ(Philox(0, 0).bits({0, 0, 0, 0}),
            (Philox::Block{0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b,
                           0x7e68b68aec7ba23b}));
  EXPECT_EQ(Philox(kOnes, kOnes).bits({kOnes, kOnes, kOnes, kOnes}),
            (Philox::Block{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6,
                           0xa09caebf594f0ba0}));
  EXPECT_EQ(
      Philox(0x452821e638d01377, 0xbe5466cf34e90c6c)
          .bits({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89}),
      (Philox::Block{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5,
                     0x57bd43b5e52b7fe6}));
}

TEST(Philox, MakesNumbersOfWords) {
  EXPECT_EQ(Philox::uniform(0), 0.0);
  EXPECT_EQ(Philox::uniform(kOnes), 1.0 - 0x1p-53);
  EXPECT_EQ(Philox::uniform(std::uint64_t{1} << 63), 0.5);
  EXPECT_EQ(Philox::normal(0, 12345), 0.0);  // radius 0
  EXPECT_NEAR(Philox::normal(kOnes, 0), std::sqrt(2.0 * 53.0 * std::numbers::ln2), 1e-12);
}

}  // namespace
}  // namespace sinew
