#include "sinew/model/base_motion.hpp"

#include <algorithm>
#include <cstddef>

#include "sinew/core/error.hpp"

namespace sinew::model {

BaseMotion::Rate BaseMotion::rate(double time, Signal::Side side) const {
  const auto along = [&](std::size_t k) { return translation[k].rate(time, side); };
  return {
      centre + translation_at(time), {along(0), along(1), along(2)}, angle.rate(time, side) * axis};
}

double BaseMotion::next_corner(double time) const {
  double next = angle.next_corner(time);
  for (const Signal& along : translation) next = std::min(next, along.next_corner(time));
  return next;
}

bool BaseMotion::jumps() const {
  return angle.jumps() || std::ranges::any_of(translation, &Signal::jumps);
}

Vector3 checked_axis(const Vector3& axis, const Location& place) {
  const double length = axis.norm();
  if (length > 0.0) return axis / length;
  throw Error(ErrorKind::out_of_range, place, "the axis has no length", "give one such as 0 0 1");
}

}  // namespace sinew::model
