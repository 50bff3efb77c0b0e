#include "sinew/world/striking_points.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/shape_contact.hpp"
#include "sinew/model/model.hpp"
#include "sinew/qp/friction_cone.hpp"
#include "sinew/world/row_motions.hpp"
#include "sinew/world/world.hpp"

namespace sinew::world {

namespace {

// Relative to the robot's size: gaps up to this are closed, and smaller rebounds are suppressed.
constexpr double kClosed = 1e-9;
// Permitted penetration when a gap closes, relative to kClosed.
constexpr double kFound = 1e-3;
// Relative to the robot's size: overlap that no observed point has predicted.
constexpr double kUnseen = 1e-6;
// Minimum part, relative to the time step: in shorter parts, velocities vanish in the rounding of
// positions. Gaps that would close within such a part are closed.
constexpr double kShortest = 1e-6;
// Number of parts of a step after which the minimum part grows: where a vertex slides around an
// edge at the separation of the surfaces, the number would be unbounded.
constexpr double kManyParts = 200.0;
// Fraction of the time until unobserved surfaces pass each other, at which they are still apart.
constexpr double kBefore = 0.95;
// A point rolls if its slip is less than this fraction of the body's speed.
constexpr double kRolls = 0.05;

}  // namespace

StrikingPoints::StrikingPoints(const model::Model& model, World& world)
    : model_(model),
      world_(world),
      restitution_(static_cast<std::size_t>(model.rows().rows()), 0.0),
      closed_(kClosed * model.size()),
      still_(closed_ / model.step().time_step),
      shortest_(kShortest * model.step().time_step) {
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    if (model.contacts()[i].strikes) contacts_.push_back(static_cast<int>(i));
  }
}

void StrikingPoints::look(double time, std::span<double> effort) {
  if (contacts_.empty()) return;
  world_.begin_event_query(time, effort);
  points_.clear();
  time_ = time;
  found_rest_ = false;
  for (const int contact : contacts_) look_at(contact);
  deepest_ = deepest(time);
}

void StrikingPoints::look_at(int index) {
  const constraint::Contact& contact = model_.contact(index);
  const double restitution = model_.contacts()[static_cast<std::size_t>(index)].restitution;
  for (std::size_t k = 0; k < contact.size(); ++k) {
    const int row = contact.row(k);
    world_.contacts().set_closed(row, false);
    if (contact.idle(k, world_.rows())) continue;
    const Point point = measure(index, k);
    world_.contacts().set_closed(row, is_closed(point));
    restitution_[static_cast<std::size_t>(row)] = rests(point) ? 0.0 : restitution;
    points_.push_back(point);
  }
}

// Waiting edges (TouchingSurfaces) touch at zero distance, after their slack.
StrikingPoints::Point StrikingPoints::measure(int index, std::size_t number) const {
  const constraint::Contact& contact = model_.contact(index);
  const contact::ContactRows& rows = world_.contacts();
  const contact::TouchingSurfaces* surfaces = rows.surfaces(static_cast<std::size_t>(index));
  Point point;
  point.contact = index;
  point.number = number;
  point.row = contact.row(number);
  point.friction = contact.friction();
  point.gap = world_.delta()[point.row];
  if (surfaces != nullptr) point.gap += surfaces->slack(number);
  const Vector3 velocity = contact_velocity(world_, index, number);
  point.velocity = velocity[0];
  point.slip = velocity.tail<2>().norm();
  const bool rubs = is_closed(point) && point.friction.sticking > 0.0;
  if (rubs) point.speed = rows.planes().centre_velocity_beside(contact, number).norm();
  return point;
}

StrikingPoints::Named StrikingPoints::name(const Point& point) const {
  const contact::TouchingSurfaces* surfaces =
      world_.contacts().surfaces(static_cast<std::size_t>(point.contact));
  if (surfaces != nullptr) return {point.contact, surfaces->key(point.number)};
  return {point.contact, {.first = static_cast<int>(point.number)}};
}

bool StrikingPoints::rests(const Point& point) const {
  return !rests_.empty() && std::ranges::find(rests_, name(point)) != rests_.end();
}

bool StrikingPoints::is_closed(const Point& point) const {
  return point.gap <= closed_ + shortest_ * std::abs(point.velocity);
}

bool StrikingPoints::strike() const {
  return std::ranges::any_of(
      points_, [&](const Point& point) { return is_closed(point) && point.velocity < -still_; });
}

void StrikingPoints::close() {
  for (const Point& point : points_) {
    const bool still = std::abs(point.velocity) <= still_ || rests(point);
    world_.contacts().set_closed(point.row, is_closed(point) && still);
  }
}

