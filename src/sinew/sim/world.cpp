#include "sinew/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/stage_clock.hpp"
#include "sinew/step/step_solver.hpp"

namespace sinew::sim {

namespace {

mechanics::RowValues rows_of(const Model& model) {
  mechanics::RowValues rows;
  rows.resize(model.rows());
  return rows;
}

// With the blocks that stay for all steps, but for those of stiffness.
step::StepProblem problem_of(const Model& model) {
  step::StepProblem problem;
  problem.size = model.size();
  for (const GuideModel& guide : model.guides()) {
    problem.capstans.push_back({guide.row, guide.actuator, 0.0, 0.0});
  }
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const constraint::Constraint& held = model.constraint(model.joints()[j].constraint);
    const constraint::Joint* joint = model.joint(static_cast<int>(j));
    for (int row = held.first_row(); row < held.first_row() + held.row_count(); ++row) {
      const bool turn = joint != nullptr && joint->is_turn(row);
      problem.bilaterals.push_back({row, 0.0, turn ? model.size() : 1.0});
    }
  }
  return problem;
}

}  // namespace

World::World(std::shared_ptr<const Model> model, ThreadPool& pool)
    : model_(std::move(model)),
      bodies_(*model_, pool),
      configuration_(bodies_.all()),
      rows_(rows_of(*model_)),
      problem_(problem_of(*model_)),
      joints_(*model_),
      contacts_(*model_, configuration_, bodies_.systems(), rows_, pool),
      stiffness_(*model_, configuration_, bodies_.systems(), problem_) {
  problem_.actuators.resize(model_->actuators().size() + joints_.block_count());
  number_rows();
  contacts_.planes().find_points(contacts_.reach(0.0, 0.0), {});
  place_contacts(0.0, 0.0);
}

void World::place_contacts(double from, double to) {
  contacts_.planes().place(from, to);
  measure_delta();
  contacts_.planes().begin();
}

void World::begin_step(double from, double to, std::span<double> effort, double reach) {
  if (!contacts_.empty()) {
    contacts_.planes().find_points(contacts_.reach(to - from, reach), effort);
    place_contacts(from, to);
    contacts_.choose_active(effort, to - from, reach);
    number_rows();
  }
  bodies_.begin_step();
}

void World::begin_query(double at) {
  if (!contacts_.empty()) {
    place_contacts(at, at);
    contacts_.take_all();
    number_rows();
  }
  bodies_.begin_query();
}

void World::take_closed_points() {
  contacts_.take_closed();
  number_rows();
}

double World::row_velocity(int row) const {
  const mechanics::RowPattern& pattern = model_->rows();
  const auto first = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(row)]);
  const auto end = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(row) + 1]);
  double rate = 0.0;
  for (std::size_t e = first; e < end; ++e) {
    rate += rows_.direction[e].dot(configuration_.velocity(pattern.site[e]));
  }
  return rate;
}

void World::linearise(const mechanics::LinearisationRequest& request) {
  stiffness_.begin(request);
  bodies_.linearise(request);
}

const VectorX& World::measure_delta() {
  for (const auto& constraint : model_->constraints()) constraint.linearise(configuration_, rows_);
  joints_.unwrap(rows_.delta);
  return rows_.delta;
}

void World::form_rows(std::span<const double> effort, std::span<const int> geometric) {
  numbering_.gather(measure_delta(), problem_.delta);
  for (std::size_t k = 0; k < problem_.capstans.size(); ++k) {
    const GuideModel& guide = model_->guides()[k];
    const double turn = model_->cable(guide.actuator)->turn(configuration_, guide.via);
    problem_.capstans[k].grip = -std::expm1(-guide.friction * turn);
  }
  bodies_.take_rows(rows_);
  stiffness_.choose(effort, geometric);
}

MatrixX World::row_forces(std::span<const int> rows) {
  std::vector<double> unit(numbering_.problem_rows().size(), 0.0);
  VectorX rest, row;
  bodies_.imbalance(unit, rest);
  MatrixX result(rest.size(), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    double& own = unit[static_cast<std::size_t>(numbering_.model_row_of(rows[k]))];
    own = 1.0;
    bodies_.imbalance(unit, row);
    own = 0.0;
    result.col(static_cast<Eigen::Index>(k)) = row - rest;
  }
  return result;
}

