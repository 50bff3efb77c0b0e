#include "sinew/sim/row_efforts.hpp"

#include <algorithm>

#include "sinew/constraint/contact.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

RowEfforts split_efforts(const Simulation& simulation) {
  const std::span<const double> all = simulation.efforts();
  RowEfforts result{{all.begin(), all.end()}, std::vector<double>(all.size(), 0.0)};
  const Model& model = simulation.model();
  for (std::size_t c = 0; c < model.contacts().size(); ++c) {
    const constraint::Contact& contact = model.contact(static_cast<int>(c));
    const auto first = result.actuation.begin() + contact.first_row();
    std::copy_n(first, contact.row_count(), result.contact.begin() + contact.first_row());
    std::fill_n(first, contact.row_count(), 0.0);
  }
  return result;
}

}  // namespace sinew::sim
