#include "sinew/sim/striking_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/constraint/shape_contact.hpp"
#include "sinew/qp/friction_cone.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/row_motions.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

namespace {

// Of the robot's size: gaps that are closed, and rebounds that are none.
constexpr double kClosed = 1e-9;
// Of that: how far inside a point may be at the moment that is found.
constexpr double kFound = 1e-3;
// Of the robot's size: an overlap that no watched point has seen coming.
constexpr double kUnseen = 1e-6;
// Of a body's speed: a point that slides less than this rolls.
constexpr double kRolls = 0.05;

}  // namespace

StrikingPoints::StrikingPoints(const Model& model, World& world)
    : model_(model),
      world_(world),
      restitution_(static_cast<std::size_t>(model.rows().rows()), 0.0),
      rests_(restitution_.size(), 0),
      closed_(kClosed * model.size()),
      still_(closed_ / model.step().time_step) {
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    if (model.contacts()[i].strikes) contacts_.push_back(static_cast<int>(i));
  }
}

void StrikingPoints::look(double time) {
  if (contacts_.empty()) return;
  world_.begin_query(time);
  points_.clear();
  time_ = time;
  found_rest_ = false;
  for (const int index : contacts_) {
    const auto& contact = static_cast<const constraint::ShapeContact&>(model_.contact(index));
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const int row = contact.row(k);
      world_.contacts().set_closed(row, false);
      if (contact.idle(k, world_.rows())) continue;
      const Matrix3 frame = contact.frame(k, world_.rows());
      const Vector3 velocity =
          frame.transpose() * contact.velocity_beside(world_.configuration(), k, world_.rows());
      Point point{row,         contact.friction(),        world_.delta()[row],
                  velocity[0], velocity.tail<2>().norm(), contact.speed(world_.configuration(), k)};
      world_.contacts().set_closed(row, point.gap <= closed_);
      const bool rests = rests_[static_cast<std::size_t>(row)] != 0;
      restitution_[static_cast<std::size_t>(row)] =
          rests ? 0.0 : model_.contacts()[static_cast<std::size_t>(index)].restitution;
      points_.push_back(point);
    }
  }
  deepest_ = deepest();
}

bool StrikingPoints::strike() const {
  return std::ranges::any_of(points_, [&](const Point& point) {
    return point.gap <= closed_ && point.velocity < -still_;
  });
}

void StrikingPoints::close() {
  for (const Point& point : points_) {
    const bool still = std::abs(point.velocity) <= still_;
    const bool rests = still || rests_[static_cast<std::size_t>(point.row)] != 0;
    world_.contacts().set_closed(point.row, point.gap <= closed_ && rests);
  }
}

double StrikingPoints::free_length(double length) {
  double least = length;
  for (const Point& point : points_) {
    if (world_.contacts().is_closed(point.row)) continue;
    const double end = world_.delta()[point.row];
    least = std::min(least, closing_time(point, end, length));
  }
  if (least < length) return least;
  const bool unseen = deepest() < std::min(deepest_, 0.0) - kUnseen * model_.size();
  return unseen ? 0.5 * length : length;
}

// Of the parabola with the gap and its rate when the part began and the gap at its end. It is exact
// for constant accelerations; elsewhere it is drawn anew in the shorter part.
double StrikingPoints::closing_time(const Point& point, double end, double length) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double gap = point.gap, rate = point.velocity;
  const double inside = -kFound * closed_;
  const double bend = (end - gap - rate * length) / (length * length);
  if (gap <= closed_ && rate > 0.0) {  // it rebounds
    if (end >= inside) return kNever;
    if (rate * rate <= 4.0 * std::abs(bend) * closed_) {
      rests_[static_cast<std::size_t>(point.row)] = 1;
      found_rest_ = true;
    }
    return -rate / bend;
  }
  if (end >= inside) {  // unless it dips in between
    const bool dips = rate < 0.0 && -rate < 2.0 * bend * length;
    if (!dips || gap - rate * rate / (4.0 * bend) >= inside) return kNever;
  }
  const double root = std::sqrt(std::max(rate * rate - 4.0 * bend * gap, 0.0));
  return 2.0 * gap / (root - rate);
}

void StrikingPoints::forget_rest() { std::ranges::fill(rests_, 0); }

bool StrikingPoints::caught(std::span<const double> effort) const {
  return std::ranges::any_of(points_, [&](const Point& point) {
    if (!world_.contacts().is_closed(point.row) || point.friction.sticking == 0.0) return false;
    const Eigen::Map<const Vector3> force(effort.data() + point.row);
    const bool sticks = force[0] > 0.0 && !point.friction.slides(force);
    return sticks && point.slip > std::max(still_, kRolls * point.speed);
  });
}

bool StrikingPoints::drift(std::span<const double> effort) const {
  return std::ranges::any_of(points_, [&](const Point& point) {
    const bool pressed =
        world_.contacts().is_closed(point.row) && effort[static_cast<std::size_t>(point.row)] > 0.0;
    return pressed && std::abs(row_velocity(world_, point.row)) > still_;
  });
}

double StrikingPoints::deepest() const {
  double least = std::numeric_limits<double>::infinity();
  for (const int index : contacts_) {
    const auto& contact = static_cast<const constraint::ShapeContact&>(model_.contact(index));
    const Eigen::Isometry3d pose =
        world_.contacts().planes().pose_now(static_cast<std::size_t>(index), time_);
    least = std::min(least, contact.deepest(world_.configuration(), pose, world_.rows()));
  }
  return least;
}

}  // namespace sinew::sim
