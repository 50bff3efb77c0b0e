#include "sinew/pcc/planar_equations.hpp"

#include <algorithm>
#include <utility>

#include "sinew/pcc/stumpff.hpp"

namespace sinew::pcc {

namespace {

PlaneVector operator+(const PlaneVector& a, const PlaneVector& b) {
  return {a.along + b.along, a.aside + b.aside};
}
PlaneVector operator-(const PlaneVector& a, const PlaneVector& b) {
  return {a.along - b.along, a.aside - b.aside};
}
PlaneVector operator*(double s, const PlaneVector& a) { return {s * a.along, s * a.aside}; }
PlaneVector operator*(const PlaneVector& a, const PlaneVector& b) {
  return {a.along * b.along - a.aside * b.aside, a.along * b.aside + a.aside * b.along};
}
/// i a, the vector rotated by 90 degrees.
PlaneVector turned(const PlaneVector& a) { return {-a.aside, a.along}; }
double dot(const PlaneVector& a, const PlaneVector& b) {
  return a.along * b.along + a.aside * b.aside;
}

/// E = B + i A of bend.hpp, and its derivatives with respect to the angle.
struct Arc {
  PlaneVector value, first, second, third;
  PlaneVector turn;  // e^(ia)
};

Arc arc(double a) {
  const auto c = stumpff<6>(a * a);
  return {{c[1], a * c[2]},
          {a * (c[3] - c[2]), c[1] - c[2]},
          {2.0 * (c[2] - c[3]) - c[1], a * (2.0 * (c[3] - c[4]) - c[2])},
          {a * (6.0 * (c[4] - c[5]) - 3.0 * c[3] + c[2]), 6.0 * (c[4] - c[3]) + 3.0 * c[2] - c[1]},
          {c[0], a * c[1]}};
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The components in the plane of a vector in world axes.
PlaneVector in_plane(const ArmSettings& settings, const Vector3& v) {
  return {settings.frame.col(2).dot(v), settings.frame.col(0).dot(v)};
}

}  // namespace

bool PlanarEquations::apply_to(const Arm& arm) {
  return std::ranges::all_of(arm.settings().segments, [](const Segment& segment) {
    return segment.bending == Bending::planar && segment.gamma == 0.0;
  });
}

PlanarEquations::PlanarEquations(std::shared_ptr<const Arm> arm)
    : arm_(std::move(arm)),
      gravity_(in_plane(arm_->settings(), arm_->settings().gravity)),
      bends_(at(arm_->segments())),
      columns_(bends_.size()) {
  for (const Particle& particle : arm_->particles()) {
    forces_.push_back(in_plane(arm_->settings(), particle.force));
  }
}

void PlanarEquations::bend(const VectorX& q, const VectorX& rate, const VectorX& acceleration) {
  PlaneVector turn{1.0, 0.0}, end, alphas;
  double spin = 0.0, squares = 0.0;
  for (int n = 0; n < arm_->segments(); ++n) {
    const Segment& segment = arm_->settings().segments[at(n)];
    Bent& bent = bends_[at(n)];
    const Arc own = arc(q[n]);
    const PlaneVector reach = segment.length * turn;
    bent.turn = turn;
    bent.start = end + segment.dead_length * turn;
    bent.end = end = bent.start + reach * own.value;
    bent.slope = reach * own.first;
    bent.second = reach * (own.second - turned(own.first));
    bent.third = reach * (own.third - turned(own.second));
    bent.rate = rate[n];
    bent.spin = spin;
    bent.alpha = {acceleration[n], 2.0 * spin * rate[n]};
    bent.alphas = alphas;
    bent.squares = squares;
    turn = turn * own.turn;
    spin += rate[n];
    alphas = alphas + bent.alpha;
    squares += rate[n] * rate[n];
  }
}

/// Computes x'' of a particle, m/s^2, and its columns. @param angle theta of its segment.
PlaneVector PlanarEquations::accelerate(const Particle& particle, double angle) {
  const double f = particle.fraction, mass = particle.mass;
  const Bent& last = bends_[at(particle.segment)];
  const double length = arm_->settings().segments[at(particle.segment)].length;
  const Arc own = arc(f * angle);
  const PlaneVector reach = (particle.scale * f * length) * last.turn;
  const PlaneVector position = last.start + reach * own.value;
  PlaneVector beyond, speed;  // sums over later angles, of the acceleration and the velocity
  for (int m = particle.segment; m >= 0; --m) {
    const Bent& bent = bends_[at(m)];
    Column& column = columns_[at(m)];
    PlaneVector third;
    if (m == particle.segment) {
      column.first = f * (reach * own.first);
      column.second = (f * f) * (reach * own.second);
      third = (f * f * f) * (reach * own.third);
    } else {
      column.first = turned(position - bent.end) + bent.slope;
      column.second = turned(column.first) + bent.second;
      third = turned(column.second) + bent.third;
    }
    const double square = bent.rate * bent.rate;
    const PlaneVector before = turned(bent.alphas) - PlaneVector{bent.squares, 0.0};
    column.by_position = mass * (column.first * before + column.second * bent.alpha +
                                 square * third + turned(beyond));
    column.by_rate =
        (2.0 * mass) * (bent.rate * column.second + turned(bent.spin * column.first + speed));
    beyond = beyond + column.first * bent.alpha + square * column.second;
    speed = speed + bent.rate * column.first;
  }
  return beyond;
}

void PlanarEquations::add(int segment, const PlaneVector& pull, double mass,
                          ArmEquations::Linearisation& result) const {
  for (int k = 0; k <= segment; ++k) {
    const Column& row = columns_[at(k)];
    result.residual[k] += dot(row.first, pull);
    result.by_position(k, k) += dot(row.second, pull);
    for (int j = 0; j <= segment; ++j) {
      const Column& column = columns_[at(j)];
      result.by_position(k, j) += dot(row.first, column.by_position);
      result.by_rate(k, j) += dot(row.first, column.by_rate);
      if (j <= k) result.by_acceleration(k, j) += mass * dot(row.first, column.first);
      if (j != k) result.by_position(k, j) += dot(turned(columns_[at(std::max(j, k))].first), pull);
    }
  }
}

void PlanarEquations::linearise(const VectorX& q, const VectorX& rate, const VectorX& acceleration,
                                ArmEquations::Linearisation& result) {
  bend(q, rate, acceleration);
  result.residual = arm_->stiffness().cwiseProduct(q) + arm_->damping().cwiseProduct(rate);
  result.by_position = arm_->stiffness().asDiagonal();
  result.by_rate = arm_->damping().asDiagonal();
  result.by_acceleration.setZero();
  for (std::size_t p = 0; p < forces_.size(); ++p) {
    const Particle& particle = arm_->particles()[p];
    const PlaneVector moved = accelerate(particle, q[particle.segment]) - gravity_;
    add(particle.segment, particle.mass * moved - forces_[p], particle.mass, result);
  }
  result.by_acceleration.triangularView<Eigen::StrictlyUpper>() =
      result.by_acceleration.transpose();
}

}  // namespace sinew::pcc
