#include "sinew/pcc/arm_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew::pcc {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

template <typename T>
ArmDynamics<T>::ArmDynamics(std::shared_ptr<const Arm> arm)
    : arm_(std::move(arm)),
      q_(at(arm_->coordinates())),
      rate_(at(arm_->coordinates())),
      acceleration_(at(arm_->coordinates())),
      frames_(at(arm_->segments())),
      bodies_(arm_->particles().size()),
      columns_(at(arm_->coordinates())) {
  for (const Segment& segment : arm_->settings().segments) {
    cosine_.push_back(std::cos(segment.gamma));
    sine_.push_back(std::sin(segment.gamma));
  }
}

template <typename T>
void ArmDynamics<T>::set(std::span<const T> q, std::span<const T> rate,
                         std::span<const T> acceleration) {
  std::copy(q.begin(), q.end(), q_.begin());
  std::copy(rate.begin(), rate.end(), rate_.begin());
  std::copy(acceleration.begin(), acceleration.end(), acceleration_.begin());
  sweep<true>();
}

template <typename T>
void ArmDynamics<T>::place(std::span<const T> q) {
  std::copy(q.begin(), q.end(), q_.begin());
  sweep<false>();
}

template <typename T>
template <bool kMoves>
void ArmDynamics<T>::sweep() {
  const ArmSettings& settings = arm_->settings();
  Vec3<T> origin(settings.base), velocity, moved(Vector3(-settings.gravity)), spin, spin_rate;
  Rotation<T> rotation{Vec3<T>(settings.frame.col(0)), Vec3<T>(settings.frame.col(1)),
                       Vec3<T>(settings.frame.col(2))};
  BendPoint<T> point;
  BendSection<T> section;
  std::size_t particle = 0;
  for (int n = 0; n < arm_->segments(); ++n) {
    const Segment& segment = settings.segments[at(n)];
    Frame& frame = frames_[at(n)];
    const int count = segment.coordinates();
    const std::size_t first = at(arm_->first(n));
    frame.rotation = {cosine_[at(n)] * rotation.x + sine_[at(n)] * rotation.y,
                      cosine_[at(n)] * rotation.y - sine_[at(n)] * rotation.x, rotation.z};
    if (segment.dead_length > 0.0) {
      const Vec3<T> arm = segment.dead_length * rotation.z;
      origin += arm;
      if constexpr (kMoves) {
        const Vec3<T> swept = cross(spin, arm);
        velocity += swept;
        moved += cross(spin_rate, arm) + cross(spin, swept);
      }
    }
    frame.origin = origin;
    if constexpr (kMoves) {
      frame.velocity = velocity;
      frame.acceleration = moved;
      frame.spin = spin;
      frame.spin_rate = spin_rate;
    }

    const Bend<T, kMoves> own(segment, &q_[first], &rate_[first]);
    // Position, velocity and acceleration of a point in the moving frame.
    const auto carry = [&](Vec3<T>& x, Vec3<T>& v, Vec3<T>& a, std::array<Vec3<T>, 3>& gradient) {
      const Vec3<T> arm = frame.rotation * point.position;
      x = frame.origin + arm;
      for (int i = 0; i < count; ++i) gradient[at(i)] = frame.rotation * point.gradient[at(i)];
      if constexpr (kMoves) {
        Vec3<T> slide, push = point.bias;
        for (int i = 0; i < count; ++i) {
          slide += rate_[first + at(i)] * point.gradient[at(i)];
          push += acceleration_[first + at(i)] * point.gradient[at(i)];
        }
        slide = frame.rotation * slide;
        const Vec3<T> swept = cross(frame.spin, arm);
        v = frame.velocity + swept + slide;
        a = frame.acceleration + cross(frame.spin_rate, arm) +
            cross(frame.spin, swept + 2.0 * slide) + frame.rotation * push;
      }
    };
    for (; particle < bodies_.size() && arm_->particles()[particle].segment == n; ++particle) {
      const Particle& settings_of = arm_->particles()[particle];
      Body& body = bodies_[particle];
      own.at(settings_of.fraction, settings_of.scale, point, nullptr);
      carry(body.position, body.velocity, body.acceleration, body.gradient);
    }
    own.at(1.0, 1.0, point, &section);
    carry(origin, velocity, moved, frame.gradient);
    for (int i = 0; i < count; ++i) frame.turn[at(i)] = frame.rotation * section.spin[at(i)];
    if constexpr (kMoves) {
      Vec3<T> turn, turn_rate = section.spin_bias;
      for (int i = 0; i < count; ++i) {
        turn += rate_[first + at(i)] * section.spin[at(i)];
        turn_rate += acceleration_[first + at(i)] * section.spin[at(i)];
      }
      turn = frame.rotation * turn;
      spin_rate += cross(spin, turn) + frame.rotation * turn_rate;
      spin += turn;
    }
    rotation = frame.rotation * section.rotation;
    frame.end = origin;
    frame.end_rotation = rotation;
  }
}

