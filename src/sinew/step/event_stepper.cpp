#include "sinew/step/event_stepper.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/core/error.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/step_failure.hpp"
#include "sinew/world/end_efforts.hpp"
#include "sinew/world/row_motions.hpp"

namespace sinew::step {

namespace {

// Bounds that are far beyond the needs of a valid scene: impacts at one time, parts of a step, and
// trials of a part.
constexpr int kMaxImpacts = 1000;
constexpr int kMaxEventParts = 100000;
constexpr int kMaxTrials = 200;
// Smallest part, relative to the step, to which a part is shortened after a failure or because of
// spurious work.
constexpr double kSmallest = 1.0 / 64.0;
// Smaller motions in a part, relative to the robot's size, are zero.
constexpr double kStill = 1e-9;
// Permitted spurious work of sliding contacts in a part (Midpoint), relative to the kinetic energy,
// in parts that may be halved.
constexpr double kFalseWork = 1e-6;
// A smaller remainder of a step, relative to the step, is rounding.
constexpr double kNoTime = 1e-12;

bool stops(const law::ActuatorBlock& block) {
  return std::isfinite(block.motion_min) || std::isfinite(block.motion_max);
}

// Enables striking contacts during its lifetime.
class Events {
 public:
  explicit Events(contact::ContactRows& contacts) : contacts_(contacts) {
    contacts_.set_events(true);
  }
  ~Events() {
    contacts_.set_events(false);
    contacts_.planes().set_halved(false);
  }
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

