/// @file
/// From one snapshot to the next without a jump.
#pragma once

#include <cmath>

#include "sinew/core/types.hpp"

namespace sinew::control {

/// At a refresh both snapshots are asked at the same input. What the old one answered beyond the
/// new one stays as an offset that falls linearly to nothing in n = floor(blend/T) + 1 periods
/// (bumpless transfer): an nth of the difference comes through in each period, from the refresh on,
/// and after n - 1 periods, at most `blend`, the answer is that of the new snapshot. Between
/// refreshes the answer follows its input without delay.
class RefreshBlend {
 public:
  /// @param size numbers of an answer. @param blend,period s.
  RefreshBlend(Eigen::Index size, double blend, double period)
      : offset_(VectorX::Zero(size)), periods_(static_cast<int>(blend / period + 1e-9) + 1) {}

  int periods() const { return periods_; }  ///< n
  /// @param difference (size,) old answer, offset included, less the new one, at the same input.
  void begin(const VectorX& difference) {
    offset_ = difference;
    left_ = periods_;
  }
  /// One period on.
  void advance() {
    moves_ = left_ > 0;
    if (moves_) --left_;
  }
  /// To be added to an entry of the answer.
  double at(Eigen::Index entry) const { return offset_[entry] * left_ / periods_; }
  /// How much an entry changed by this alone in the present period.
  double jump(Eigen::Index entry) const {
    return moves_ ? std::abs(offset_[entry]) / periods_ : 0.0;
  }

 private:
  VectorX offset_;
  int periods_;
  int left_ = 0;
  bool moves_ = false;
};

}  // namespace sinew::control
