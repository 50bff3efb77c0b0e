#include "sinew/sim/linearisation.hpp"

#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/core/error.hpp"
#include "sinew/law/followers.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/query.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

namespace {

std::string direction_name(const Vector3& direction, int index) {
  for (int axis = 0; axis < 3; ++axis) {
    if (direction == Vector3::Unit(axis)) return {'.', "xyz"[axis]};
  }
  return fmt::format("[{}]", index);
}

// Rows of the problem without those of joints.
struct FreeRows {
  std::vector<int> rows;
  law::Followers joints;  // efforts of the joints in response to the other rows
};

// Eliminates the rows of the joints.
FreeRows take_joints_out(const law::StepProblem& problem, bool counted, Linearisation& result) {
  std::vector<law::HeldRow> held;
  law::append_joints(problem, held);
  if (!held.empty() && counted) {
    const auto own = law::held_compliance(problem, held);
    const int negative = linalg::spectral_inverse(own.matrix).negative;
    result.negative_pivots = law::negative_directions(result.negative_pivots, negative, held);
  }
  FreeRows left;
  law::Followers& joints = left.joints;
  std::vector<char> is_joint(static_cast<std::size_t>(problem.delta.size()), 0);
  for (const law::HeldRow& row : held) {
    const double motion = row.compliance == 0.0 ? 0.0 : problem.delta[row.row];
    joints.add_held(row.row, motion, row.compliance);
    is_joint[static_cast<std::size_t>(row.row)] = 1;
  }
  for (const auto& block : problem.stiffness) is_joint[static_cast<std::size_t>(block.row)] = 1;
  std::vector<int>& others = left.rows;
  for (std::size_t row = 0; row < is_joint.size(); ++row) {
    if (is_joint[row] == 0) others.push_back(static_cast<int>(row));
  }
  const auto count = static_cast<Eigen::Index>(others.size());
  MatrixX compliance(count, count);
  VectorX free(count), delta(count), effort(count);
  joints.take_out(problem, problem.delta_free, others, compliance, free);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int row = others[static_cast<std::size_t>(k)];
    delta[k] = result.delta[row];
    effort[k] = result.effort[row];
  }
  result.compliance = std::move(compliance);
  result.delta = std::move(delta);
  result.delta_free = std::move(free);
  result.effort = std::move(effort);
  return left;
}

// Names of all rows; those that joints hold have empty names.
std::vector<std::string> all_names(const model::Model& model) {
  std::vector<std::string> names(static_cast<std::size_t>(model.rows().rows()));
  const auto name = [&](int row) -> std::string& { return names[static_cast<std::size_t>(row)]; };
  for (const auto& actuator : model.actuators()) name(actuator.row) = actuator.name;
  for (const auto& guide : model.guides()) {
    const auto& actuator = model.actuators()[static_cast<std::size_t>(guide.actuator)];
    name(guide.row) = fmt::format("{} point {}", actuator.name, guide.via + 1);
  }
  for (std::size_t i = 0; i < model.effectors().size(); ++i) {
    const auto& effector = model.effector(static_cast<int>(i));
    for (int k = 0; k < effector.row_count(); ++k) {
      name(effector.first_row() + k) =
          model.effectors()[i].name +
          direction_name(effector.directions()[static_cast<std::size_t>(k)], k);
    }
  }
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const constraint::Contact& contact = model.contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.size(); ++k) {
      constexpr const char* kAlong[] = {"normal", "tangent 1", "tangent 2"};
      for (int c = 0; c < 3; ++c) {
        name(contact.row(k) + c) =
            fmt::format("{} point {} {}", model.contacts()[i].name, k, kAlong[c]);
      }
    }
  }
  const auto name_motion = [&](int constraint, const char* suffix) {
    if (constraint < 0) return;
    const constraint::Constraint& motion = model.constraint(constraint);
    names[static_cast<std::size_t>(motion.first_row())] = motion.name() + suffix;
  };
  for (const model::JointModel& joint : model.joints()) {
    for (const int motion : joint.motions) name_motion(motion, "");
    name_motion(joint.brake, ".friction");
  }
  return names;
}

}  // namespace

std::vector<std::string> row_names(const model::Model& model, std::span<const int> rows) {
  const std::vector<std::string> all = all_names(model);
  std::vector<std::string> names;
  for (const int row : rows) names.push_back(all[static_cast<std::size_t>(row)]);
  return names;
}

std::vector<std::string> row_names(const model::Model& model) {
  std::vector<std::string> names = all_names(model);
  std::erase(names, "");
  return names;
}