template <typename T>
void ArmDynamics<T>::inverse_dynamics(std::span<T> torque) {
  const auto& particles = arm_->particles();
  Vec3<T> force, moment;  // of all particles beyond, about the current end
  std::size_t particle = particles.size();
  for (int n = arm_->segments(); n-- > 0;) {
    const Frame& frame = frames_[at(n)];
    const Segment& segment = arm_->settings().segments[at(n)];
    const std::size_t first = at(arm_->first(n));
    const int count = segment.coordinates();
    for (int i = 0; i < count; ++i) {
      const std::size_t k = first + at(i);
      torque[k] = dot(frame.gradient[at(i)], force) + dot(frame.turn[at(i)], moment) +
                  arm_->stiffness()[static_cast<Eigen::Index>(k)] * q_[k] +
                  arm_->damping()[static_cast<Eigen::Index>(k)] * rate_[k];
    }
    moment += cross(frame.end - frame.origin, force);
    for (; particle > 0 && particles[particle - 1].segment == n; --particle) {
      const Particle& of = particles[particle - 1];
      const Body& body = bodies_[particle - 1];
      const Vec3<T> pull = of.mass * body.acceleration + Vec3<T>(Vector3(-of.force));
      for (int i = 0; i < count; ++i) torque[first + at(i)] += dot(body.gradient[at(i)], pull);
      moment += cross(body.position - frame.origin, pull);
      force += pull;
    }
    if (segment.dead_length > 0.0) {
      moment += cross(segment.dead_length * frame.rotation.z, force);
    }
  }
}

template <typename T>
void ArmDynamics<T>::mass_regressor(std::span<T> torque) {
  const std::size_t n = q_.size();
  std::fill(torque.begin(), torque.end(), T(0.0));
  for (std::size_t p = 0; p < bodies_.size(); ++p) {
    const Particle& of = arm_->particles()[p];
    if (of.mass == 0.0) continue;
    const Body& body = bodies_[p];
    const Vec3<T> pull =
        (of.mass / arm_->settings().segments[at(of.segment)].mass) * body.acceleration;
    T* column = torque.data() + n * at(of.segment);
    for (int k = 0; k <= of.segment; ++k) {
      const Frame& frame = frames_[at(k)];
      const Vec3<T> moment = cross(body.position - frame.end, pull);
      for (int i = 0; i < arm_->settings().segments[at(k)].coordinates(); ++i) {
        column[at(arm_->first(k) + i)] +=
            k == of.segment ? dot(body.gradient[at(i)], pull)
                            : dot(frame.gradient[at(i)], pull) + dot(frame.turn[at(i)], moment);
      }
    }
  }
}

template <typename T>
std::span<const Vec3<T>> ArmDynamics<T>::particle_jacobian(std::size_t particle) {
  const Particle& of = arm_->particles()[particle];
  const Body& body = bodies_[particle];
  const std::size_t own = at(arm_->first(of.segment));
  for (int k = 0; k < of.segment; ++k) {
    const Frame& frame = frames_[at(k)];
    const Vec3<T> arm = body.position - frame.end;
    const std::size_t first = at(arm_->first(k));
    for (int i = 0; i < arm_->settings().segments[at(k)].coordinates(); ++i) {
      columns_[first + at(i)] = frame.gradient[at(i)] + cross(frame.turn[at(i)], arm);
    }
  }
  const std::size_t count = at(arm_->settings().segments[at(of.segment)].coordinates());
  for (std::size_t i = 0; i < count; ++i) columns_[own + i] = body.gradient[i];
  return {columns_.data(), own + count};
}

template <typename T>
void ArmDynamics<T>::mass_matrix(std::span<T> mass) {
  const auto n = at(arm_->coordinates());
  std::fill(mass.begin(), mass.end(), T(0.0));
  for (std::size_t p = 0; p < bodies_.size(); ++p) {
    const Particle& of = arm_->particles()[p];
    if (of.mass == 0.0) continue;
    const std::size_t used = particle_jacobian(p).size();
    for (std::size_t i = 0; i < used; ++i) {
      const Vec3<T> heavy = of.mass * columns_[i];
      for (std::size_t j = 0; j <= i; ++j) mass[i * n + j] += dot(heavy, columns_[j]);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) mass[i * n + j] = mass[j * n + i];
  }
}

