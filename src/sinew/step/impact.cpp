#include "sinew/step/impact.hpp"

#include <algorithm>
#include <utility>

#include "sinew/constraint/contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/step_failure.hpp"
#include "sinew/world/row_motions.hpp"

namespace sinew::step {

namespace {

// Time step in which only inertia matters: for a mesh whose fastest mode has w = 1e7 rad/s, the
// stiffness is (w t)^2 = 1e-10 of M/t^2.
constexpr double kInstant = 1e-12;
// Gain of energy beyond rounding, relative to |p.u-|.
constexpr double kGain = 1e-9;

// A = M/t^2.
mechanics::StepWeights weights_of_inertia() {
  mechanics::StepWeights weights;
  weights.velocity = {.velocity = 1.0};
  weights.acceleration = {.motion = 1.0 / (kInstant * kInstant)};
  weights.time_step = kInstant;
  return weights;
}

}  // namespace

void Impact::hold(std::span<const HeldRate> commanded, double length) {
  run_.world.bodies().begin_query();
  form();
  for (const HeldRate& held : commanded) command(held);
  motors_end_ = law_.bilaterals.size();
  for (const law::ContactBlock& block : law_.contacts) {
    const int row = run_.world.numbering().model_row_of(block.row);
    const bool pressed = run_.effort[static_cast<std::size_t>(row)] > 0.0;
    if (pressed) law_.bilaterals.push_back({block.row, 0.0, 1.0});
  }
  std::vector<law::ContactBlock> contacts = std::move(law_.contacts);
  law_.contacts.clear();
  find_impulses({}, 0.0);
  law_.contacts = std::move(contacts);
  add_to_efforts(length);
  apply();
}

void Impact::command(const HeldRate& held) {
  const int row = run_.world.numbering().problem_row_of(held.row);
  const auto motors = std::span(law_.bilaterals).subspan(joints_);
  const auto found = std::ranges::find(motors, row, &law::BilateralBlock::row);
  if (found != motors.end()) {
    found->motion = held.rate;
    return;
  }
  before_[row] = world::row_velocity(run_.world, held.row);
  law_.bilaterals.push_back({row, held.rate, held.motion_scale});
}

void Impact::add_to_efforts(double length) {
  for (const law::BilateralBlock& block : std::span(law_.bilaterals).first(motors_end_)) {
    const int row = run_.world.numbering().model_row_of(block.row);
    run_.effort[static_cast<std::size_t>(row)] +=
        impulse_[static_cast<std::size_t>(block.row)] / length;
  }
}

// J: of actuators that hold a motion.
double Impact::work_of_motors() const {
  double sum = 0.0;
  for (std::size_t k = joints_; k < motors_end_; ++k) {
    const int row = law_.bilaterals[k].row;
    sum += 0.5 * impulse_[static_cast<std::size_t>(row)] * (before_[row] + after_[row]);
  }
  return sum;
}

// Different coefficients may increase the energy (Kane's paradox). The smallest one for all points
// reduces the gain, and zero restitution removes it.
void Impact::solve(std::span<const double> restitution) {
  form();
  for (const double max_restitution : {1.0, smallest(restitution), 0.0}) {
    find_impulses(restitution, max_restitution);
    const Eigen::Map<const VectorX> p(impulse_.data(), before_.size());
    if (gained_ <= kGain * std::abs(p.dot(before_))) break;
  }
  apply();
}

void Impact::form() {
  world::World& world = run_.world;
  world.take_closed_points();
  mechanics::LinearisationRequest request = run_.request(kInstant);
  request.weights = weights_of_inertia();
  request.iterating = false;
  world.linearise(request);
  world.form_rows(run_.effort, {});
  if (world.condense() == linalg::FactorStatus::singular) {
    statics::fail(run_, ErrorKind::singular_matrix, "the mass matrix is singular",
                  "give all bodies mass");
  }
  const law::StepProblem& problem = world.problem();
  law_.compliance = problem.compliance / (kInstant * kInstant);
  law_.size = problem.size;
  law_.contacts = problem.contacts;
  law_.bilaterals = problem.bilaterals;
  before_.setZero(law_.compliance.rows());
  const auto measure = [&](int row) {
    return before_[row] = world::row_velocity(world, world.numbering().model_row_of(row));
  };
  for (law::BilateralBlock& block : law_.bilaterals) {
    measure(block.row);
    block.motion = 0.0;
  }
  joints_ = law_.bilaterals.size();
  for (const law::ActuatorBlock& block : problem.actuators) {
    if (block.row < 0 || !block.holds_motion()) continue;
    law_.bilaterals.push_back({block.row, measure(block.row), block.motion_scale});
  }
  motors_end_ = law_.bilaterals.size();
  for (const law::ContactBlock& block : law_.contacts) {
    before_.segment<3>(block.row) = world::contact_velocity(world, block.contact, point_of(block));
  }
}

std::size_t Impact::point_of(const law::ContactBlock& block) const {
  const int row = run_.world.numbering().model_row_of(block.row);
  return static_cast<std::size_t>(row - run_.model->contact(block.contact).first_row()) / 3;
}

// J: work of surfaces of the world with prescribed motion.
double Impact::outside() const {
  const contact::ContactPlanes& planes = run_.world.contacts().planes();
  double sum = 0.0;
  for (const law::ContactBlock& block : law_.contacts) {
    const Eigen::Map<const Vector3> impulse(&impulse_[static_cast<std::size_t>(block.row)]);
    const constraint::Contact& contact = run_.model->contact(block.contact);
    sum += (block.frame * impulse).dot(planes.surface_velocity(contact, point_of(block)));
  }
  return sum;
}

double Impact::smallest(std::span<const double> restitution) const {
  double least = 1.0;
  for (const law::ContactBlock& block : law_.contacts) {
    if (!(before_[block.row] < 0.0)) continue;
    const int row = run_.world.numbering().model_row_of(block.row);
    least = std::min(least, restitution[static_cast<std::size_t>(row)]);
  }
  return least;
}

void Impact::find_impulses(std::span<const double> restitution, double max_restitution) {
  law_.delta_free = before_;
  for (const law::ContactBlock& block : law_.contacts) {
    if (!(before_[block.row] < 0.0)) continue;
    const int row = run_.world.numbering().model_row_of(block.row);
    const double e = std::min(max_restitution, restitution[static_cast<std::size_t>(row)]);
    law_.delta_free.segment<3>(block.row) *= 1.0 + e;
  }
  impulse_.assign(static_cast<std::size_t>(before_.size()), 0.0);
  solver_.begin_step();
  if (solver_.solve(law_, impulse_) == law::LawStatus::failed) {
    statics::fail(run_, ErrorKind::not_converged, "no impulses obey the law of an impact",
                  "look for a body that is squeezed between others, or choose bdf2");
  }
  const Eigen::Map<const VectorX> p(impulse_.data(), before_.size());
  after_ = before_;
  after_.noalias() += law_.compliance * p;
  gained_ = 0.5 * p.dot(before_ + after_);
}

void Impact::apply() {
  world::Bodies& bodies = run_.world.bodies();
  all_.assign(run_.effort.size(), 0.0);
  bodies.imbalance(all_, rest_);
  run_.world.numbering().scatter_efforts(impulse_, all_);
  bodies.imbalance(all_, force_);
  force_ -= rest_;
  bodies.solve(force_, change_);
  change_ /= kInstant * kInstant;
  bodies.add_velocity(change_);
  bodies.residual(run_.effort);  // bodies store the efforts
  run_.world.forget_solved();
  const double driven = work_of_motors();
  run_.ledger.count_impact(driven - gained_, outside());
  run::EnergyLedger sums = run_.ledger.sums();
  sums.actuators += driven;
  run_.ledger.set(sums);
}

}  // namespace sinew::step
