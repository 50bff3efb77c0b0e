#include "sinew/constraint/contact.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::constraint {

bool Friction::slides(const Vector3& effort) const {
  if (qp::slides(effort, sticking)) return true;
  return sliding < sticking && qp::slides(effort, sliding) && qp::at_most(effort, sliding);
}

void Friction::describe(PartVisitor& visitor) const {
  visitor.number("friction", "", sticking);
  if (sliding != sticking) visitor.number("kinetic_friction", "", sliding);
}

Contact::Contact(std::string name, std::size_t count, Friction friction, std::size_t stride)
    : Constraint(std::move(name)), count_(count), friction_(friction), stride_(stride) {
  if (!(friction.sticking >= 0.0) || !std::isfinite(friction.sticking)) {
    throw Error(ErrorKind::out_of_range, {},
                fmt::format("the friction coefficient is {:g}", friction.sticking),
                "give zero or more");
  }
  const bool differs = friction.sliding != friction.sticking;
  if (differs && !(friction.sliding > 0.0 && friction.sliding < friction.sticking)) {
    throw Error(ErrorKind::out_of_range, {},
                fmt::format("the coefficient of kinetic friction is {:g}, that of static friction "
                            "{:g}",
                            friction.sliding, friction.sticking),
                "give a kinetic one above zero and no greater than the static one");
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
