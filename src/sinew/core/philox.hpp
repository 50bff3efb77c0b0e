/// @file
/// Counter-based random numbers: any number of a stream can be computed directly, without a state.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace sinew {

/// Philox4x64-10 (Salmon, Moraes, Dror & Shaw, "Parallel random numbers: as easy as 1, 2, 3",
/// SC'11, section 3): a bijection of 256-bit counters for every 128-bit key; different keys give
/// independent streams. The bits are those of numpy.random.Philox.
class Philox {
 public:
  using Block = std::array<std::uint64_t, 4>;

  /// @param seed,stream the two halves of the key.
  explicit Philox(std::uint64_t seed, std::uint64_t stream = 0) : key_{seed, stream} {}

  /// The four random words of a counter.
  Block bits(const Block& counter) const {
    Block x = counter;
    std::array<std::uint64_t, 2> key = key_;
    for (int round = 0; round < kRounds; ++round) {
      const Wide a = static_cast<Wide>(0xd2e7470ee14c6c93u) * x[0];
      const Wide b = static_cast<Wide>(0xca5a826395121157u) * x[2];
      x = {high(b) ^ x[1] ^ key[0], static_cast<std::uint64_t>(b), high(a) ^ x[3] ^ key[1],
           static_cast<std::uint64_t>(a)};
      key[0] += 0x9e3779b97f4a7c15u;
      key[1] += 0xbb67ae8584caa73bu;
    }
    return x;
  }

  /// Uniform in [0, 1), a multiple of 2^-53. @param word of a block.
  static double uniform(std::uint64_t word) { return static_cast<double>(word >> 11) * 0x1p-53; }
  /// Standard normal (Box & Muller, Ann. Math. Stat. 29, 1958). @param a,b words of a block.
  static double normal(std::uint64_t a, std::uint64_t b) {
    const double radius = std::sqrt(-2.0 * std::log1p(-uniform(a)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(b));
  }

 private:
  __extension__ using Wide = unsigned __int128;
  static constexpr int kRounds = 10;
  static std::uint64_t high(Wide product) { return static_cast<std::uint64_t>(product >> 64); }

  std::array<std::uint64_t, 2> key_;
};

}  // namespace sinew
