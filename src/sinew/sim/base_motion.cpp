#include "sinew/sim/base_motion.hpp"

#include "sinew/core/error.hpp"

namespace sinew::sim {

Vector3 checked_axis(const Vector3& axis, const Location& place) {
  const double length = axis.norm();
  if (length > 0.0) return axis / length;
  throw Error(ErrorKind::out_of_range, place, "the axis has no length", "give one such as 0 0 1");
}

}  // namespace sinew::sim
