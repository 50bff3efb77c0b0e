/// @file
/// Hashes of the named parts of an object, by which two objects can tell in which parts they
/// differ.
#pragma once

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sinew/core/state_hash.hpp"
#include "sinew/core/types.hpp"

namespace sinew {

/// Name and hash of one part.
struct NamedHash {
  std::string name;  ///< such as "body 'trunk': material"
  std::uint64_t hash = 0;

  bool operator==(const NamedHash&) const = default;
};

/// Hashes values in order: numbers, enumerations, text, matrices, lists (size and entries) and
/// optional values. Real numbers count to seven digits, so that different rounding on another
/// processor does not change the hash.
class ValueHash {
 public:
  template <class... Values>
  ValueHash& add(const Values&... values) {
    (add_one(values), ...);
    return *this;
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  // Numbers that people write, such as powers of two, lie where rounding to single precision jumps.
  // Multiplied by an irrational factor they do not.
  static std::uint64_t leading_digits(double number) {
    constexpr double kTurn = 1.2785764, kNothing = 1e-12;
    if (std::abs(number) < kNothing) return 0;
    return std::bit_cast<std::uint32_t>(static_cast<float>(kTurn * number));
  }

  void add_one(double number) { hash_.add(leading_digits(number)); }
  template <std::integral T>
  void add_one(T number) {
    hash_.add(static_cast<double>(number));
  }
  template <class T>
  requires std::is_enum_v<T>
  void add_one(T choice) { hash_.add(static_cast<std::uint64_t>(choice)); }
  void add_one(std::uint64_t word) { hash_.add(word); }
  void add_one(const std::string& text) {
    hash_.add(static_cast<std::uint64_t>(text.size()));
    for (const char c : text) hash_.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  }
  template <class Derived>
  void add_one(const Eigen::DenseBase<Derived>& matrix) {
    hash_.add(static_cast<std::uint64_t>(matrix.rows()));
    hash_.add(static_cast<std::uint64_t>(matrix.cols()));
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) add_one(matrix.derived()(i, j));
    }
  }
  template <class T>
  void add_one(const std::optional<T>& value) {
    hash_.add(static_cast<std::uint64_t>(value.has_value()));
    if (value) add_one(*value);
  }
  template <class List>
  requires(
      requires(const List& list) { list.begin() != list.end(); } &&
      !requires { typename List::PlainObject; })  // Eigen's vectors are matrices
      void add_one(const List& list) {
    hash_.add(static_cast<std::uint64_t>(list.size()));
    for (const auto& item : list) add_one(item);
  }
  // Types with a member add_to() add their own values.
  template <class T>
  requires requires(const T& value, ValueHash& hash) { value.add_to(hash); }
  void add_one(const T& value) { value.add_to(*this); }

  StateHash hash_;
};

}  // namespace sinew
