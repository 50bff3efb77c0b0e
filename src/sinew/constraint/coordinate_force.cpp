#include "sinew/constraint/coordinate_force.hpp"

#include <utility>

#include "sinew/constraint/configuration.hpp"

namespace sinew::constraint {

CoordinateForce::CoordinateForce(std::string name, mechanics::Coordinate coordinate)
    : Constraint(std::move(name)), coordinate_(coordinate) {}

void CoordinateForce::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_entry_ = rows.entries();
  first_row_ = rows.add_row({coordinate_});
  row_count_ = 1;
}

void CoordinateForce::linearise(const Configuration& configuration,
                                mechanics::RowValues& values) const {
  values.direction[static_cast<std::size_t>(first_entry_)] = Vector3::UnitX();
  values.delta[first_row_] = configuration.coordinate(coordinate_);
}

}  // namespace sinew::constraint
