#include "sinew/pcc/arm_equations.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/pcc/planar_equations.hpp"

namespace sinew::pcc {

namespace {

/// Number of variables in one pass of differentiation: angles and rates of four planar segments.
constexpr std::size_t kDirections = 8;
using First = Dual<kDirections>;
/// A number with its time derivative.
using Timed = Dual<1>;
using Second = Varied<First>;

template <typename T>
std::span<const T> view(const std::vector<T>& values) {
  return {values.data(), values.size()};
}

std::span<const double> view(const VectorX& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

}  // namespace

struct ArmEquations::Work {
  /// Computes the gradient of S in curvature(): by_position, by_rate and by_acceleration.
  void gradient_of_work();

  explicit Work(std::shared_ptr<const Arm> arm_)
      : arm(std::move(arm_)),
        plain(arm),
        n(static_cast<std::size_t>(arm->coordinates())),
        decomposed(arm->coordinates()) {
    const Eigen::Index size = arm->coordinates();
    zero = bias = acceleration = VectorX::Zero(size);
    mass = coriolis = MatrixX::Zero(size, size);
    regressor = MatrixX::Zero(size, arm->segments());
    ends = MatrixX::Zero(3 * arm->segments(), size);
    columns.resize(n);
    linear.residual = VectorX::Zero(size);
    linear.by_position = linear.by_rate = linear.by_acceleration = MatrixX::Zero(size, size);
    if (PlanarEquations::apply_to(*arm)) planar = std::make_unique<PlanarEquations>(arm);
  }

  std::shared_ptr<const Arm> arm;
  ArmDynamics<double> plain;
  std::size_t n;
  VectorX zero, bias, acceleration;
  MatrixX mass, coriolis, curvature, regressor, ends;
  std::vector<Vec3<double>> columns;
  linalg::CholeskyFactor decomposed;
  Linearisation linear;
  ForwardDerivatives forward;
  std::unique_ptr<PlanarEquations> planar;  // null unless the arm is planar
  // Workspaces with derivatives are made at first use.
  std::unique_ptr<ArmDynamics<Timed>> timed;
  std::unique_ptr<ArmDynamics<First>> first;
  std::vector<First> first_q, first_rate, first_acceleration, first_result;
  std::unique_ptr<ArmDynamics<Second>> second;
  std::vector<Second> second_q;
  std::vector<First> by_position, by_rate, by_acceleration;  // gradient of S
};

void ArmEquations::Work::gradient_of_work() {
  for (auto* part : {&by_position, &by_rate, &by_acceleration}) {
    std::fill(part->begin(), part->end(), First(0.0));
  }
  const auto part = [](const Vec3<Second>& v, First Second::*which) {
    return Vec3<First>(v.x.*which, v.y.*which, v.z.*which);
  };
  for (std::size_t p = 0; p < arm->particles().size(); ++p) {
    const Particle& of = arm->particles()[p];
    const Vec3<Second>& x = second->particle_position(p);
    const Vec3<First> heavy = of.mass * part(x, &Second::variation);
    const Vec3<First> pull = of.mass * part(x, &Second::acceleration) +
                             Vec3<First>(Vector3(-of.mass * arm->settings().gravity - of.force));
    const std::span<const Vec3<Second>> jacobian = second->particle_jacobian(p);
    for (std::size_t k = 0; k < jacobian.size(); ++k) {
      by_position[k] += dot(part(jacobian[k], &Second::variation), pull) +
                        dot(heavy, part(jacobian[k], &Second::acceleration));
      by_rate[k] += 2.0 * dot(heavy, part(jacobian[k], &Second::rate));
      by_acceleration[k] += dot(heavy, part(jacobian[k], &Second::value));
    }
  }
}

ArmEquations::ArmEquations(std::shared_ptr<const Arm> arm)
    : work_(std::make_unique<Work>(std::move(arm))) {}
ArmEquations::~ArmEquations() = default;
ArmEquations::ArmEquations(ArmEquations&&) noexcept = default;
ArmEquations& ArmEquations::operator=(ArmEquations&&) noexcept = default;

const Arm& ArmEquations::arm() const { return *work_->arm; }

const VectorX& ArmEquations::residual(const VectorX& q, const VectorX& rate,
                                      const VectorX& acceleration) {
  Work& w = *work_;
  w.plain.set(view(q), view(rate), view(acceleration));
  w.plain.inverse_dynamics({w.bias.data(), w.n});
  return w.bias;
}

const MatrixX& ArmEquations::mass_regressor(const VectorX& q, const VectorX& rate,
                                            const VectorX& acceleration) {
  Work& w = *work_;
  w.plain.set(view(q), view(rate), view(acceleration));
  w.plain.mass_regressor({w.regressor.data(), static_cast<std::size_t>(w.regressor.size())});
  return w.regressor;
}

const MatrixX& ArmEquations::mass_matrix(const VectorX& q) {
  Work& w = *work_;
  w.plain.place(view(q));
  w.plain.mass_matrix({w.mass.data(), w.n * w.n});
  return w.mass;
}

const VectorX& ArmEquations::acceleration(const VectorX& q, const VectorX& rate,
                                          const VectorX& torque) {
  Work& w = *work_;
  residual(q, rate, w.zero);
  w.plain.mass_matrix({w.mass.data(), w.n * w.n});
  if (!w.decomposed.compute(w.mass)) {
    throw Error(ErrorKind::singular_matrix, {.item = w.arm->settings().name},
                "its mass matrix is not positive definite in this pose",
                "spread the masses (centre: distributed), or check the angles");
  }
  w.acceleration.noalias() = w.arm->actuation() * torque;
  w.acceleration -= w.bias;
  w.decomposed.solve(w.acceleration, w.acceleration);
  return w.acceleration;
}

const MatrixX& ArmEquations::coriolis_matrix(const VectorX& q, const VectorX& rate) {
  // C_kj = 1/2 sum_i (dH_kj/dq_i + dH_ki/dq_j - dH_ij/dq_k) q'_i.
  Work& w = *work_;
  const std::size_t n = w.n;
  std::vector<MatrixX> slope(n, MatrixX::Zero(static_cast<Eigen::Index>(n), w.mass.cols()));
  if (!w.first) w.first = std::make_unique<ArmDynamics<First>>(w.arm);
  std::vector<First> values(n), mass(n * n);
  for (std::size_t k = 0; k < n; ++k) values[k] = q[static_cast<Eigen::Index>(k)];
  const auto direction = [&](std::size_t k) -> First::Lanes& { return values[k].grad; };
  in_passes<kDirections>(n, direction, [&](std::size_t from, std::size_t used) {
    w.first->place(view(values));
    w.first->mass_matrix({mass.data(), n * n});
    for (std::size_t d = 0; d < used; ++d) {
      for (std::size_t e = 0; e < n * n; ++e) slope[from + d].data()[e] = mass[e].grad[d];
    }
  });
  w.coriolis.setZero();
  const auto size = static_cast<Eigen::Index>(n);
  for (Eigen::Index k = 0; k < size; ++k) {
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = 0; i < size; ++i) {
        w.coriolis(k, j) +=
            0.5 * rate[i] *
            (slope[static_cast<std::size_t>(i)](k, j) + slope[static_cast<std::size_t>(j)](k, i) -
             slope[static_cast<std::size_t>(k)](i, j));
      }
    }
  }
  return w.coriolis;
}

