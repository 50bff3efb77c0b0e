#include "sinew/world/row_motions.hpp"

#include <vector>

#include "sinew/constraint/contact.hpp"
#include "sinew/model/model.hpp"
#include "sinew/world/world.hpp"

namespace sinew::world {

double row_velocity(const World& world, int row) {
  const mechanics::RowPattern& pattern = world.model().rows();
  const auto first = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(row)]);
  const auto end = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(row) + 1]);
  double rate = 0.0;
  for (std::size_t e = first; e < end; ++e) {
    rate += world.rows().direction[e].dot(world.configuration().velocity(pattern.site[e]));
  }
  return rate;
}

Vector3 contact_velocity(const World& world, int contact, std::size_t point) {
  const constraint::Contact& touching = world.model().contact(contact);
  const contact::ContactPlanes& planes = world.contacts().planes();
  const Matrix3 frame = touching.frame(point, world.rows());
  if (planes.shape(static_cast<std::size_t>(contact)) == nullptr) {
    return frame.transpose() * planes.velocity_beside(touching, point);
  }
  Vector3 rates = -frame.transpose() * planes.surface_velocity(touching, point);
  for (int j = 0; j < 3; ++j) rates[j] += row_velocity(world, touching.row(point) + j);
  return rates;
}

MatrixX row_forces(World& world, std::span<const int> rows) {
  std::vector<double> unit(world.numbering().problem_rows().size(), 0.0);
  VectorX rest, row;
  world.bodies().imbalance(unit, rest);
  MatrixX result(rest.size(), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    world.numbering().spread(rows[k], 1.0, unit);
    world.bodies().imbalance(unit, row);
    world.numbering().spread(rows[k], 0.0, unit);
    result.col(static_cast<Eigen::Index>(k)) = row - rest;
  }
  return result;
}

}  // namespace sinew::world
