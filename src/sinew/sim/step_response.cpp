#include "sinew/sim/step_response.hpp"

#include "sinew/linalg/scratch.hpp"
#include "sinew/sim/row_numbering.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

// The blocks that form() reads are formed anew in each step.
StepResponse::StepResponse(Simulation& simulation, std::span<const int> controlled)
    : simulation_(simulation) {
  World& world = simulation.world();
  for (const int actuator : controlled) {
    world.problem().actuators[static_cast<std::size_t>(actuator)].owned = true;
  }
  linalg::AlignedNumbers effort;
  world.numbering().gather_efforts(simulation.efforts(), effort);
  response_.form(world.problem(), effort);
}

int StepResponse::row_of(int row) const {
  return simulation_.world().numbering().problem_row_of(row);
}

// Rows that are no contact's keep their order and stand together.
MatrixX StepResponse::motions(int first, int count) const {
  return response_.compliance().middleRows(row_of(first), count);
}

MatrixX StepResponse::effort(int row) const {
  Eigen::RowVectorXd slope =
      Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(response_.controlled().size()));
  double offset = 0.0;
  response_.add_effort(row_of(row), 1.0, offset, slope);
  return slope;
}

}  // namespace sinew::sim
