#include "sinew/constraint/placement.hpp"

#include <cstddef>

#include "sinew/mechanics/body.hpp"

namespace sinew::constraint {

Vector3 Placement::position(const mechanics::MaterialPoint& point) const {
  return bodies_[static_cast<std::size_t>(point.body)]->position(point.point);
}

Vector3 Placement::velocity(const mechanics::MaterialPoint& point) const {
  return bodies_[static_cast<std::size_t>(point.body)]->velocity(point.point);
}

}  // namespace sinew::constraint