 private:
  contact::ContactRows& contacts_;
};

}  // namespace

EventStepper::EventStepper(run::Run& run)
    : run_(run), substep_(run), midpoint_(run), impact_(run), points_(*run.model, run.world) {}

void EventStepper::step(double begin, double time_step) {
  run::StepReport& report = run_.report;
  report.substeps = 0;
  report.error = 0.0;
  longest_ = time_step;
  const Events events(run_.world.contacts());
  make_parts(begin, time_step);
}

void EventStepper::make_parts(double begin, double time_step) {
  run::StepReport& report = run_.report;
  points_.forget_rest();
  substep_.read_commands(begin + time_step, time_step);
  collide(begin);
  for (double done = 0.0; done < time_step;) {
    if (++report.substeps > kMaxEventParts) give_up("impacts follow each other too fast");
    const double left = time_step - done, now = begin + done;
    const double length = advance(now, std::min({left, longest_, next_corner(now) - now}));
    done = left - length > kNoTime * time_step ? done + length : time_step;
    points_.forget_rest();
    collide(begin + done);
  }
}

// s: of prescribed and commanded motions.
double EventStepper::next_corner(double time) const {
  double next = points_.next_corner(time);
  for (const model::ActuatorState& state : run_.actuation.states()) {
    if (state.chosen || state.command.kind == model::CommandKind::effort) continue;
    next = std::min(next, state.command.signal.next_corner(time));
  }
  return next;
}

// Solves impacts at the present time until no closed point approaches.
void EventStepper::collide(double time) {
  run_.world.contacts().planes().set_halved(false);
  for (strikes_ = 0;; ++strikes_) {
    run_.surroundings.set_base_rates(time, model::Signal::Side::after);
    points_.look(time, run_.effort);
    if (!points_.strike()) break;
    if (strikes_ == kMaxImpacts) give_up("impacts of one moment do not end");
    if (strikes_ == 0) run_.keep(struck_);
    impact_.solve(points_.restitution());
  }
  run_.report.impacts += strikes_;
  points_.close();
}

// Makes the longest part up to which no gap closes.
double EventStepper::advance(double time, double left) {
  run_.keep(start_);
  double length = left;
  for (int trial = 0; trial < kMaxTrials; ++trial) {
    try {
      length = move(time, length);
    } catch (const Error& failure) {
      longest_ = length = 0.5 * length;
      if (!failure.is_run_failure() || length < kSmallest * run_.model->step().time_step) throw;
      ++run_.report.retries;
      run_.restore(start_);
      continue;
    }
    if (carried_on_ && turns_too_far(length)) {
      longest_ = length = 0.5 * length;
      ++run_.report.retries;
      run_.restore(start_);
      continue;
    }
    const double free = points_.free_length(length, run_.report.substeps);
    if (free >= length && !points_.found_rest()) {
      hold(time + length, length);
      if (carried_on_) find_end_efforts(length);
      return length;
    }
    ++run_.report.retries;
    run_.restore(start_);
    length = free;
    if (!points_.found_rest()) continue;
    rest(time);
    length = left;
  }
  give_up("the moment of an impact is not found");
}

// Whether a part should be halved because the spurious work of points that slide on turning
// surfaces is too large. This work decreases with the third power of the length of the part, but
// bodies that slide slowly may have hardly any kinetic energy.
bool EventStepper::turns_too_far(double length) {
  if (0.5 * length < kSmallest * run_.model->step().time_step) return false;
  const double work = midpoint_.false_work() - midpoint_.false_work_rounding();
  return work > 0.0 && work > kFalseWork * run_.world.bodies().energies().kinetic;
}

// What the midpoint rule leaves of velocities along rows that are held; and backward Euler, where
// bodies are held on what moves by itself: it gives them the mean velocity of that.
// And what commanded motions lack of their velocities.
void EventStepper::hold(double time, double length) {
  const std::span<const HeldRate> commanded = midpoint_.held_rates();
  const bool joins = carried_on_ && !run_.world.problem().bilaterals.empty();
  const bool moves = !run_.model->base_motions().empty() || run_.world.contacts().planes().moves();
  if (moves) {
    run_.surroundings.set_base_rates(time, model::Signal::Side::before);
    run_.world.contacts().planes().move_on(time);
  }
  if (carried_on_) midpoint_.turn_to_end();
  const bool drifts = (carried_on_ || moves) && points_.drift(run_.effort);
  if (!joins && !drifts && commanded.empty()) return;
  impact_.hold(commanded, length);
  run_.finish_step();
}

void EventStepper::find_end_efforts(double length) {
  run_.world.end_efforts().follow_midpoint(run_.world, run_.effort, start_.efforts, length,
                                           start_.last_step);
}

// Points with negligible rebounds stay closed: the impact is repeated as inelastic.
void EventStepper::rest(double time) {
  if (strikes_ > 0) run_.restore(struck_);
  run_.report.impacts -= strikes_;
  collide(time);
  run_.keep(start_);
}

// Makes a part of this length, or half of it. @return its length.
double EventStepper::move(double time, double length) {
  const bool smooth = is_smooth(time, length);
  const double solved = smooth ? 0.5 * length : length;
  substep_.read_commands(time + solved, solved);
  if (smooth) midpoint_.aim_at_middle();
  effort_before_ = run_.effort;
  run_.world.contacts().planes().set_halved(smooth);
  substep_.begin(solved);
  if (smooth) {
    midpoint_.solve(substep_, solved);
  } else {
    substep_.solve(solved);
  }
  const bool stays = smooth && stays_smooth();
  carried_on_ = stays && midpoint_.carry_on(substep_, solved);
  if (carried_on_) {
    substep_.end_as_midpoint(length);
    return length;
  }
  const bool again = stays || midpoint_.has_turned() || midpoint_.has_commands();
  if (smooth && again) solve_again(time, solved);
  substep_.end(solved);
  return solved;
}

// Solves a part again that ends where the midpoint would be. Its turned points have the material
// points and normals of the end, and a gap of zero at the start between material points that do not
// touch there; its commanded motions are half-way to those of a later time. As a step of backward
// Euler, the part has those of its start, and commands of its end.
void EventStepper::solve_again(double begin, double length) {
  run_.go_back();
  run_.world.contacts().planes().set_halved(false);
  substep_.read_commands(begin + length, length);
  run_.world.measure_delta();
  midpoint_.take_commands(begin, length);
  substep_.begin(length);
  substep_.solve(length);
}

// Whether the first half of a part predicts the second. A limit or a taut cable that has just
// stopped a body leaves it a velocity, which a step of backward Euler removes.
bool EventStepper::is_smooth(double begin, double length) {
  world::World& world = run_.world;
  substep_.read_commands(begin + length, length);
  world.measure_delta();  // at the present state, not at the end of the last part
  const bool commands = midpoint_.take_commands(begin, length);
  if (!commands) return false;
  if (run_.actuation.drive_numbers() > 0 || !run_.model->guides().empty()) return false;
  if (!world.bodies().can_carry_on() || world.contacts().touches_softly(run_.effort)) return false;
  return std::ranges::none_of(world.problem().actuators, [&](const law::ActuatorBlock& block) {
    if (block.row < 0 || block.kind == law::CommandKind::motion) return false;
    if (!stops(block) || run_.effort[static_cast<std::size_t>(block.row)] == 0.0) return false;
    const double way = length * block.motion_scale * world::row_velocity(world, block.row);
    return std::abs(way) > kStill * run_.model->size();
  });
}

// Whether nothing stopped a body in the first half: joint limits, cables with a limited motion,
// points of deformable bodies, friction.
bool EventStepper::stays_smooth() const {
  const world::World& world = run_.world;
  if (!world.bodies().can_carry_on() || world.contacts().gap_closed(run_.effort)) return false;
  if (points_.caught(run_.effort) || !midpoint_.keeps_commands()) return false;
  return std::ranges::none_of(world.problem().actuators, [&](const law::ActuatorBlock& block) {
    if (block.row < 0 || block.kind == law::CommandKind::motion) return false;
    const auto row = static_cast<std::size_t>(block.row);
    return stops(block) && effort_before_[row] == 0.0 && run_.effort[row] != 0.0;
  });
}

void EventStepper::give_up(const char* what) {
  statics::fail(run_, ErrorKind::not_converged, what,
                "take a smaller time step, lower the restitution, or choose bdf2");
}

}  // namespace sinew::step
