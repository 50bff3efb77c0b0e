// History of solid elements, viscoelasticity and softening: derivatives, relaxation, moduli over
// frequency, unloading, objectivity, threads.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/assembly.hpp"
#include "sinew/fem/element_history.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"

#include "allocation_counter.hpp"
#include "block_mesh.hpp"
#include "reference.hpp"

namespace sinew::fem {
namespace {

enum class ViscousKind { tetrahedra, patches, quadratic, hexahedra };

std::shared_ptr<const mesh::Mesh> box(ViscousKind kind, int n) {
  if (kind == ViscousKind::hexahedra) {
    return std::make_shared<mesh::Mesh>(mesh::block(
        {.size = {n * kEdge, n * kEdge, n * kEdge}, .cells = {n, n, n}}, mesh::Cells::hexahedra));
  }
  auto linear = block_mesh(n, n, n, kEdge, 0.1);
  if (kind != ViscousKind::quadratic) return linear;
  return std::make_shared<mesh::Mesh>(mesh::with_middle_nodes(*linear));
}

material::Hyperelastic rubber() {
  material::Hyperelastic law =
      material::ogden({{20e3, 1.7}, {-500.0, -3.4}}, material::OgdenConvention::mu_over_alpha);
  law.bulk_modulus = 4e5;
  law.prony = {{0.2, 0.05}, {0.15, 0.6}};
  return law;
}

material::Hyperelastic softening_rubber() {
  material::Hyperelastic law = rubber();
  law.prony.clear();
  law.mullins = {.r = 1.8, .m = 60.0, .beta = 0.2};
  return law;
}

material::Hyperelastic saint_venant() {
  material::Hyperelastic law = material::saint_venant_kirchhoff(6e4, 0.4);
  law.prony = rubber().prony;
  return law;
}

/// A body without fixed nodes, and its history.
struct Body {
  Body(ViscousKind kind, const material::Hyperelastic& law, int n = 2, int threads = 1)
      : model(std::make_shared<const FemModel>(box(kind, n), settings(kind, law))),
        pool(threads),
        assembly(model, pool),
        history(model->solids()) {
    assembly.set_history(&history);
  }
  static FemModelSettings settings(ViscousKind kind, const material::Hyperelastic& law) {
    FemModelSettings result;
    result.regions.push_back({.constants = {},
                              .density = 1000.0,
                              .hyperelastic = law,
                              .patches = kind == ViscousKind::patches});
    return result;
  }
  void step(const Points& x, double time_step) {
    history.begin_step(time_step);
    assembly.evaluate(x, {.tangent = Tangent::none});
    assembly.advance(x, history);
  }
  VectorX forces(const Points& x) {
    assembly.evaluate(x, {.tangent = Tangent::none});
    return Eigen::Map<const VectorX>(assembly.forces().data(), 3 * model->free_count());
  }
  double energy(const Points& x) {
    assembly.evaluate(x, {.tangent = Tangent::none});
    return assembly.strain_energy();
  }
  Points sheared(double gamma) const {
    Points x = model->mesh().nodes;
    x.col(0) += gamma * model->mesh().nodes.col(1);
    return x;
  }