template <typename T>
typename ArmDynamics<T>::Spot ArmDynamics<T>::spot(const ArmPoint& point) const {
  Spot result;
  const Bend<T, false> own(arm_->settings().segments[at(point.segment)],
                           &q_[at(arm_->first(point.segment))], nullptr);
  own.at(point.fraction, 1.0, result.own, &result.section);
  const Rotation<T>& turned = result.section.rotation;
  result.aside = point.x * turned.x + point.y * turned.y + point.z * turned.z;
  const Frame& frame = frames_[at(point.segment)];
  result.position = frame.origin + frame.rotation * (result.own.position + result.aside);
  return result;
}

template <typename T>
Vec3<T> ArmDynamics<T>::position(const ArmPoint& point) const {
  return spot(point).position;
}

template <typename T>
Rotation<T> ArmDynamics<T>::rotation(const ArmPoint& point) const {
  return frames_[at(point.segment)].rotation * spot(point).section.rotation;
}

template <typename T>
void ArmDynamics<T>::jacobian(const ArmPoint& point, std::span<Vec3<T>> columns) const {
  const Spot here = spot(point);
  const Frame& frame = frames_[at(point.segment)];
  for (int k = 0; k < arm_->segments(); ++k) {
    const std::size_t first = at(arm_->first(k));
    const Frame& before = frames_[at(k)];
    for (int i = 0; i < arm_->settings().segments[at(k)].coordinates(); ++i) {
      Vec3<T>& column = columns[first + at(i)];
      if (k < point.segment) {
        column = before.gradient[at(i)] + cross(before.turn[at(i)], here.position - before.end);
      } else if (k == point.segment) {
        column = frame.rotation *
                 (here.own.gradient[at(i)] + cross(here.section.spin[at(i)], here.aside));
      } else {
        column = {};
      }
    }
  }
}

// The angular velocities of segments in a chain add up (Featherstone, 2008, sec. 4.4).
template <typename T>
void ArmDynamics<T>::angular_jacobian(const ArmPoint& point, std::span<Vec3<T>> columns) const {
  const Spot here = spot(point);
  std::fill(columns.begin(), columns.end(), Vec3<T>());
  for (int k = 0; k <= point.segment; ++k) {
    const std::size_t first = at(arm_->first(k));
    const Frame& frame = frames_[at(k)];
    for (int i = 0; i < arm_->settings().segments[at(k)].coordinates(); ++i) {
      columns[first + at(i)] =
          k < point.segment ? frame.turn[at(i)] : frame.rotation * here.section.spin[at(i)];
    }
  }
}

template <typename T>
Vec3<T> ArmDynamics<T>::velocity(const ArmPoint& point) {
  jacobian(point, columns_);
  return of_rates();
}

template <typename T>
Vec3<T> ArmDynamics<T>::angular_velocity(const ArmPoint& point) {
  angular_jacobian(point, columns_);
  return of_rates();
}

template <typename T>
Vec3<T> ArmDynamics<T>::of_rates() const {
  Vec3<T> sum;
  for (std::size_t i = 0; i < q_.size(); ++i) sum += rate_[i] * columns_[i];
  return sum;
}

template <typename T>
T ArmDynamics<T>::strain_energy() const {
  T sum(0.0);
  for (std::size_t i = 0; i < q_.size(); ++i) {
    sum += 0.5 * arm_->stiffness()[static_cast<Eigen::Index>(i)] * (q_[i] * q_[i]);
  }
  return sum;
}

template <typename T>
T ArmDynamics<T>::kinetic_energy() const {
  T sum(0.0);
  for (std::size_t p = 0; p < bodies_.size(); ++p) {
    sum += 0.5 * arm_->particles()[p].mass * dot(bodies_[p].velocity, bodies_[p].velocity);
  }
  return sum;
}

template <typename T>
T ArmDynamics<T>::gravity_energy() const {
  const ArmSettings& settings = arm_->settings();
  T sum(0.0);
  for (std::size_t p = 0; p < bodies_.size(); ++p) {
    const Particle& of = arm_->particles()[p];
    const Vector3 weight = of.mass * settings.gravity + of.force;
    sum -= dot(Vec3<T>(weight), bodies_[p].position - Vec3<T>(settings.base));
  }
  return sum;
}

template class ArmDynamics<double>;
template class ArmDynamics<std::complex<double>>;
template class ArmDynamics<Dual<1>>;
template class ArmDynamics<Dual<8>>;
template class ArmDynamics<Varied<Dual<8>>>;

}  // namespace sinew::pcc
