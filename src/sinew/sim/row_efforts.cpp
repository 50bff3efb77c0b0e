#include "sinew/sim/row_efforts.hpp"

#include <algorithm>

#include "sinew/constraint/constraint.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

RowEfforts split_efforts(const Simulation& simulation) {
  const std::span<const double> all = simulation.efforts();
  const std::vector<double> none(all.size(), 0.0);
  RowEfforts result{none, none};
  const Model& model = simulation.model();
  const auto take = [&](int index, std::vector<double>& efforts) {
    const constraint::Constraint& constraint = model.constraint(index);
    const int row = constraint.first_row();
    std::copy_n(all.begin() + row, constraint.row_count(), efforts.begin() + row);
  };
  for (const ActuatorModel& actuator : model.actuators()) {
    take(actuator.constraint, result.actuation);
  }
  for (const ContactModel& contact : model.contacts()) take(contact.constraint, result.contact);
  return result;
}

}  // namespace sinew::sim
