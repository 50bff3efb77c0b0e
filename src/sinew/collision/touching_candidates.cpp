#include "sinew/collision/touching_candidates.hpp"

#include <algorithm>

namespace sinew::collision {

void TouchingCandidates::add(const Vector3& on_first, const Vector3& on_second,
                             const Vector3& normal, int feature) {
  const double gap = normal.dot(on_first - on_second);
  if (!(gap <= margin_ && gap >= deepest_) || size_ == kMax) return;
  for (std::size_t k = 0; k < size_; ++k) {
    if ((points_[k].on_first - on_first).norm() <= same_ &&
        (points_[k].on_second - on_second).norm() <= same_) {
      return;
    }
  }
  least_ = std::min(least_, gap);
  points_[size_++] = {on_first, on_second, normal, gap, feature};
}

void TouchingCandidates::add_nearest(const Separation& nearest) {
  if (least_ <= nearest.gap + same_) return;
  for (std::size_t k = 0; k < size_; ++k) {
    if ((points_[k].on_first - nearest.on_first).norm() > kNear * same_) continue;
    points_[k] = {nearest.on_first, nearest.on_second, nearest.normal, nearest.gap,
                  points_[k].feature};
    return;
  }
  add(nearest.on_first, nearest.on_second, nearest.normal, 0);
}

TouchingPoints TouchingCandidates::reduced() const {
  TouchingPoints kept;
  std::array<double, kMax> far;
  far.fill(kInfinity);
  const bool all = size_ <= TouchingPoints::kMax;
  // Uses both shapes, so that they may change places.
  const auto middle = [&](std::size_t k) -> Vector3 {
    return 0.5 * (points_[k].on_first + points_[k].on_second);
  };
  for (std::size_t n = 0; n < std::min(size_, TouchingPoints::kMax); ++n) {
    const std::size_t next = all ? n : farthest(far);
    kept.add(points_[next]);
    for (std::size_t k = 0; k < size_; ++k) {
      far[k] = std::min(far[k], (middle(k) - middle(next)).squaredNorm());
    }
    far[next] = -1.0;
  }
  return kept;
}

// Of equally far points, takes the deepest.
std::size_t TouchingCandidates::farthest(const std::array<double, kMax>& far) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < size_; ++k) {
    if (far[k] > far[best] || (far[k] == far[best] && points_[k].gap < points_[best].gap)) {
      best = k;
    }
  }
  return best;
}

}  // namespace sinew::collision
