#include "sinew/step/midpoint.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "sinew/constraint/surface_contact.hpp"
#include "sinew/contact/touching_surfaces.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/run/run.hpp"
#include "sinew/step/substep.hpp"
#include "sinew/world/row_motions.hpp"

namespace sinew::step {

namespace {

// Tolerance on held motions at the end of a step, relative to the robot's size, and what may be
// left where rounds do not reach it.
constexpr double kHeld = 1e-12, kDrift = 1e-8;
// Smaller deviations of a motion from its command, relative to the robot's size, are rounding.
constexpr double kOnCommand = 1e-9;
// s: a corner this close to the end of a part is there.
constexpr double kCorner = 1e-9;
// Each round reduces the error to about the square of the step's rotation.
constexpr int kMaxRounds = 12;
// Updates of the points at the midpoint. Another update would change them by terms of order h^4.
constexpr int kTurns = 2;

// Carries friction from one contact frame to another along the smallest rotation between their
// normals. So its magnitude and its ratio to the normal force, which distinguishes sliding from
// sticking, are unchanged.
void carry_friction(const Matrix3& from, const Matrix3& to, Eigen::Ref<Eigen::Vector2d> friction) {
  const auto turn = Eigen::Quaterniond::FromTwoVectors(from.col(0), to.col(0));
  const Vector3 force = from.rightCols<2>() * friction;
  friction = to.rightCols<2>().transpose() * (turn * force);
}

}  // namespace

Midpoint::Midpoint(run::Run& run)
    : run_(run), widened_(run.effort.size(), 0.0), turned_(run.effort.size(), 0) {}

bool Midpoint::is_held(std::size_t actuator) const {
  const law::ActuatorBlock& block = run_.world.problem().actuators[actuator];
  const double effort = run_.effort[static_cast<std::size_t>(block.row)];
  return block.effort_min < effort && effort < block.effort_max;
}

bool Midpoint::has_few_coordinates(int row) const {
  const mechanics::RowPattern& rows = run_.model->rows();
  const auto own = static_cast<std::size_t>(row);
  for (auto e = rows.row_start[own]; e < rows.row_start[own + 1]; ++e) {
    const mechanics::Site& site = rows.site[static_cast<std::size_t>(e)];
    if (site.body >= 0 && !run_.model->body(site.body).has_few_coordinates()) return false;
  }
  return true;
}

bool Midpoint::take_commands(double begin, double length) {
  commanded_.clear();
  const std::vector<law::ActuatorBlock>& blocks = run_.world.problem().actuators;
  const std::size_t own = run_.actuation.states().size();
  bool smooth = true;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].row < 0 || blocks[i].kind != law::CommandKind::motion) continue;
    // Those after the actuators are friction of joints.
    smooth = i < own && take_command(i, begin, length) && smooth;
  }
  return smooth;
}

// A motion that is limited, that has a corner in the part, or that a script sets anew for every
// step is no smooth function of time.
bool Midpoint::take_command(std::size_t actuator, double begin, double length) {
  const law::ActuatorBlock& block = run_.world.problem().actuators[actuator];
  const model::ActuatorState& state = run_.actuation.states()[actuator];
  if (block.owned || block.drive != nullptr || !has_few_coordinates(block.row)) return false;
  const model::Signal& signal = state.command.signal;
  const double end = begin + length, still = kOnCommand * run_.model->size() / block.motion_scale;
  const bool by_rate = state.command.kind == law::CommandKind::input;
  const double first =
      by_rate ? signal.value(begin) : signal.rate(begin, model::Signal::Side::after);
  const double last = by_rate ? signal.value(end) : signal.rate(end, model::Signal::Side::before);
  const double start = by_rate ? block.value - length * last : signal.value(begin);
  const double goal = by_rate ? block.value : signal.value(end);
  const bool varies = by_rate && first != last;
  if (varies || signal.next_corner(begin) < end - kCorner ||
      std::abs(start - state.motion) > still || std::abs(goal - block.value) > still) {
    return false;
  }
  commanded_.push_back({actuator, goal, last});
  const double off = length * (world::row_velocity(run_.world, block.row) - first);
  return is_held(actuator) && std::abs(off) <= still;
}

void Midpoint::aim_at_middle() {
  for (const Commanded& own : commanded_) {
    const double start = run_.actuation.states()[own.actuator].motion;
    run_.world.problem().actuators[own.actuator].value = 0.5 * (start + own.goal);
  }
}

bool Midpoint::keeps_commands() const {
  return std::ranges::all_of(commanded_, [&](auto& own) { return is_held(own.actuator); });
}

std::span<const HeldRate> Midpoint::held_rates() {
  held_rates_.clear();
  for (const Commanded& own : commanded_) {
    const law::ActuatorBlock& block = run_.world.problem().actuators[own.actuator];
    if (is_held(own.actuator)) held_rates_.push_back({block.row, own.rate, block.motion_scale});
  }
  return held_rates_;
}

void Midpoint::solve(Substep& substep, double half) {
  std::ranges::fill(widened_, 0.0);  // where an earlier part ended with an error
  std::ranges::fill(turned_, 0);
  substep.solve(half);
  for (int turn = 0; turn < kTurns && turn_points(); ++turn) substep.solve(half);
}

