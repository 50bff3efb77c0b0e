#include "sinew/collision/approach.hpp"

#include <algorithm>

namespace sinew::collision {

namespace {

// Relative to the length of the path: the gap that counts as touching, and the accuracy of the
// minimum.
constexpr double kTouches = 1e-12;
constexpr int kMaxTries = 100;  // for a path that grazes a surface, each halves the distance

// The gap along a path, as a function of the share of its length.
template <class Kind>
class GapOnWay {
 public:
  GapOnWay(const Kind& shape, const Vector3& from, const Vector3& to)
      : shape_(shape), from_(from), way_(to - from), touches_(kTouches * way_.norm()) {
    move(0.0);
  }
  void move(double share) {
    share_ = share;
    at_ = from_ + share * way_;
    here_ = distance(shape_, at_);
  }
  double share() const { return share_; }
  double slope() const { return here_.normal.dot(way_); }
  bool touches() const { return here_.gap <= touches_; }
  double next_zero() const { return share_ - here_.gap / slope(); }
  ShapeApproach result(bool meets) const { return {at_, here_, meets}; }

 private:
  const Kind& shape_;
  Vector3 from_, way_, at_;
  double touches_, share_ = 0.0;
  ShapeDistance here_;
};

// Bisection for the minimum of the gap, where its increasing slope passes zero.
template <class Kind>
ShapeApproach nearest_between(GapOnWay<Kind>& gap, double falling, double rising) {
  while (rising - falling > kTouches) {
    const double middle = 0.5 * (falling + rising);
    gap.move(middle);
    (gap.slope() < 0.0 ? falling : rising) = middle;
  }
  gap.move(rising);
  return gap.result(false);
}

template <class Kind>
ShapeApproach approach_to(const Kind& shape, const Vector3& from, const Vector3& to) {
  GapOnWay<Kind> gap(shape, from, to);
  if (!(gap.slope() < 0.0)) return gap.result(false);
  for (int k = 0; k < kMaxTries && !gap.touches(); ++k) {
    const double before = gap.share(), next = gap.next_zero();
    if (next - before <= kTouches) break;
    gap.move(std::min(next, 1.0));
    if (gap.slope() >= 0.0 && !gap.touches()) return nearest_between(gap, before, gap.share());
    if (next >= 1.0) return gap.result(false);
  }
  return gap.result(true);
}

}  // namespace

ShapeApproach approach(const Plane& plane, const Vector3& from, const Vector3& to) {
  return approach_to(plane, from, to);
}

ShapeApproach approach(const Sphere& sphere, const Vector3& from, const Vector3& to) {
  return approach_to(sphere, from, to);
}

ShapeApproach approach(const Capsule& capsule, const Vector3& from, const Vector3& to) {
  return approach_to(capsule, from, to);
}

ShapeApproach approach(const Cylinder& cylinder, const Vector3& from, const Vector3& to) {
  return approach_to(cylinder, from, to);
}

ShapeApproach approach(const OrientedBox& box, const Vector3& from, const Vector3& to) {
  return approach_to(box, from, to);
}

ShapeApproach approach(const ConvexSolid& solid, const Vector3& from, const Vector3& to) {
  return approach_to(solid, from, to);
}

}  // namespace sinew::collision
