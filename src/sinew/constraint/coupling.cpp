#include "sinew/constraint/coupling.hpp"

#include <Eigen/Geometry>

#include "sinew/constraint/configuration.hpp"

namespace sinew::constraint {

Coupling::Coupling(mechanics::MaterialPoint first, mechanics::MaterialPoint second)
    : Constraint("coupling"), first_(first), second_(second) {}

void Coupling::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = 2;
  for (int k = 0; k < 2; ++k) rows.add_row({first_, second_});
}

void Coupling::linearise(const Configuration& configuration, mechanics::RowValues& values) const {
  const Vector3 line = configuration.position(second_) - configuration.position(first_);
  const Vector3 across = line.squaredNorm() > 0.0 ? line.unitOrthogonal() : Vector3::UnitX();
  const Vector3 directions[2] = {across, line.cross(across).normalized()};
  auto* direction = values.direction.data() + first_entry_;
  for (int k = 0; k < 2; ++k) {
    *direction++ = -directions[k];
    *direction++ = directions[k];
    values.delta[first_row_ + k] = directions[k].dot(line);
  }
}

}  // namespace sinew::constraint
