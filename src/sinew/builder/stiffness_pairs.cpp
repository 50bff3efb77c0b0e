#include "sinew/builder/stiffness_pairs.hpp"

#include <cstddef>
#include <memory>

#include "sinew/constraint/coupling.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

void add_couplings(model::ModelData& data) {
  for (std::size_t k = 0; k < data.stiffness_pairs.size(); ++k) {
    const auto& [first, second, hessian] = data.stiffness_pairs[k];
    if (first.body == second.body) continue;
    const int rows = data.declare(std::make_unique<constraint::Coupling>(first, second));
    data.couplings.push_back({static_cast<int>(k), rows});
  }
}

void list_geometric_stiffness(model::ModelData& data) {
  for (std::size_t i = 0; i < data.constraints.size(); ++i) {
    if (data.constraints[i]->stiffness_pair_count() == 0) continue;
    data.geometric_stiffness.all.push_back(static_cast<int>(i));
  }
  // Bodies that hang on cables have no other stiffness against swinging.
  if (data.loose && !data.step.dynamic()) {
    data.geometric_stiffness.in_steps = data.geometric_stiffness.all;
  }
  for (const int index : data.geometric_stiffness.in_steps) {
    const constraint::Constraint& constraint = data.constraint(index);
    for (int k = 0; k < constraint.stiffness_pair_count(); ++k) {
      const mechanics::StiffnessPair& pair =
          data.stiffness_pairs[static_cast<std::size_t>(constraint.first_stiffness_pair() + k)];
      if (pair.first.body != pair.second.body) continue;  // see add_couplings()
      data.geometric_stiffness.extends_pattern |=
          !data.body(pair.first.body).couples(pair.first.number, pair.second.number);
    }
  }
}

}  // namespace sinew::builder
