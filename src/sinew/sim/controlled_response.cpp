#include "sinew/sim/controlled_response.hpp"

#include <algorithm>
#include <vector>

#include "sinew/constraint/effector.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/law/response.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/actuation.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/query.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

namespace {

// Present commands of all actuators, without rate limits; the controlled ones are marked as owned.
void write_blocks(Simulation& simulation, const run::State& state,
                  std::span<const int> controlled) {
  const model::Model& model = simulation.model();
  run::Actuation actuation(model);
  actuation.load(state);
  actuation.set_commands(simulation.inputs().commands);
  actuation.own(&actuation, controlled);
  auto& blocks = simulation.world().problem().actuators;
  actuation.form_blocks(simulation.time(), kInfinity,
                        std::span(blocks).first(model.actuators().size()));
}

// Open contact points have no effort and do not take part. @param effort (rows,) N, in and out.
void condense(Simulation& simulation, const LinearisationChoice& choice,
              std::vector<double>& effort) {
  const model::Model& model = simulation.model();
  const std::vector<int> geometric =
      choice.geometric_stiffness ? model.geometric_stiffness().all : std::vector<int>{};
  const auto weights =
      choice.of_statics ? mechanics::StepWeights{}
                        : mechanics::step_weights(model.step().integrator, model.step().time_step);
  world::World& world = simulation.world();
  world.begin_query(simulation.time(), effort);
  world.linearise({weights, choice.tangent, !geometric.empty(), false});
  world.form_rows(effort, geometric);
  if (world.condense() != linalg::FactorStatus::singular) return;
  throw Error(ErrorKind::singular_matrix, {.item = "response()"},
              "the stiffness matrix is singular at this state: without inertia, something moves "
              "freely",
              "fix a region of every body, brace a link that swings freely about its joint by a "
              "spring or a motor that is told an angle, or try tangent='corotated'");
}

// Does not restore the simulation's state.
ControlledResponse respond(Simulation& simulation, const run::State& state,
                           std::span<const int> controlled, const LinearisationChoice& choice) {
  const model::Model& model = simulation.model();
  world::World& world = simulation.world();
  std::vector<double> all(simulation.efforts().begin(), simulation.efforts().end());
  condense(simulation, choice, all);
  write_blocks(simulation, state, controlled);
  world.hold_friction();
  linalg::AlignedNumbers effort;
  world.numbering().gather_efforts(all, effort);
  law::Response response;
  response.form(world.problem(), effort);

  // The response contains the controlled rows in the order of the actuators.
  std::vector<int> columns, own;
  for (const int actuator : controlled) {
    const auto place = std::ranges::lower_bound(response.controlled(), actuator);
    columns.push_back(static_cast<int>(place - response.controlled().begin()));
    own.push_back(model.actuators()[static_cast<std::size_t>(actuator)].row);
  }
  ControlledResponse result;
  for (std::size_t i = 0; i < model.effectors().size(); ++i) {
    const constraint::Effector& effector = model.effector(static_cast<int>(i));
    const int first = world.numbering().problem_row_of(effector.first_row());
    result.effectors.emplace_back(
        response.compliance()(Eigen::seqN(first, effector.row_count()), columns));
  }
  result.actuators = response.compliance()(own, columns);
  return result;
}

}  // namespace

ControlledResponse controlled_response(Simulation& simulation, std::span<const int> controlled,
                                       const LinearisationChoice& choice) {
  return query(simulation, [&](const run::State& state) {
    return respond(simulation, state, controlled, choice);
  });
}

}  // namespace sinew::sim