const ArmEquations::Linearisation& ArmEquations::linearise(const VectorX& q, const VectorX& rate,
                                                           const VectorX& acceleration) {
  Work& w = *work_;
  if (w.planar) {
    w.planar->linearise(q, rate, acceleration, w.linear);
    return w.linear;
  }
  const std::size_t n = w.n;
  if (!w.first) w.first = std::make_unique<ArmDynamics<First>>(w.arm);
  if (w.first_q.empty()) {
    w.first_q.resize(n);
    w.first_rate.resize(n);
    w.first_acceleration.resize(n);
    w.first_result.resize(n);
  }
  for (std::size_t k = 0; k < n; ++k) {
    w.first_q[k] = q[static_cast<Eigen::Index>(k)];
    w.first_rate[k] = rate[static_cast<Eigen::Index>(k)];
    w.first_acceleration[k] = acceleration[static_cast<Eigen::Index>(k)];
  }
  const auto direction = [&](std::size_t k) -> First::Lanes& {
    return k < n ? w.first_q[k].grad : w.first_rate[k - n].grad;
  };
  in_passes<kDirections>(2 * n, direction, [&](std::size_t from, std::size_t used) {
    w.first->set(view(w.first_q), view(w.first_rate), view(w.first_acceleration));
    w.first->inverse_dynamics({w.first_result.data(), n});
    for (std::size_t d = 0; d < used; ++d) {
      const std::size_t k = from + d;
      MatrixX& matrix = k < n ? w.linear.by_position : w.linear.by_rate;
      const auto column = static_cast<Eigen::Index>(k % n);
      for (std::size_t i = 0; i < n; ++i) {
        matrix(static_cast<Eigen::Index>(i), column) = w.first_result[i].grad[d];
      }
    }
  });
  // dr/dq'' is H.
  w.plain.place(view(q));
  w.plain.mass_matrix({w.linear.by_acceleration.data(), n * n});
  for (std::size_t i = 0; i < n; ++i) {
    w.linear.residual[static_cast<Eigen::Index>(i)] = w.first_result[i].value;
  }
  return w.linear;
}

