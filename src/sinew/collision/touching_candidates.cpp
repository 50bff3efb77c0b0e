#include "sinew/collision/touching_candidates.hpp"

#include <algorithm>

namespace sinew::collision {

int feature_of(int first_facet, int second_facet, bool of_first, int source) {
  return 1 + source + 16 * ((of_first ? 0 : 1) + 2 * (first_facet + 8 * second_facet));
}

void TouchingCandidates::add(const Vector3& on_first, const Vector3& on_second,
                             const Vector3& normal, int feature) {
  const double gap = normal.dot(on_first - on_second);
  if (!(gap <= margin_) || size_ == kMost) return;
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
  constexpr double kNear = 1e4;  // times same()
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
  std::array<double, kMost> far;
  far.fill(kInfinity);
  const bool all = size_ <= TouchingPoints::kMost;
  for (std::size_t n = 0; n < std::min(size_, TouchingPoints::kMost); ++n) {
    const std::size_t next = all ? n : farthest(far);
    kept.add(points_[next]);
    for (std::size_t k = 0; k < size_; ++k) {
      far[k] = std::min(far[k], (points_[k].on_first - points_[next].on_first).squaredNorm());
    }
    far[next] = -1.0;
  }
  return kept;
}

// Of those equally far, the deepest.
std::size_t TouchingCandidates::farthest(const std::array<double, kMost>& far) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < size_; ++k) {
    if (far[k] > far[best] || (far[k] == far[best] && points_[k].gap < points_[best].gap)) {
      best = k;
    }
  }
  return best;
}

}  // namespace sinew::collision
