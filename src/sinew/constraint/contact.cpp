#include "sinew/constraint/contact.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::constraint {

Contact::Contact(std::string name, std::size_t count, double friction, std::size_t stride)
    : Constraint(std::move(name)), count_(count), friction_(friction), stride_(stride) {
  if (!(friction >= 0.0) || !std::isfinite(friction)) {
    throw Error(ErrorKind::out_of_range, {},
                fmt::format("the friction coefficient is {:g}", friction), "give zero or more");
  }
  if (count == 0) {
    throw Error(ErrorKind::too_few_points, {}, "no point can touch the surface",
                "name a region that has nodes that are not fixed");
  }
}

Matrix3 Contact::frame(std::size_t point, const mechanics::RowValues& values) const {
  Matrix3 result;
  for (int k = 0; k < 3; ++k) result.col(k) = values.direction[entry(point, k)];
  return result;
}

}  // namespace sinew::constraint