bool Midpoint::carry_on(Substep& substep, double half) {
  world::Bodies& bodies = run_.world.bodies();
  const double middle = run_.now, size = run_.model->size();
  double off = 0.0;
  bodies.scale_motion(2.0);
  contact::ContactPlanes& planes = run_.world.contacts().planes();
  planes.set_halved(false);
  place(middle + half);
  for (int round = 0; (off = correct()) > kHeld * size && round < kMaxRounds; ++round) {
    place(middle);
    bodies.scale_motion(0.5);
    planes.set_halved(true);
    substep.solve(half);
    bodies.scale_motion(2.0);
    planes.set_halved(false);
    place(middle + half);
  }
  measure_false_work();
  release();
  return off <= kDrift * size;
}

// Updates closed points to the surface points and normals at the present positions of the bodies;
// the start of the step is unchanged. Includes points without a force, since a turning surface may
// come to press on them. Efforts refer to the frames of the points, so friction is carried along.
// Returns whether any point changed.
bool Midpoint::turn_points() {
  contact::ContactRows& contacts = run_.world.contacts();
  bool found = false;
  for (const auto& touching : contacts.planes().surfaces()) {
    bool looked = false;
    for (std::size_t k = 0; k < touching->count(); ++k) {
      const int row = touching->contact().row(k);
      if (!contacts.is_closed(row)) continue;
      if (!looked) touching->look_around();
      looked = true;
      const Matrix3 before = touching->contact().frame(k, run_.world.rows());
      if (!touching->turn(k)) continue;
      carry_friction(before, touching->contact().frame(k, run_.world.rows()),
                     Eigen::Map<Eigen::Vector2d>(&run_.effort[static_cast<std::size_t>(row) + 1]));
      contacts.planes().begin_point(row);
      contacts.planes().keep_gap(row);
      turned_[static_cast<std::size_t>(row)] = 1;
      found = true;
    }
  }
  return found;
}

void Midpoint::turn_to_end() {
  if (has_turned()) turn_points();
}

// Of rigid bodies and surfaces that are put there.
void Midpoint::place(double time) {
  if (run_.model->base_motions().empty() && !run_.world.contacts().planes().moves()) return;
  run_.surroundings.put_bases(time);
  run_.world.measure_delta();
  run_.world.contacts().planes().move_on(time);
}

// m: error at the end of the step. With delta in the middle, it is 2 delta plus terms of second
// order.
double Midpoint::correct() {
  world::World& world = run_.world;
  const VectorX& delta = world.measure_delta();
  for (const auto& touching : world.contacts().planes().surfaces()) {
    const auto first = static_cast<std::size_t>(touching->contact().first_row());
    const auto count = static_cast<std::size_t>(touching->contact().row_count());
    const auto own = std::span(turned_).subspan(first, count);
    if (std::ranges::find(own, 1) != own.end()) touching->look_around();
  }
  double worst = 0.0;
  for (law::BilateralBlock& block : world.problem().bilaterals) {
    const double off = delta[world.numbering().model_row_of(block.row)];
    block.motion -= 0.5 * off;
    worst = std::max(worst, std::abs(off) * block.motion_scale);
  }
  for (const Commanded& own : commanded_) {
    law::ActuatorBlock& block = world.problem().actuators[own.actuator];
    const double off = delta[block.row] - own.goal;
    block.value -= 0.5 * off;
    worst = std::max(worst, std::abs(off) * block.motion_scale);
  }
  for (const law::ContactBlock& block : world.problem().contacts) {
    const int row = world.numbering().model_row_of(block.row);
    const auto own = static_cast<std::size_t>(row);
    if (!world.contacts().is_closed(row) || !(run_.effort[own] > 0.0)) continue;
    const double off = opening(block, delta[row] - widened_[own]);
    world.contacts().planes().widen(row, 0.5 * off);
    widened_[own] += 0.5 * off;
    worst = std::max(worst, std::abs(off));
  }
  return worst;
}

bool Midpoint::has_turned() const { return std::ranges::find(turned_, 1) != turned_.end(); }

void Midpoint::measure_false_work() {
  const VectorX& delta = run_.world.delta();
  double work = 0.0, force = 0.0;
  for (std::size_t row = 0; row < turned_.size(); ++row) {
    if (turned_[row] == 0) continue;
    work += run_.effort[row] * (delta[static_cast<Eigen::Index>(row)] - widened_[row]);
    force += run_.effort[row];
  }
  false_work_ = std::abs(work);
  false_work_rounding_ = kHeld * run_.model->size() * force;
}

// m: growth of a point's gap in the step. For turned points it is measured between the surfaces;
// for the others it is the value of the row.
double Midpoint::opening(const law::ContactBlock& block, double by_row) const {
  const contact::ContactRows& contacts = run_.world.contacts();
  const int row = run_.world.numbering().model_row_of(block.row);
  const auto number = static_cast<std::size_t>(block.contact);
  const contact::TouchingSurfaces* surfaces = contacts.surfaces(number);
  if (surfaces == nullptr || turned_[static_cast<std::size_t>(row)] == 0) return by_row;
  const int first = contacts.planes().contacts()[number]->first_row();
  return surfaces->opening(static_cast<std::size_t>(row - first) / 3).value_or(by_row);
}

void Midpoint::release() {
  world::World& world = run_.world;
  for (law::BilateralBlock& block : world.problem().bilaterals) block.motion = 0.0;
  for (const Commanded& own : commanded_) {
    world.problem().actuators[own.actuator].value = own.goal;
  }
  for (const law::ContactBlock& block : world.problem().contacts) {
    const int row = world.numbering().model_row_of(block.row);
    double& widened = widened_[static_cast<std::size_t>(row)];
    world.contacts().planes().widen(row, -widened);
    widened = 0.0;
  }
}

}  // namespace sinew::step
