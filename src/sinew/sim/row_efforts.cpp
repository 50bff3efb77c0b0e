#include "sinew/sim/row_efforts.hpp"

#include <algorithm>

#include "sinew/constraint/constraint.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/end_efforts.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

double end_effort(const Simulation& simulation, int row) {
  return simulation.world().end_efforts().at_end(simulation.efforts(), row);
}

std::vector<double> end_efforts(const Simulation& simulation) {
  std::vector<double> all(simulation.efforts().size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = end_effort(simulation, static_cast<int>(k));
  return all;
}

RowEfforts split_efforts(const Simulation& simulation) {
  const std::vector<double> all = end_efforts(simulation);
  const std::vector<double> none(all.size(), 0.0);
  RowEfforts result{none, none};
  const model::Model& model = simulation.model();
  const auto take = [&](int index, std::vector<double>& efforts) {
    const constraint::Constraint& constraint = model.constraint(index);
    const int row = constraint.first_row();
    std::copy_n(all.begin() + row, constraint.row_count(), efforts.begin() + row);
  };
  for (const model::ActuatorModel& actuator : model.actuators()) {
    take(actuator.constraint, result.actuation);
  }
  for (const model::ContactModel& contact : model.contacts())
    take(contact.constraint, result.contact);
  return result;
}

}  // namespace sinew::sim
