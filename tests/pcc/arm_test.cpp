// Equations of motion of constant-curvature arms: transforms, derivatives, structure, energy.
#include "sinew/pcc/arm.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/pcc/arm_dynamics.hpp"
#include "sinew/pcc/arm_equations.hpp"
#include "sinew/pcc/stumpff.hpp"

#include "arms.hpp"

namespace sinew::pcc {
namespace {

using testing::fluidic;
using testing::make;
using testing::mixed;
using testing::planar;
using testing::random_vector;
using Complex = std::complex<double>;

TEST(Stumpff, IsSineAndCosineEverywhere) {
  for (const double angle : {0.0, 1e-8, 1e-3, 0.5, 1.7, 3.0, 3.1622, 3.1623, 4.0, 9.0, 30.0}) {
    const auto c = stumpff<8>(angle * angle);
    EXPECT_NEAR(c[0], std::cos(angle), 4e-15) << angle;
    EXPECT_NEAR(c[1], angle == 0.0 ? 1.0 : std::sin(angle) / angle, 4e-15) << angle;
    const double half = std::sin(0.5 * angle);
    EXPECT_NEAR(c[2], angle == 0.0 ? 0.5 : 2.0 * half * half / (angle * angle), 2e-15) << angle;
    if (angle > 0.4) {
      EXPECT_NEAR(c[3], (angle - std::sin(angle)) / std::pow(angle, 3), 2e-15) << angle;
    }
    for (std::size_t k = 0; k + 2 < c.size(); ++k) {
      EXPECT_NEAR(c[k] + angle * angle * c[k + 2], 1.0 / std::tgamma(static_cast<double>(k) + 1.0),
                  1e-14)
          << angle;
    }
  }
}

TEST(Stumpff, DerivativesAgreeWithComplexStep) {
  for (const double s : {0.0, 0.3, 4.0, 9.9, 10.1, 40.0}) {
    const double tiny = 1e-30;
    const auto by_step = stumpff<7>(Complex(s, tiny));
    const auto first = stumpff<7>(Dual<2>::variable(s, 1));
    const auto second = stumpff<7>(Varied<double>(s, 1.0, 0.0, 1.0));
    const auto slope_after = stumpff<7>(Dual<1>::variable(s + 1e-5, 0));
    const auto slope_before = stumpff<7>(Dual<1>::variable(s - 1e-5, 0));
    for (std::size_t k = 0; k < 7; ++k) {
      EXPECT_NEAR(first[k].grad[1], by_step[k].imag() / tiny, 1e-14) << s << " " << k;
      EXPECT_EQ(first[k].grad[0], 0.0);
      EXPECT_NEAR(second[k].rate, first[k].grad[1], 1e-14);
      EXPECT_NEAR(second[k].variation, first[k].grad[1], 1e-14);
      EXPECT_NEAR(second[k].acceleration, (slope_after[k].grad[0] - slope_before[k].grad[0]) / 2e-5,
                  1e-9);
    }
  }
}

TEST(Transform, IsTheProductOfItsFactors) {
  // R_z(gamma) T_z(L_P) R_y(theta/2) T_z(d) R_y(theta/2), after the base R_x(pi).
  ArmSettings settings = fluidic();
  settings.segments.resize(2);
  settings.segments[0].gamma = 0.7;
  settings.segments[0].dead_length = 0.03;
  settings.segments[1].gamma = -0.2;
  const VectorX q{{1.2, -0.8}};
  Eigen::Isometry3d expected(Eigen::AngleAxisd(std::numbers::pi, Vector3::UnitX()));
  for (int n = 0; n < 2; ++n) {
    const Segment& segment = settings.segments[static_cast<std::size_t>(n)];
    const Eigen::AngleAxisd half(0.5 * q[n], Vector3::UnitY());
    const double chord = 2.0 * std::sin(0.5 * q[n]) / (q[n] / segment.length);
    expected = expected * Eigen::AngleAxisd(segment.gamma, Vector3::UnitZ()) *
               Eigen::Translation3d(0, 0, segment.dead_length) * half *
               Eigen::Translation3d(0, 0, chord) * half;
  }
  ArmEquations equations(make(settings));
  const auto tip = equations.point({.segment = 1}, q, VectorX::Zero(2));
  EXPECT_NEAR((tip.position - expected.translation()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((tip.rotation - expected.linear()).norm(), 0.0, 1e-14);
}

TEST(Transform, HangsAndBendsTowardsX) {
  ArmEquations equations(make(fluidic()));
  const Points straight = equations.endpoints(VectorX::Zero(4));
  EXPECT_NEAR(straight(3, 2), -0.56, 1e-15);
  EXPECT_EQ(straight(3, 0), 0.0);
  const Points bent = equations.endpoints(VectorX::Constant(4, 0.1));
  EXPECT_GT(bent(3, 0), 0.05);
}

TEST(Transform, SpatialSegmentInOnePlaneIsThePlanarOne) {
  ArmSettings planar = fluidic(), spatial = fluidic();
  for (Segment& segment : spatial.segments) segment.bending = Bending::spatial;
  const VectorX q{{0.9, -0.4, 0.2, 1.4}}, rate{{0.3, 1.0, -2.0, 0.7}};
  VectorX q2 = VectorX::Zero(8), rate2 = VectorX::Zero(8);
  for (int n = 0; n < 4; ++n) {
    q2[2 * n] = q[n];
    rate2[2 * n] = rate[n];
  }
  ArmEquations one(make(planar)), two(make(spatial));
  EXPECT_NEAR((one.endpoints(q) - two.endpoints(q2)).norm(), 0.0, 1e-15);
  const VectorX a = one.acceleration(q, rate, VectorX::Zero(4));
  const VectorX b = two.acceleration(q2, rate2, VectorX::Zero(8));
  for (int n = 0; n < 4; ++n) {
    EXPECT_NEAR(a[n], b[2 * n], 1e-9 * a.norm());
    EXPECT_NEAR(b[2 * n + 1], 0.0, 1e-9 * a.norm());
  }
}

TEST(Centres, ArcAndChordAreWhereTheyAreSaidToBe) {
  const double angle = 0.9, length = 0.14;
  for (const MassCentre centre : {MassCentre::arc, MassCentre::chord}) {
    ArmSettings settings = fluidic(centre);
    settings.segments.resize(1);
    settings.segments[0].stiffness = 0.0;
    ArmEquations equations(make(settings));
    const double half = 0.5 * angle, chord = 2.0 * length * std::sin(half) / angle;
    const double below =
        centre == MassCentre::arc ? length * std::sin(half) / angle : 0.5 * chord * std::cos(half);
    const auto energy = equations.energy(VectorX::Constant(1, angle), VectorX::Zero(1));
    EXPECT_NEAR(energy.gravity, -0.190 * 9.81 * below, 1e-15);
  }
}

TEST(Pendulum, ShortStiffSegmentWithAMassIsOne) {
  // A short bend with the mass far below is a pendulum, theta'' = -(g/l) sin theta.
  ArmSettings settings = fluidic();
  settings.segments.resize(2);
  settings.segments[0].length = 1e-5;
  settings.segments[0].stiffness = 0.0;
  settings.segments[0].damping = 0.0;
  settings.segments[0].mass = 1e-12;
  settings.segments[1].dead_length = 0.5;
  settings.segments[1].length = 1e-5;
  settings.segments[1].mass = 0.3;
  settings.segments[1].stiffness = 1e3;
  settings.segments[1].damping = 0.0;
  ArmEquations equations(make(settings));
  // With the second bend held straight, the first row of r is m l^2 theta'' + m g l sin theta.
  const double angle = 0.8;
  const VectorX r =
      equations.residual(VectorX{{angle, 0.0}}, VectorX{{1.3, 0.0}}, VectorX{{2.0, 0.0}});
  EXPECT_NEAR(r[0], 0.3 * 0.25 * 2.0 + 0.3 * 9.81 * 0.5 * std::sin(angle), 1e-4);
}

class ArmKinds : public ::testing::TestWithParam<std::pair<const char*, ArmSettings>> {
 protected:
  ArmKinds() : arm(make(GetParam().second)), equations(arm), n(arm->coordinates()) {}
  std::shared_ptr<const Arm> arm;
  ArmEquations equations;
  Eigen::Index n;
  std::mt19937 random{7};
};

TEST_P(ArmKinds, MassMatrixIsSymmetricPositiveDefinite) {
  for (int trial = 0; trial < 200; ++trial) {
    const MatrixX mass = equations.mass_matrix(random_vector(random, n, 1.5));
    EXPECT_EQ((mass - mass.transpose()).norm(), 0.0);
    EXPECT_GT(linalg::symmetric_eigenvalues(mass)[0], 0.0);
  }
}

TEST_P(ArmKinds, CoriolisMatrixGivesTheForcesAndLeavesASkewMatrix) {
  for (int trial = 0; trial < 20; ++trial) {
    const VectorX q = random_vector(random, n, 1.5), rate = random_vector(random, n, 3.0);
    const VectorX still = VectorX::Zero(n);
    const MatrixX coriolis = equations.coriolis_matrix(q, rate);
    const double step = 1e-6;
    const MatrixX after = equations.mass_matrix(q + step * rate);
    const MatrixX before = equations.mass_matrix(q - step * rate);
    const MatrixX skew = (after - before) / (2.0 * step) - 2.0 * coriolis;
    EXPECT_LT((skew + skew.transpose()).norm(), 1e-7 * (1.0 + coriolis.norm()));
    const VectorX fast = equations.residual(q, rate, still);
    const VectorX slow = equations.residual(q, still, still);
    const VectorX damped = arm->damping().cwiseProduct(rate);
    EXPECT_LT((fast - slow - damped - coriolis * rate).norm(), 1e-12);
  }
}

TEST_P(ArmKinds, ResidualIsThatOfTheLagrangian) {
  // d/dt dT/dq' - dT/dq + dV/dq + b q' by finite differences of the energies only.
  const VectorX q = random_vector(random, n, 1.0), rate = random_vector(random, n, 2.0);
  const VectorX acceleration = random_vector(random, n, 5.0);
  const double h = 1e-5;
  const auto momentum = [&](double t, Eigen::Index k) {
    const VectorX at = q + t * rate + 0.5 * t * t * acceleration;
    VectorX up = rate + t * acceleration, down = up;
    up[k] += 0.1;  // T is quadratic in the rates, so differences are exact
    down[k] -= 0.1;
    return (equations.energy(at, up).kinetic - equations.energy(at, down).kinetic) / 0.2;
  };
  const VectorX r = equations.residual(q, rate, acceleration);
  for (Eigen::Index k = 0; k < n; ++k) {
    VectorX up = q, down = q;
    up[k] += h;
    down[k] -= h;
    const auto above = equations.energy(up, rate), below = equations.energy(down, rate);
    const double expected =
        (momentum(h, k) - momentum(-h, k)) / (2.0 * h) -
        (above.kinetic - below.kinetic) / (2.0 * h) +
        (above.strain + above.gravity - below.strain - below.gravity) / (2.0 * h) +
        arm->damping()[k] * rate[k];
    EXPECT_NEAR(r[k], expected, 1e-7 * (1.0 + r.norm())) << k;
  }
}

TEST_P(ArmKinds, DerivativesAgreeWithComplexStep) {
  const VectorX q = random_vector(random, n, 1.0), rate = random_vector(random, n, 2.0);
  const VectorX acceleration = random_vector(random, n, 5.0);
  const auto linear = equations.linearise(q, rate, acceleration);
  EXPECT_LT((linear.by_acceleration - equations.mass_matrix(q)).norm(), 1e-14);
  const VectorX residual = equations.residual(q, rate, acceleration);
  EXPECT_LT((linear.residual - residual).norm(), 1e-14 * (1.0 + residual.norm()));
  ArmDynamics<Complex> complex(arm);
  const double tiny = 1e-30;
  const auto size = static_cast<std::size_t>(n);
  for (int which = 0; which < 3; ++which) {
    const MatrixX& ours = which == 0   ? linear.by_position
                          : which == 1 ? linear.by_rate
                                       : linear.by_acceleration;
    for (Eigen::Index k = 0; k < n; ++k) {
      Eigen::VectorXcd state[3] = {q.cast<Complex>(), rate.cast<Complex>(),
                                   acceleration.cast<Complex>()};
      state[which][k] += Complex(0.0, tiny);
      Eigen::VectorXcd result(n);
      complex.set({state[0].data(), size}, {state[1].data(), size}, {state[2].data(), size});
      complex.inverse_dynamics({result.data(), size});
      for (Eigen::Index i = 0; i < n; ++i) {
        EXPECT_NEAR(ours(i, k), result[i].imag() / tiny, 1e-12 * (1.0 + ours.norm()));
      }
    }
  }
}

TEST_P(ArmKinds, CurvatureAgreesWithDifferencesOfTheDerivatives) {
  const VectorX q = random_vector(random, n, 1.0), rate = random_vector(random, n, 2.0);
  const VectorX acceleration = random_vector(random, n, 5.0),
                weights = random_vector(random, n, 1.0);
  const MatrixX curvature = equations.curvature(weights, q, rate, acceleration);
  const double h = 1e-5;
  for (Eigen::Index k = 0; k < 3 * n; ++k) {
    const auto gradient = [&](double step) {
      VectorX state(3 * n);
      state << q, rate, acceleration;
      state[k] += step;
      const auto& linear = equations.linearise(state.head(n), state.segment(n, n), state.tail(n));
      VectorX result(3 * n);
      result << linear.by_position.transpose() * weights, linear.by_rate.transpose() * weights,
          linear.by_acceleration.transpose() * weights;
      return result;
    };
    const VectorX expected = (gradient(h) - gradient(-h)) / (2.0 * h);
    EXPECT_LT((curvature.col(k) - expected).norm(), 1e-8 * (1.0 + curvature.norm())) << k;
  }
}

TEST_P(ArmKinds, ForwardDynamicsInvertsInverseDynamics) {
  const VectorX q = random_vector(random, n, 1.0), rate = random_vector(random, n, 2.0);
  const VectorX torque = random_vector(random, n, 0.1);
  const VectorX acceleration = equations.acceleration(q, rate, torque);
  EXPECT_LT((equations.residual(q, rate, acceleration) - torque).norm(), 1e-11);
  const auto forward = equations.forward_derivatives(q, rate, torque);
  // Uses complex steps, since lumped masses make H nearly singular and its inverse steep.
  ArmDynamics<Complex> complex(arm);
  const auto size = static_cast<std::size_t>(n);
  const double tiny = 1e-30;
  for (const bool of_rate : {false, true}) {
    for (Eigen::Index k = 0; k < n; ++k) {
      Eigen::VectorXcd state[2] = {q.cast<Complex>(), rate.cast<Complex>()};
      state[of_rate ? 1 : 0][k] += Complex(0.0, tiny);
      const Eigen::VectorXcd still = Eigen::VectorXcd::Zero(n);
      Eigen::VectorXcd bias(n);
      Eigen::MatrixXcd mass(n, n);
      complex.set({state[0].data(), size}, {state[1].data(), size}, {still.data(), size});
      complex.inverse_dynamics({bias.data(), size});
      complex.mass_matrix({mass.data(), size * size});
      // Re M a'' + Im M a' = -Im b for the imaginary part a'' of M a = tau - b.
      const VectorX real = linalg::solve(mass.real(), torque - bias.real());
      const VectorX expected = linalg::solve(mass.real(), -bias.imag() - mass.imag() * real) / tiny;
      const MatrixX& ours = of_rate ? forward.by_rate : forward.by_position;
      EXPECT_LT((ours.col(k) - expected).norm(), 1e-9 * (1.0 + expected.norm()));
    }
  }
  EXPECT_LT((equations.mass_matrix(q) * forward.by_torque - arm->actuation()).norm(), 1e-11);
}

TEST_P(ArmKinds, PointsMoveByTheirJacobian) {
  const VectorX q = random_vector(random, n, 1.0), rate = random_vector(random, n, 2.0);
  const ArmPoint place{arm->segments() - 1, 0.6, 0.01, -0.02, 0.005};
  const auto here = equations.point(place, q, rate);
  const double h = 1e-6;
  const auto after = equations.point(place, q + h * rate, rate);
  const auto before = equations.point(place, q - h * rate, rate);
  EXPECT_LT(((after.position - before.position) / (2.0 * h) - here.jacobian * rate).norm(), 1e-8);
  EXPECT_LT(((after.jacobian - before.jacobian) / (2.0 * h) - here.jacobian_rate).norm(), 1e-7);
}

TEST_P(ArmKinds, SectionsTurnByTheirAngularJacobian) {
  const VectorX q = random_vector(random, n, 1.0), rate = random_vector(random, n, 2.0);
  ArmDynamics<double> dynamics(arm);
  const auto numbers = [](const VectorX& v) {
    return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
  };
  for (int segment = 0; segment < arm->segments(); ++segment) {
    const ArmPoint place{segment, 0.6, 0.01, -0.02, 0.005};
    const double h = 1e-6;
    const auto rotation = [&](double time) {
      const VectorX moved = q + time * rate;
      dynamics.place(numbers(moved));
      return plain(dynamics.rotation(place));
    };
    const Matrix3 spin = (rotation(h) - rotation(-h)) / (2.0 * h) * rotation(0.0).transpose();
    dynamics.set(numbers(q), numbers(rate), numbers(rate));
    const Vector3 omega = plain(dynamics.angular_velocity(place));
    EXPECT_LT((omega - Vector3(spin(2, 1), spin(0, 2), spin(1, 0))).norm(), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ArmKinds,
    ::testing::Values(std::pair("arc", fluidic(MassCentre::arc)),
                      std::pair("chord", fluidic(MassCentre::chord)),
                      std::pair("distributed", fluidic(MassCentre::distributed)),
                      std::pair("planar", planar()), std::pair("mixed", mixed())),
    [](const auto& kind) { return std::string(kind.param.first); });

TEST(Arm, BadNumbersAreErrors) {
  const auto refused = [](auto change) {
    ArmSettings settings = fluidic();
    change(settings);
    try {
      const Arm arm(settings);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused([](ArmSettings& s) {
              s.segments[2].mass = -0.1;
            }).find("segment 2 of fluidic arm: its mass is -0.1 kg"),
            std::string::npos);
  EXPECT_NE(refused([](ArmSettings& s) { s.segments[0].length = 0.0; }).find("its length is 0 m"),
            std::string::npos);
  EXPECT_NE(
      refused([](ArmSettings& s) { s.segments[1].stiffness = std::nan(""); }).find("not finite"),
      std::string::npos);
  EXPECT_NE(refused([](ArmSettings& s) { s.segments.clear(); }).find("no segments"),
            std::string::npos);
  EXPECT_NE(
      refused([](ArmSettings& s) { s.actuation = MatrixX::Identity(3, 3); }).find("4 coordinates"),
      std::string::npos);
  EXPECT_NE(refused([](ArmSettings& s) { s.segments[0].extensible = true; }).find("planar"),
            std::string::npos);
  EXPECT_NE(refused([](ArmSettings& s) {
              s.loads.push_back({4, 0.5, {}});
            }).find("segment 4"),
            std::string::npos);
}

}  // namespace
}  // namespace sinew::pcc
