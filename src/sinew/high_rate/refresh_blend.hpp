/// @file
/// Blends from one snapshot to the next without a jump.
#pragma once

#include <cmath>

#include "sinew/core/types.hpp"
#include "sinew/core/whole.hpp"

namespace sinew::high_rate {

/// Bumpless transfer between snapshots. At a refresh both snapshots are evaluated at the same
/// input. The old answer minus the new one becomes an offset, which decreases linearly to zero in
/// n = floor(blend/T) + 1 periods. One nth of the difference passes in each period, from the
/// refresh on. After n - 1 periods, at most `blend`, the answer is that of the new snapshot.
/// Between refreshes the answer follows its input without delay.
class RefreshBlend {
 public:
  /// @param size of an answer. @param blend,period s.
  RefreshBlend(Eigen::Index size, double blend, double period)
      : offset_(VectorX::Zero(size)),
        periods_(whole<int>(blend / period + 1e-9, 0, 1'000'000) + 1) {}

  int periods() const { return periods_; }  ///< n
  /// Starts a transfer. @param difference (size,) old answer, including its offset, minus the new
  /// one, at the same input.
  void begin(const VectorX& difference) {
    offset_ = difference;
    left_ = periods_;
  }
  /// Advances by one period.
  void advance() {
    moves_ = left_ > 0;
    if (moves_) --left_;
  }
  /// Offset to be added to an entry of the answer.
  double at(Eigen::Index entry) const { return offset_[entry] * left_ / periods_; }
  /// Change of an entry in the present period due to the offset alone.
  double jump(Eigen::Index entry) const {
    return moves_ ? std::abs(offset_[entry]) / periods_ : 0.0;
  }

 private:
  VectorX offset_;
  int periods_;
  int left_ = 0;
  bool moves_ = false;
};

}  // namespace sinew::high_rate