void World::hold_friction() {
  if (problem_.capstans.empty() && joints_.block_count() == 0) return;
  const VectorX& delta = measure_delta();
  for (step::CapstanBlock& block : problem_.capstans) block.held = delta[block.row];
  joints_.form_blocks(delta, std::span(problem_.actuators).subspan(model_->actuators().size()));
}

void World::keep_homotopy_residual(std::span<const double> effort) {
  bodies_.imbalance(effort, homotopy_residual_);
}

void World::set_homotopy_fraction(double fraction) {
  if (fraction == 0.0) return bodies_.lessen({});
  lessened_ = fraction * homotopy_residual_;
  bodies_.lessen({lessened_.data(), static_cast<std::size_t>(lessened_.size())});
}

bool World::is_stable() const {
  if (inertia_.status == linalg::FactorStatus::singular) return false;
  const bool has_less = std::ranges::any_of(
      problem_.stiffness, [](const step::StiffnessBlock& block) { return block.stiffness < 0.0; });
  if (inertia_.status == linalg::FactorStatus::positive_definite && !has_less) return true;
  return step::stabilised(problem_, inertia_.negative_pivots);
}

linalg::FactorStatus World::condense() {
  stiffness_.add();
  inertia_ = bodies_.condense();
  if (inertia_.status != linalg::FactorStatus::singular) form_compliance();
  return inertia_.status;
}

step::LawStatus World::solve_step(step::StepSolver& solver, step::Controller* controller,
                                  std::span<double> effort, StageClock& clock) {
  effort_before_.assign(effort.begin(), effort.end());
  step::LawStatus status = step::LawStatus::solved;
  bool mended = true;
  while (mended) {
    numbering_.gather(effort_before_, problem_.effort_before);
    numbering_.gather(effort, problem_effort_);
    status = solver.solve(problem_, controller, problem_effort_);
    clock.mark(Stage::law);
    if (status == step::LawStatus::failed) return status;
    numbering_.scatter(problem_effort_, effort);
    bodies_.solve_motion(effort);
    mended = contacts_.are_guessed() && correct_contacts();
    clock.mark(Stage::correction);
  }
  for (const step::StiffnessBlock& block : problem_.stiffness) {
    effort[static_cast<std::size_t>(block.row)] = 0.0;  // part of no equilibrium
  }
  return status;
}

bool World::correct_contacts() {
  if (!contacts_.correct(problem_, numbering_, problem_effort_)) return false;
  number_rows();
  bodies_.retake_rows(rows_);
  form_compliance();
  return true;
}

// The problem's rows and its contacts: points that are left out have none.
void World::number_rows() {
  numbering_.number(rows_.active);
  problem_.contacts.clear();
  contacts_.list(numbering_, problem_.contacts);
  numbering_.gather(rows_.delta, problem_.delta);
}

void World::form_compliance() {
  numbering_.gather(rows_.delta, problem_.delta_free);
  problem_.compliance.setZero(problem_.delta_free.size(), problem_.delta_free.size());
  bodies_.add_compliance(numbering_.problem_rows(), problem_.compliance, problem_.delta_free);
}

double World::violation(std::span<const double> effort, step::LawStatus law) {
  numbering_.gather(effort, scratch_);
  return std::max(step::violation(problem_, scratch_, law), contacts_.max_penetration_left_out());
}

void World::restart() {
  joints_.restart();
  bodies_.restart();
  contacts_.planes().forget_points();
  contacts_.planes().find_points(contacts_.reach(0.0, 0.0), {});
  place_contacts(0.0, 0.0);
}

std::size_t World::bytes() const {
  return sizeof(double) * static_cast<std::size_t>(problem_.compliance.size()) +
         rows_.direction.size() * sizeof(Vector3) + stiffness_.bytes() + bodies_.bytes();
}

}  // namespace sinew::sim
