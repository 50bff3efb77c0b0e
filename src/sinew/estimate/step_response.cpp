#include "sinew/estimate/step_response.hpp"

#include <algorithm>

#include "sinew/contact/row_numbering.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::estimate {

// The blocks that form() reads are rewritten in each step.
StepResponse::StepResponse(sim::Simulation& simulation, std::span<const int> controlled)
    : simulation_(simulation) {
  world::World& world = simulation.world();
  for (const int actuator : controlled) {
    const auto at = static_cast<std::size_t>(actuator);
    world.problem().actuators[at].owned = true;
    rows_.push_back(simulation.model().actuators()[at].row);
    columns_.push_back(std::ranges::count_if(controlled, [&](int one) { return one < actuator; }));
  }
  linalg::AlignedNumbers effort;
  world.numbering().gather_efforts(simulation.efforts(), effort);
  response_.form(world.problem(), effort);
}

int StepResponse::row_of(int row) const {
  return simulation_.world().numbering().problem_row_of(row);
}

// Rows that are not contacts' keep their order and are contiguous.
MatrixX StepResponse::motions(int first, int count) const {
  return response_.compliance().middleRows(row_of(first), count)(Eigen::all, columns_);
}

MatrixX StepResponse::effort(int row) const {
  const auto count = static_cast<Eigen::Index>(columns_.size());
  const auto own = std::ranges::find(rows_, row);
  if (own != rows_.end()) return MatrixX::Identity(count, count).row(own - rows_.begin());
  Eigen::RowVectorXd slope = Eigen::RowVectorXd::Zero(count);
  double offset = 0.0;
  response_.add_effort(row_of(row), 1.0, offset, slope);
  return slope(columns_);
}

}  // namespace sinew::estimate
