#include <algorithm>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/core/error.hpp"
#include "sinew/high_rate/snapshot.hpp"
#include "sinew/law/response.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/query.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::high_rate {

namespace {

using law::ActuatorBlock;
using law::ContactBlock;
using law::StepProblem;

// Linearises and condenses the simulation at its present state; changes its state.
void condense(sim::Simulation& simulation, bool statics) {
  const model::Model& model = simulation.model();
  world::World& world = simulation.world();
  const auto weights =
      statics ? mechanics::StepWeights{}
              : mechanics::step_weights(model.step().integrator, model.step().time_step);
  const std::vector<int>& geometric = model.geometric_stiffness().all;
  world.begin_query(simulation.time());
  world.linearise({weights, mechanics::Tangent::exact, !geometric.empty(), false});
  world.form_rows(simulation.efforts(), geometric);
  if (world.condense() != linalg::FactorStatus::singular) return;
  throw Error(ErrorKind::singular_matrix, {.item = "take_snapshot()"},
              "the stiffness matrix is singular at this state",
              "fix a region of every body, or take dynamics into account (statics=False)");
}

// The most relevant contacts: those that carry a force, then the nearest ones.
std::vector<ContactBlock> nearest_contacts(const StepProblem& problem,
                                           std::span<const double> effort, int most) {
  std::vector<ContactBlock> found;
  for (const ContactBlock& block : problem.contacts) {
    if (problem.compliance(block.row, block.row) > 0.0) found.push_back(block);
  }
  const auto distance = [&](const ContactBlock& block) {
    const double force = effort[static_cast<std::size_t>(block.row)];
    return force > 0.0 ? -kInfinity : problem.delta[block.row];
  };
  std::ranges::stable_sort(found, {}, distance);
  if (found.size() > static_cast<std::size_t>(most)) found.resize(static_cast<std::size_t>(most));
  return found;
}

// Rows of the step's problem in the loop's order.
class RowList {
 public:
  RowList(const sim::Simulation& simulation, const SnapshotRows& names)
      : model_(simulation.model()) {
    add_actuators(names.driven);
    add_actuators(names.unknown);
    for (const std::string& name : names.effectors) {
      const auto& effector = model_.effector(model_.effector_index(name));
      for (int k = 0; k < effector.row_count(); ++k) rows_.push_back(effector.first_row() + k);
    }
    add_actuators(names.hands);
  }
  void add_contacts(std::span<const ContactBlock> contacts) {
    for (const ContactBlock& block : contacts) {
      for (int c = 0; c < 3; ++c) rows_.push_back(block.row + c);
    }
  }
  std::span<const int> rows() const { return rows_; }
  std::span<const int> actuators() const { return actuators_; }

 private:
  void add_actuators(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      const int index = model_.actuator_index(name);
      const model::ActuatorModel& actuator = model_.actuators()[static_cast<std::size_t>(index)];
      if (!actuator.controllable() || actuator.drive != nullptr) {
        throw Error(ErrorKind::wrong_actuator_type, {.item = "take_snapshot(): " + name},
                    "a drive decides its effort", "name cables, forces, torques and pressures");
      }
      if (std::ranges::find(actuators_, index) != actuators_.end()) {
        throw Error(ErrorKind::bad_argument, {.item = "take_snapshot(): " + name},
                    "it is named twice", "drive it, or take it for unknown, or for a hand's");
      }
      actuators_.push_back(index);
      rows_.push_back(actuator.row);  // in front of contacts' rows: the same in the problem
    }
  }

  const model::Model& model_;
  std::vector<int> rows_, actuators_;
};

// Marks the rows of the loop as owned, including those of contacts. Every other block keeps its
// state.
void own(StepProblem& problem, const sim::Simulation& simulation, std::span<const int> actuators,
         std::span<const ContactBlock> contacts) {
  const auto& models = simulation.model().actuators();
  for (std::size_t i = 0; i < models.size(); ++i) {
    ActuatorBlock& block = problem.actuators[i];
    const auto row = static_cast<std::size_t>(models[i].row);
    const bool told = block.row >= 0 && !simulation.actuator(static_cast<int>(i)).chosen;
    if (std::ranges::find(actuators, static_cast<int>(i)) != actuators.end()) {
      block = {};
      block.owned = true;
    } else if (!told) {
      block.hold_effort(simulation.efforts()[row]);
    }
    block.row = models[i].row;
  }
  problem.contacts.clear();
  for (const ContactBlock& contact : contacts) {
    for (int c = 0; c < 3; ++c) {
      ActuatorBlock& block = problem.actuators.emplace_back();
      block.row = contact.row + c;
      block.owned = true;
    }
  }
}

Snapshot read(const StepProblem& problem, const law::Response& response, std::span<const int> rows,
              std::span<const double> effort) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Snapshot snapshot;
  snapshot.compliance = MatrixX::Zero(count, count);
  snapshot.free.resize(count);
  snapshot.effort.resize(count);
  std::vector<Eigen::Index> column(static_cast<std::size_t>(problem.delta.size()), -1);
  for (std::size_t k = 0; k < response.controlled().size(); ++k) {
    const auto actuator = static_cast<std::size_t>(response.controlled()[k]);
    column[static_cast<std::size_t>(problem.actuators[actuator].row)] =
        static_cast<Eigen::Index>(k);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const int row = rows[static_cast<std::size_t>(i)];
    snapshot.free[i] = response.free()[row];
    snapshot.effort[i] = effort[static_cast<std::size_t>(row)];
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index from = column[static_cast<std::size_t>(rows[static_cast<std::size_t>(j)])];
      if (from >= 0) snapshot.compliance(i, j) = response.compliance()(row, from);
    }
  }
  return snapshot;
}

Snapshot take_here(sim::Simulation& simulation, const SnapshotRows& names, int max_contacts,
                   bool statics) {
  RowList list(simulation, names);
  condense(simulation, statics);
  const world::World& world = simulation.world();
  StepProblem problem = world.problem();
  linalg::AlignedNumbers effort;
  world.numbering().gather_efforts(simulation.efforts(), effort);
  const auto contacts = nearest_contacts(problem, effort, max_contacts);
  list.add_contacts(contacts);
  own(problem, simulation, list.actuators(), contacts);
  law::Response response;
  response.form(problem, effort);
  Snapshot snapshot = read(problem, response, list.rows(), effort);
  snapshot.time = simulation.time();
  snapshot.size = simulation.model().size();
  for (const ContactBlock& contact : contacts) snapshot.friction.push_back(contact.friction);
  return snapshot;
}

}  // namespace

Snapshot take_snapshot(sim::Simulation& simulation, const SnapshotRows& rows, int max_contacts,
                       bool statics) {
  return sim::query(simulation, [&](const run::State&) {
    return take_here(simulation, rows, max_contacts, statics);
  });
}

}  // namespace sinew::high_rate