  std::shared_ptr<const FemModel> model;
  ThreadPool pool;
  Assembly assembly;
  ElementHistory history;
};

class EveryViscousKind : public testing::TestWithParam<ViscousKind> {};
INSTANTIATE_TEST_SUITE_P(Viscous, EveryViscousKind,
                         testing::Values(ViscousKind::tetrahedra, ViscousKind::patches,
                                         ViscousKind::quadratic, ViscousKind::hexahedra));

void expect_derivatives(ViscousKind kind, const material::Hyperelastic& law) {
  Body body(kind, law);
  const mesh::Mesh& mesh = body.model->mesh();
  body.step(moved(mesh, kEdge, 0.07, 1), 0.02);
  body.step(moved(mesh, kEdge, 0.06, 2), 0.1);
  body.history.begin_step(0.03);
  const Points x = moved(mesh, kEdge, 0.06, 3);
  body.assembly.evaluate(x, {.tangent = Tangent::exact});
  const MatrixX matrix = dense_matrix(body.assembly);
  const VectorX forces = body.forces(x);
  const auto stepped = [&](Eigen::Index k, double by) {
    Points at = x;
    at(body.model->free_nodes()[static_cast<std::size_t>(k / 3)], k % 3) += by;
    return at;
  };
  constexpr double kStep = 1e-7;
  for (Eigen::Index k = 0; k < forces.size(); k += 7) {
    const Points ahead = stepped(k, kStep), behind = stepped(k, -kStep);
    EXPECT_NEAR(forces[k], (body.energy(ahead) - body.energy(behind)) / (2 * kStep),
                1e-6 * forces.cwiseAbs().maxCoeff());
    const VectorX difference = (body.forces(ahead) - body.forces(behind)) / (2 * kStep);
    EXPECT_LT((matrix.col(k) - difference).cwiseAbs().maxCoeff(),
              1e-6 * matrix.cwiseAbs().maxCoeff());
  }
}

TEST_P(EveryViscousKind, ForcesAndMatrixAreDerivativesOfTheIncrementalEnergy) {
  expect_derivatives(GetParam(), rubber());
}

TEST(Viscous, SaintVenantKirchhoffLikewise) {
  expect_derivatives(ViscousKind::hexahedra, saint_venant());
  expect_derivatives(ViscousKind::tetrahedra, saint_venant());
}

// Shear keeps the volume, so all of the stress relaxes: f(t) = f_law (1 + sum beta exp(-t/tau))
// after a sudden strain, for any step length.
TEST_P(EveryViscousKind, ASuddenStrainRelaxesAsTheSeriesSays) {
  for (const material::Hyperelastic& law : {rubber(), saint_venant()}) {
    if (GetParam() == ViscousKind::patches && law.saint_venant_shear > 0.0)
      continue;  // rejected for this law
    material::Hyperelastic elastic = law;
    elastic.prony.clear();
    Body body(GetParam(), law), slow(GetParam(), elastic);
    const Points x = body.sheared(0.4);
    const VectorX still = slow.forces(x);
    double time = 0.0;
    body.step(x, 1e-9);
    for (const double h : {0.01, 0.003, 0.2, 0.05, 1.0}) {
      time += h;
      body.history.begin_step(h);
      double expected = 1.0;
      for (const material::PronyTerm& term : law.prony) {
        expected +=
            term.relative_modulus / law.long_term_share() * std::exp(-time / term.relaxation_time);
      }
      const VectorX forces = body.forces(x);
      EXPECT_LT((forces - expected * still).norm(), 1e-7 * forces.norm()) << time;
      body.assembly.advance(x, body.history);
    }
    body.history.begin_step(0.0);  // statics
    EXPECT_LT((body.forces(x) - still).norm(), 1e-13 * still.norm());
  }
}

/// G' and G'' relative to the law's mu, from the force on one node in the third cycle of a small
/// sinusoidal shear.
std::complex<double> complex_modulus(double omega, int steps) {
  material::Hyperelastic law = rubber();
  Body body(ViscousKind::hexahedra, law, 1);
  law.prony.clear();
  Body slow(ViscousKind::hexahedra, law, 1);
  constexpr double kAmplitude = 1e-4;
  const VectorX unit = slow.forces(slow.sheared(kAmplitude));
  const double h = 2.0 * std::numbers::pi / omega / steps;
  std::complex<double> sum = 0.0;
  const int settle = steps * static_cast<int>(std::ceil(8.0 * 0.6 * omega / 6.28) + 1);
  for (int k = 1; k <= settle + steps; ++k) {
    const double phase = omega * h * k;
    const Points x = body.sheared(kAmplitude * std::sin(phase));
    body.history.begin_step(h);
    const double share = body.forces(x).dot(unit) / unit.squaredNorm();
    body.assembly.advance(x, body.history);
    if (k > settle) {
      sum += 2.0 / steps * share * std::complex<double>(std::sin(phase), std::cos(phase));
    }
  }
  return sum;
}

TEST(Viscous, StorageAndLossModuliAreThoseOfTheSeries) {
  const material::Hyperelastic law = rubber();
  for (const double omega : {1.0, 10.0, 100.0}) {
    std::complex<double> expected = 1.0;
    for (const material::PronyTerm& term : law.prony) {
      const std::complex<double> x(0.0, omega * term.relaxation_time);
      expected += term.relative_modulus / law.long_term_share() * x / (1.0 + x);
    }
    const double coarse = std::abs(complex_modulus(omega, 40) - expected);
    const double fine = std::abs(complex_modulus(omega, 80) - expected);
    EXPECT_LT(fine, 1e-3 * std::abs(expected)) << omega;
    EXPECT_NEAR(coarse / fine, 4.0, 0.4) << omega;  // second order
  }
}

TEST_P(EveryViscousKind, SoftenedForcesAreDerivativesToo) {
  expect_derivatives(GetParam(), softening_rubber());
  material::Hyperelastic both = softening_rubber();
  both.prony = rubber().prony;
  expect_derivatives(GetParam(), both);
}

// Shear keeps the volume, so all of the stress softens by the formula of Ogden and Roxburgh.
TEST_P(EveryViscousKind, UnloadingFollowsOgdenAndRoxburgh) {
  const material::Hyperelastic law = softening_rubber();
  material::Hyperelastic elastic = law;
  elastic.mullins.reset();
  Body body(GetParam(), law), virgin(GetParam(), elastic);
  const auto forces_at = [&](double gamma) {
    body.history.begin_step(0.0);
    VectorX result = body.forces(body.sheared(gamma));
    body.assembly.advance(body.sheared(gamma), body.history);
    return result;
  };
  const auto energy_at = [&](double gamma) {  // stretches of simple shear
    const double l = 0.5 * (gamma + std::sqrt(gamma * gamma + 4.0));
    return material::respond(elastic, {l, 1.0 / l, 1.0}).energy;
  };
  double largest = 0.0;
  for (const double gamma : {0.2, 0.5, 0.4, 0.1, 0.3, 0.5, 0.7, 0.6}) {
    const VectorX found = forces_at(gamma), law_forces = virgin.forces(virgin.sheared(gamma));
    const double w = energy_at(gamma);
    largest = std::max(largest, w);
    const double eta =
        1.0 -
        std::erf((largest - w) / (law.mullins->m + law.mullins->beta * largest)) / law.mullins->r;
    EXPECT_LT((found - eta * law_forces).norm(), 1e-9 * law_forces.norm()) << gamma;
    EXPECT_LT(gamma == 0.1 ? eta : 0.0, 0.6);  // softening is active
  }
}

TEST_P(EveryViscousKind, ARotationOnTheWayTurnsTheForcesAlone) {
  Body body(GetParam(), rubber()), turned(GetParam(), rubber());
  const mesh::Mesh& mesh = body.model->mesh();
  VectorX forces, other;
  Matrix3 q = Matrix3::Identity();
  for (unsigned k = 1; k <= 3; ++k) {
    const Points x = moved(mesh, kEdge, 0.05, k);
    q = Eigen::AngleAxisd(0.9 * k, Vector3(1, k, -2).normalized()).toRotationMatrix();
    body.history.begin_step(0.04);
    turned.history.begin_step(0.04);
    forces = body.forces(x);
    other = turned.forces(x * q.transpose());
    body.assembly.advance(x, body.history);
    turned.assembly.advance(x * q.transpose(), turned.history);
  }
  double worst = 0.0;
  for (Eigen::Index i = 0; i < forces.size(); i += 3) {
    worst = std::max(worst, (q * forces.segment<3>(i) - other.segment<3>(i)).norm());
  }
  EXPECT_LT(worst, 1e-10 * forces.norm());
}

TEST_P(EveryViscousKind, ThreadsDoNotChangeABitAndNothingAllocates) {
  Body one(GetParam(), rubber(), 3), four(GetParam(), rubber(), 3, 4);
  const mesh::Mesh& mesh = one.model->mesh();
  for (unsigned k = 1; k <= 3; ++k) {
    const Points x = moved(mesh, kEdge, 0.05, k);
    const std::size_t before = allocation_count();
    for (Body* body : {&one, &four}) {
      body->history.begin_step(0.02 * k);
      body->assembly.evaluate(x, {.tangent = Tangent::corotated});
      body->assembly.advance(x, body->history);
    }
    EXPECT_EQ(allocation_count(), before);
    EXPECT_TRUE(std::ranges::equal(one.assembly.forces(), four.assembly.forces()));
  }
  std::vector<double> own(one.history.size()), other(four.history.size());
  one.history.save(own);
  four.history.save(other);
  EXPECT_EQ(own, other);
  EXPECT_GT(std::ranges::max(own), 0.0);
}

TEST(Viscous, RefusesSeriesThatLeaveNothing) {
  material::Hyperelastic law = softening_rubber();
  law.mullins->r = 1.0;
  EXPECT_THROW(law.validate("material"), Error);
  law.mullins = material::MullinsEffect{.r = 2.0, .m = 0.0, .beta = 0.0};
  EXPECT_THROW(law.validate("material"), Error);
  law = rubber();
  law.prony.push_back({0.7, 1.0});
  EXPECT_THROW(law.validate("material"), Error);
  law.prony = {{0.2, 0.0}};
  EXPECT_THROW(law.validate("material"), Error);
  law.prony = {{-0.2, 1.0}};
  EXPECT_THROW(law.validate("material"), Error);
  law = rubber();
  const material::Hyperelastic relaxed = material::relaxed(law);
  EXPECT_NEAR(relaxed.shear_modulus(), 0.65 * law.shear_modulus(), 1e-12 * law.shear_modulus());
  EXPECT_EQ(relaxed.bulk_modulus, law.bulk_modulus);
}

}  // namespace
}  // namespace sinew::fem
