#include "sinew/constraint/point_force.hpp"

#include <utility>

#include "sinew/constraint/configuration.hpp"
#include "sinew/core/error.hpp"

namespace sinew::constraint {

PointForce::PointForce(std::string name, mechanics::MaterialPoint point, const Vector3& direction,
                       const Vector3& rest_position)
    : Constraint(std::move(name)), point_(point), rest_position_(rest_position) {
  const double length = direction.norm();
  if (!(length > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "force '" + this->name() + "'"},
                "the direction has no length", "give a direction such as 0 0 1");
  }
  direction_ = direction / length;
}

void PointForce::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_entry_ = rows.entries();
  first_row_ = rows.add_row({point_});
  row_count_ = 1;
}

void PointForce::linearise(const Configuration& configuration, mechanics::RowValues& values) const {
  values.direction[static_cast<std::size_t>(first_entry_)] = direction_;
  values.delta[first_row_] = direction_.dot(configuration.position(point_) - rest_position_);
}

}  // namespace sinew::constraint