namespace {

// Present delta and effort of the rows; W and delta_free from the world's problem.
// @param effort (rows,) N.
FreeRows gather(Simulation& simulation, std::span<const double> effort, Linearisation& result) {
  const model::Model& model = simulation.model();
  world::World& world = simulation.world();
  const law::StepProblem& problem = world.problem();
  result.compliance = problem.compliance;
  result.delta_free = problem.delta_free;
  const contact::RowNumbering& numbering = world.numbering();
  const std::vector<std::string> names = all_names(model);
  const auto count = result.delta_free.size();
  numbering.gather_motions(world.delta(), result.delta);
  linalg::AlignedNumbers own;
  numbering.gather_efforts(effort, own);
  result.effort = Eigen::Map<const VectorX, Eigen::AlignedMax>(own.data(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto row = static_cast<std::size_t>(numbering.model_row_of(static_cast<int>(k)));
    if (!names[row].empty()) result.rows.push_back(names[row]);
  }
  result.negative_pivots = world.inertia().at_least();
  if (!problem.bilaterals.empty() || !problem.stiffness.empty()) {
    return take_joints_out(problem, world.inertia().is_counted(), result);
  }
  FreeRows all;
  all.rows.resize(static_cast<std::size_t>(count));
  std::iota(all.rows.begin(), all.rows.end(), 0);
  return all;
}

// A unit effort of one row, and the joint efforts that it causes.
void unit_effort(const world::World& world, FreeRows& free, int row, std::vector<double>& effort) {
  const law::StepProblem& problem = world.problem();
  const auto rows = static_cast<std::size_t>(problem.delta_free.size());
  linalg::AlignedNumbers own(rows, 0.0);
  own[static_cast<std::size_t>(row)] = 1.0;
  const VectorX none = VectorX::Zero(problem.delta_free.size());
  free.joints.close(problem, none, free.rows, own);
  world.numbering().scatter_efforts(own, effort);
}

// Sets the targets of the joints to zero, so their efforts are linear in those of the other rows.
void forget_motions(const world::World& world, FreeRows& free) {
  const law::StepProblem& problem = world.problem();
  std::vector<law::HeldRow> held;
  law::append_joints(problem, held);
  free.joints.clear();
  for (const law::HeldRow& row : held) free.joints.add_held(row.row, 0.0, row.compliance);
  const auto count = static_cast<Eigen::Index>(free.rows.size());
  MatrixX compliance(count, count);
  VectorX motion(count);
  free.joints.take_out(problem, VectorX::Zero(problem.delta_free.size()), free.rows, compliance,
                       motion);
}

void find_fields(world::World& world, FreeRows& free, Linearisation& result) {
  world::Bodies& bodies = world.bodies();
  forget_motions(world, free);
  std::vector<double> effort(static_cast<std::size_t>(world.delta().size()), 0.0);
  VectorX without(static_cast<Eigen::Index>(bodies.size()));
  bodies.imbalance(effort, without);
  VectorX force(without.size()), motion(without.size());
  result.fields.resize(bodies.all().size());
  for (const int row : free.rows) {
    unit_effort(world, free, row, effort);
    bodies.imbalance(effort, force);
    force -= without;
    bodies.solve(force, motion);
    bodies.propose_motion(motion);
    for (std::size_t b = 0; b < result.fields.size(); ++b) {
      const mechanics::Body& body = *bodies.all()[b];
      if (mechanics::as<const mechanics::TakesForces>(body) == nullptr) continue;
      Points nodes = Points::Zero(body.positions().rows(), 3);
      body.system().add_proposed_motion(nodes);
      result.fields[b].push_back(std::move(nodes));
    }
  }
}

// Does not restore the simulation's state.
Linearisation linearise_here(Simulation& simulation, const LinearisationChoice& choice) {
  const model::Model& model = simulation.model();
  const std::vector<int> geometric =
      choice.geometric_stiffness ? model.geometric_stiffness().all : std::vector<int>{};
  const auto weights =
      choice.of_statics ? mechanics::StepWeights{}
                        : mechanics::step_weights(model.step().integrator, model.step().time_step);
  world::World& world = simulation.world();
  std::vector<double> effort(simulation.efforts().begin(), simulation.efforts().end());
  if (choice.every_point) {
    world.begin_query(simulation.time());
  } else {
    world.begin_query(simulation.time(), effort);
  }
  world.linearise({weights, choice.tangent, !geometric.empty(), false});
  world.form_rows(effort, geometric);
  Linearisation result;
  result.residual = world.bodies().residual(effort);
  if (world.condense() == linalg::FactorStatus::singular) {
    throw Error(ErrorKind::singular_matrix, {.item = "linearise()"},
                "the stiffness matrix is singular at this state",
                "fix a region of every body, or try tangent='corotated'");
  }
  FreeRows free = gather(simulation, effort, result);
  if (choice.fields) find_fields(world, free, result);
  return result;
}

}  // namespace

Linearisation linearise(Simulation& simulation, const LinearisationChoice& choice) {
  return query(simulation, [&](const run::State&) { return linearise_here(simulation, choice); });
}

Linearisation last_linearisation(Simulation& simulation) {
  if (!simulation.world().has_solved()) {
    throw Error(ErrorKind::bad_argument, {.item = "last_linearisation()"},
                "no step led to this state: none was made since it was built, restored or reset, "
                "the last one failed, or event-driven integration ended it with a look at contacts",
                "call it after step() or solve_static(), or linearise() at any time");
  }
  Linearisation result;
  result.residual = std::numeric_limits<double>::quiet_NaN();
  gather(simulation, simulation.efforts(), result);
  return result;
}

}  // namespace sinew::sim