const MatrixX& ArmEquations::curvature(const VectorX& weights, const VectorX& q,
                                       const VectorX& rate, const VectorX& acceleration) {
  // S = weights . r is the virtual work of r on the variation dq = weights. Over particles, along
  // q(t) with these rates and accelerations,
  //   S = sum_p dx . (m (x'' - g) - f) + linear terms,   x' = J q', x'' = J q'' + J' q', dx = J dq,
  // and, since dx''/dq_k = J_k'', dx''/dq'_k = 2 J_k', dx''/dq''_k = J_k and d(dx)/dq_k = dJ_k,
  //   dS/dq_k = sum_p dJ_k . (m (x'' - g) - f) + m dx . J_k'',
  //   dS/dq'_k = 2 m dx . J_k',   dS/dq''_k = m dx . J_k.
  // Kinematics on numbers with time derivatives and variation gives all of these. If their parts
  // are dual numbers, it also gives the derivatives of the gradient.
  Work& w = *work_;
  const std::size_t n = w.n;
  const auto size = static_cast<Eigen::Index>(n);
  if (!w.second) {
    w.second = std::make_unique<ArmDynamics<Second>>(w.arm);
    w.second_q.resize(n);
    w.by_position.resize(n);
    w.by_rate.resize(n);
    w.by_acceleration.resize(n);
    w.curvature.setZero(3 * size, 3 * size);
  }
  for (std::size_t k = 0; k < n; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    w.second_q[k] = {q[i], rate[i], acceleration[i], weights[i]};
  }
  const auto direction = [&](std::size_t k) -> First::Lanes& {
    return k < n ? w.second_q[k].value.grad : w.second_q[k - n].rate.grad;
  };
  in_passes<kDirections>(2 * n, direction, [&](std::size_t from, std::size_t used) {
    w.second->place({w.second_q.data(), n});
    w.gradient_of_work();
    for (std::size_t d = 0; d < used; ++d) {
      const auto column = static_cast<Eigen::Index>(from + d);
      for (Eigen::Index k = 0; k < size; ++k) {
        const auto i = static_cast<std::size_t>(k);
        w.curvature(k, column) = w.by_position[i].grad[d];
        w.curvature(size + k, column) = w.by_rate[i].grad[d];
        w.curvature(2 * size + k, column) = w.by_acceleration[i].grad[d];
      }
    }
  });
  w.curvature.topRightCorner(2 * size, size) =
      w.curvature.bottomLeftCorner(size, 2 * size).transpose();
  return w.curvature;
}

const ArmEquations::ForwardDerivatives& ArmEquations::forward_derivatives(const VectorX& q,
                                                                          const VectorX& rate,
                                                                          const VectorX& torque) {
  Work& w = *work_;
  w.forward.acceleration = acceleration(q, rate, torque);
  linearise(q, rate, w.forward.acceleration);
  w.forward.by_position = -w.linear.by_position;
  w.forward.by_rate = -w.linear.by_rate;
  w.forward.by_torque = w.arm->actuation();
  for (MatrixX* columns : {&w.forward.by_position, &w.forward.by_rate, &w.forward.by_torque}) {
    w.decomposed.solve_columns(*columns, *columns);
  }
  return w.forward;
}

Points ArmEquations::endpoints(const VectorX& q) {
  Work& w = *work_;
  w.plain.place(view(q));
  Points result(w.arm->segments(), 3);
  for (int n = 0; n < w.arm->segments(); ++n) {
    const Vec3<double> x = w.plain.position({.segment = n});
    result.row(n) << x.x, x.y, x.z;
  }
  return result;
}

const MatrixX& ArmEquations::endpoint_jacobian(const VectorX& q) {
  Work& w = *work_;
  w.plain.place(view(q));
  for (int s = 0; s < w.arm->segments(); ++s) {
    w.plain.jacobian({s, 1.0, 0.0, 0.0}, w.columns);
    for (std::size_t k = 0; k < w.n; ++k) {
      w.ends.block<3, 1>(3 * s, static_cast<Eigen::Index>(k)) << w.columns[k].x, w.columns[k].y,
          w.columns[k].z;
    }
  }
  return w.ends;
}

ArmEquations::Energy ArmEquations::energy(const VectorX& q, const VectorX& rate) {
  Work& w = *work_;
  w.plain.set(view(q), view(rate), view(w.zero));
  return {w.plain.kinetic_energy(), w.plain.strain_energy(), w.plain.gravity_energy()};
}

ArmEquations::PointMotion ArmEquations::point(const ArmPoint& point, const VectorX& q,
                                              const VectorX& rate) {
  Work& w = *work_;
  const std::size_t n = w.n;
  if (!w.timed) w.timed = std::make_unique<ArmDynamics<Timed>>(w.arm);
  ArmDynamics<Timed>& moving = *w.timed;
  std::vector<Timed> values(n);
  for (std::size_t k = 0; k < n; ++k) {
    values[k].value = q[static_cast<Eigen::Index>(k)];
    values[k].grad[0] = rate[static_cast<Eigen::Index>(k)];
  }
  moving.place(view(values));
  std::vector<Vec3<Timed>> columns(n);
  moving.jacobian(point, columns);
  const auto plain = [](const Vec3<Timed>& v) { return Vector3(v.x.value, v.y.value, v.z.value); };
  PointMotion result{
      plain(moving.position(point)), {}, MatrixX(3, w.mass.cols()), MatrixX(3, w.mass.cols())};
  const Rotation<Timed> turned = moving.rotation(point);
  result.rotation << plain(turned.x), plain(turned.y), plain(turned.z);
  for (std::size_t k = 0; k < n; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    result.jacobian.col(column) = plain(columns[k]);
    result.jacobian_rate.col(column) << columns[k].x.grad[0], columns[k].y.grad[0],
        columns[k].z.grad[0];
  }
  return result;
}

}  // namespace sinew::pcc
