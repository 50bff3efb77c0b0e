/// @file
/// A 64-bit hash of states, to check that two runs agree bit for bit.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace sinew {

/// Hashes the bits of numbers in order: 0.0 and -0.0 differ, and so do NaNs with different
/// payloads. The hash is the same on every platform with IEEE doubles, in any byte order. It is not
/// cryptographic. The mixing is the finaliser of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014,
/// section 4), a bijection of each word into the state.
class StateHash {
 public:
  /// Appends one 64-bit word.
  void add(std::uint64_t word) {
    state_ = mix((std::rotl(state_, 23) ^ word) + kIncrement);
    ++count_;
  }
  /// Appends the bits of a number.
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  /// Appends numbers in order; their count is not appended.
  void add(std::span<const double> numbers) {
    for (const double number : numbers) add(number);
  }

  /// The hash of all words so far and of their number.
  std::uint64_t value() const { return mix(state_ ^ count_); }

 private:
  static constexpr std::uint64_t kIncrement = 0x9e3779b97f4a7c15ULL;
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_ = kIncrement;
  std::uint64_t count_ = 0;
};

/// The StateHash of a sequence of numbers.
inline std::uint64_t hash_doubles(std::span<const double> numbers) {
  StateHash hash;
  hash.add(numbers);
  return hash.value();
}

}  // namespace sinew