double StrikingPoints::free_length(double length, int parts) {
  for (const int contact : contacts_) {
    contact::TouchingSurfaces* surfaces =
        world_.contacts().surfaces(static_cast<std::size_t>(contact));
    if (surfaces != nullptr) surfaces->look_at_overlaps();
  }
  double least = length;
  for (const Point& point : points_) {
    if (world_.contacts().is_closed(point.row)) continue;
    least = std::min(least, closing_time(point, gap_at_end(point), length));
  }
  least = least < length ? least : unseen_length(length);
  const double shortest = shortest_ * std::pow(std::max(1.0, parts / kManyParts), 4.0);
  return std::max(least, std::min(length, shortest));
}

double StrikingPoints::gap_at_end(const Point& point) const {
  const contact::TouchingSurfaces* surfaces =
      world_.contacts().surfaces(static_cast<std::size_t>(point.contact));
  if (surfaces == nullptr) return world_.delta()[point.row];
  return surfaces->gap_there(point.number) + surfaces->slack(point.number);
}

// If bodies overlap or have passed each other without a warning by any observed point: a length
// after which they are nearer, so the next search finds the point.
double StrikingPoints::unseen_length(double length) {
  const double allowed = kUnseen * model_.size();
  double first = kInfinity;
  for (const int contact : contacts_) {
    contact::TouchingSurfaces* surfaces =
        world_.contacts().surfaces(static_cast<std::size_t>(contact));
    if (surfaces != nullptr) first = std::min(first, surfaces->first_passing(allowed));
  }
  if (first < kInfinity) return std::max(0.5, kBefore * first) * length;
  const bool unseen = deepest(time_ + length) < std::min(deepest_, 0.0) - allowed;
  return unseen ? 0.5 * length : length;
}

double StrikingPoints::next_corner(double time) const {
  double next = kInfinity;
  for (const int index : contacts_) {
    const auto& motion = model_.contacts()[static_cast<std::size_t>(index)].motion;
    if (motion) next = std::min(next, motion->next_corner(time));
  }
  for (const model::BaseMotion& motion : model_.base_motions()) {
    next = std::min(next, motion.next_corner(time));
  }
  return next;
}

// Uses the parabola through the gap and its rate at the start of the part and the gap at its end.
// It is exact for constant acceleration; otherwise it is updated in the shorter part.
double StrikingPoints::closing_time(const Point& point, double end, double length) {
  const double gap = point.gap, rate = point.velocity;
  const double inside = -kFound * closed_;
  const double bend = (end - gap - rate * length) / (length * length);
  if (is_closed(point) && rate > 0.0) {  // rebound
    if (end >= std::min(gap, inside)) return kInfinity;
    if (rate * rate <= 4.0 * std::abs(bend) * closed_) {
      rests_.push_back(name(point));
      found_rest_ = true;
    }
    return -rate / bend;
  }
  if (end >= inside) {  // unless it is negative in between
    const bool dips = rate < 0.0 && -rate < 2.0 * bend * length;
    if (!dips || gap - rate * rate / (4.0 * bend) >= inside) return kInfinity;
  }
  const double root = std::sqrt(std::max(rate * rate - 4.0 * bend * gap, 0.0));
  return 2.0 * gap / (root - rate);
}

void StrikingPoints::forget_rest() { rests_.clear(); }

bool StrikingPoints::caught(std::span<const double> effort) const {
  return std::ranges::any_of(points_, [&](const Point& point) {
    if (!world_.contacts().is_closed(point.row) || point.friction.sticking == 0.0) return false;
    const Eigen::Map<const Vector3> force(effort.data() + point.row);
    const bool sticks = force[0] > 0.0 && !point.friction.slides(force);
    return sticks && point.slip > std::max(still_, kRolls * point.speed);
  });
}

bool StrikingPoints::drift(std::span<const double> effort) const {
  const contact::ContactRows& rows = world_.contacts();
  return std::ranges::any_of(points_, [&](const Point& point) {
    const bool pressed =
        rows.is_closed(point.row) && effort[static_cast<std::size_t>(point.row)] > 0.0;
    if (!pressed) return false;
    return std::abs(contact_velocity(world_, point.contact, point.number)[0]) > still_;
  });
}

double StrikingPoints::deepest(double time) const {
  double least = kInfinity;
  for (const int index : contacts_) {
    const auto number = static_cast<std::size_t>(index);
    if (const contact::TouchingSurfaces* surfaces = world_.contacts().surfaces(number)) {
      least = std::min(least, surfaces->deepest());
      continue;
    }
    const contact::ContactPlanes& planes = world_.contacts().planes();
    least =
        std::min(least, planes.shape(number)->deepest(
                            world_.configuration(), planes.pose_now(number, time), world_.rows()));
  }
  return least;
}

}  // namespace sinew::world
