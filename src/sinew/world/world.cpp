#include "sinew/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/constraint/cable.hpp"
#include "sinew/contact/touching_surfaces.hpp"
#include "sinew/law/direct_solver.hpp"
#include "sinew/law/step_solver.hpp"
#include "sinew/model/model.hpp"
#include "sinew/world/end_efforts.hpp"
#include "sinew/world/stage_clock.hpp"
#include "sinew/world/standing_blocks.hpp"

namespace sinew::world {

namespace {

auto numbers(const linalg::AlignedNumbers& all) {
  return Eigen::Map<const VectorX, Eigen::AlignedMax>(all.data(),
                                                      static_cast<Eigen::Index>(all.size()));
}

}  // namespace

World::World(std::shared_ptr<const model::Model> model, ThreadPool& pool)
    : model_(std::move(model)),
      bodies_(*model_, pool),
      homotopy_(bodies_),
      configuration_(bodies_.all()),
      rows_(model_->rows()),
      joints_(*model_),
      problem_(standing_blocks(*model_, joints_.block_count())),
      contacts_(*model_, configuration_, bodies_.systems(), bodies_.afresh(), rows_, pool),
      stiffness_(*model_, configuration_, bodies_.systems(), problem_),
      end_efforts_(std::make_unique<EndEfforts>()) {
  number_rows();
  contacts_.planes().find_points(contacts_.reach(0.0), 0.0, {});
  place_contacts(0.0, 0.0);
}

World::~World() = default;

void World::place_contacts(double from, double to) {
  contacts_.planes().place(from, to);
  measure_delta();
  contacts_.planes().begin();
}

void World::begin_contacts(double from, double to, std::span<double> effort, double reach) {
  if (contacts_.empty()) return;
  const double far = std::max(reach, contacts_.wanted_reach(effort));
  contacts_.planes().find_points(contacts_.reach(far), contact::ContactRows::ahead(to - from),
                                 effort);
  choose_points(from, to, effort, reach);
}

void World::choose_points(double from, double to, std::span<double> effort, double reach) {
  place_contacts(from, to);
  contacts_.choose_active(effort, to - from, reach);
  number_rows();
  contacts_.spread_forces(effort);
}

void World::begin_step(double from, double to, std::span<double> effort, double reach) {
  begin_contacts(from, to, effort, reach);
  bodies_.begin_step();
}

void World::begin_at_rest(double at, std::span<double> effort) {
  for (const auto& surfaces : contacts_.planes().surfaces()) surfaces->begin_again();
  if (!contacts_.empty()) choose_points(at, at, effort, 0.0);
  bodies_.begin_step();
}

// The bases stay where they are. After restore(), their requested motions may be those of a later
// time.
void World::begin_query(double at, std::span<double> effort) {
  has_solved_ = false;
  begin_contacts(at, at, effort, 0.0);
  bodies_.begin_query();
}

void World::begin_query(double at) {
  has_solved_ = false;
  if (!contacts_.empty()) {
    place_contacts(at, at);
    contacts_.take_all();
    number_rows();
  }
  bodies_.begin_query();
}

void World::begin_event_query(double at, std::span<double> effort) {
  const double ahead = contact::ContactRows::ahead(model_->step().time_step);
  contacts_.planes().find_striking_points(contacts_.reach(0.0), ahead, effort);
  begin_query(at);
}

void World::take_closed_points() {
  contacts_.take_closed();
  number_rows();
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
  numbering_.gather_motions(measure_delta(), problem_.delta);
  for (std::size_t k = 0; k < problem_.capstans.size(); ++k) {
    const model::GuideModel& guide = model_->guides()[k];
    const double turn = model_->cable(guide.actuator)->turn(configuration_, guide.via);
    problem_.capstans[k].grip = -std::expm1(-guide.friction * turn);
  }
  bodies_.take_rows(rows_);
  stiffness_.choose(effort, geometric);
}

void World::hold_friction() {
  if (problem_.capstans.empty() && joints_.block_count() == 0) return;
  const VectorX& delta = measure_delta();
  for (law::CapstanBlock& block : problem_.capstans) block.held = delta[block.row];
  joints_.form_blocks(delta, std::span(problem_.actuators).subspan(model_->actuators().size()));
}

bool World::is_stable() const {
  if (inertia_.status == linalg::FactorStatus::singular) return false;
  const bool has_less = std::ranges::any_of(
      problem_.stiffness, [](const law::StiffnessBlock& block) { return block.stiffness < 0.0; });
  if (inertia_.status == linalg::FactorStatus::positive_definite && !has_less) return true;
  return inertia_.is_counted() && law::stabilised(problem_, inertia_.at_least());
}

bool World::brace(std::span<const double> effort) {
  if (inertia_.status == linalg::FactorStatus::singular || !inertia_.is_counted()) return false;
  numbering_.gather_efforts(effort, scratch_);
  return law::brace(problem_, scratch_, inertia_.at_least());
}

linalg::FactorStatus World::condense() {
  law::release_braces(problem_);
  stiffness_.add();
  inertia_ = bodies_.condense();
  if (inertia_.status != linalg::FactorStatus::singular) form_compliance();
  has_solved_ = true;
  return inertia_.status;
}

law::LawStatus World::solve_step(law::StepSolver& solver, law::Controller* controller,
                                 std::span<double> effort, StageClock& clock) {
  effort_before_.assign(effort.begin(), effort.end());
  return solve_laws(solver, controller, false, effort, clock);
}

law::LawStatus World::solve_step_again(law::StepSolver& solver, std::span<double> effort,
                                       StageClock& clock) {
  effort_before_.assign(effort.begin(), effort.end());
  renew_free_motion(effort_before_, true);
  clock.mark(Stage::correction);
  return solve_laws(solver, nullptr, true, effort, clock);
}

// The linearised rows at the present state x with the matrix A and W of an earlier one. With
// efforts lambda, a change to lambda' moves the bodies by
//   dq = A^-1 (b + H^T lambda'),   H dq = H A^-1 (b + H^T lambda) + W (lambda' - lambda),
// so delta_free = delta + H A^-1 (b + H^T lambda) - W lambda. W = H A^-1 H^T holds for the earlier
// H only, which changes the rate of convergence, not the limit lambda' = lambda.
void World::renew_free_motion(std::span<const double> effort, bool turned) {
  bodies_.renew(effort, turned);
  problem_.delta_free = problem_.delta;
  bodies_.add_row_motions(numbering_.problem_rows(), problem_.delta_free);
  numbering_.gather_efforts(effort, scratch_);
  problem_.delta_free.noalias() -= problem_.compliance * numbers(scratch_);
}

double World::correction(law::DirectSolver& solver, std::span<const double> effort) {
  held_free_ = problem_.delta_free;
  renew_free_motion(effort, false);
  const law::LawStatus status = solver.solve(problem_, scratch_);
  trial_.assign(effort.begin(), effort.end());
  numbering_.scatter_efforts(scratch_, trial_);
  bodies_.solve_motion(trial_);
  problem_.delta_free.swap(held_free_);
  const double move = bodies_.proposed_move();
  bodies_.residual(effort);  // bodies remember the efforts of their last residual
  return status == law::LawStatus::failed ? std::nan("") : move;
}

law::LawStatus World::solve_laws(law::StepSolver& solver, law::Controller* controller, bool again,
                                 std::span<double> effort, StageClock& clock) {
  // Each choice of a controller takes several solutions of the law. Most of the points that become
  // active between surfaces are also found at the efforts before the choice, with one solution per
  // round. The controller therefore chooses only when no more points are found there.
  contacts_.begin_solution();
  bool looks = controller != nullptr && contacts_.may_find_points();
  law::LawStatus status = law::LawStatus::solved;
  for (bool mended = true; mended;) {
    numbering_.gather_efforts(effort_before_, problem_.effort_before);
    numbering_.gather_efforts(effort, problem_effort_);
    status = solver.solve(problem_, looks ? nullptr : controller, problem_effort_);
    clock.mark(Stage::law);
    if (status == law::LawStatus::failed) return status;
    // Residuals of the laws are maxima, which skip what is not a number.
    const auto finite = [](double own) { return std::isfinite(own); };
    if (!std::ranges::all_of(problem_effort_, finite)) return law::LawStatus::failed;
    numbering_.scatter_efforts(problem_effort_, effort);
    bodies_.solve_motion(effort);
    clock.mark(Stage::correction);
    const bool found = correct_contacts(looks, clock);
    if (found && again) renew_free_motion(effort_before_, true);
    mended = found || looks;
    looks = looks && found;
  }
  for (const law::StiffnessBlock& block : problem_.stiffness) {
    effort[static_cast<std::size_t>(block.row)] = 0.0;  // part of no equilibrium
  }
  return status;
}

// All but the points between surfaces depends on the efforts that the controller will choose.
bool World::correct_contacts(bool looks, StageClock& clock) {
  const bool found =
      looks ? contacts_.find_points()
            : contacts_.are_guessed() && contacts_.correct(problem_, numbering_, problem_effort_);
  clock.mark(Stage::detection);
  if (!found) return false;
  number_rows();
  bodies_.retake_rows(rows_);
  form_compliance();
  clock.mark(Stage::factorisation);
  return true;
}

// Numbers the rows of the problem and lists its contacts; inactive points have neither.
void World::number_rows() {
  numbering_.number(rows_);
  problem_.contacts.clear();
  contacts_.list(numbering_, problem_.contacts);
  numbering_.gather_motions(rows_.delta, problem_.delta);
}

void World::form_compliance() {
  numbering_.gather_motions(rows_.delta, problem_.delta_free);
  problem_.compliance.setZero(problem_.delta_free.size(), problem_.delta_free.size());
  bodies_.add_compliance(numbering_.problem_rows(), problem_.compliance, problem_.delta_free);
}

void World::put_back(Solved solved) {
  problem_ = std::move(solved.problem);
  numbering_ = std::move(solved.numbering);
  rows_.delta = std::move(solved.delta);
  inertia_ = solved.inertia;
  has_solved_ = solved.is_present;
}

double World::violation(std::span<const double> effort, law::LawStatus law) {
  numbering_.gather_efforts(effort, scratch_);
  return std::max(law::violation(problem_, scratch_, law), contacts_.max_penetration_left_out());
}

void World::restart() {
  has_solved_ = false;
  joints_.restart();
  bodies_.restart();
  contacts_.planes().forget_points();
  contacts_.forget_friction();
  contacts_.planes().find_points(contacts_.reach(0.0), 0.0, {});
  place_contacts(0.0, 0.0);
}

std::size_t World::bytes() const {
  return sizeof(double) * static_cast<std::size_t>(problem_.compliance.size()) +
         rows_.direction.size() * sizeof(Vector3) + stiffness_.bytes() + bodies_.bytes();
}

}  // namespace sinew::world
