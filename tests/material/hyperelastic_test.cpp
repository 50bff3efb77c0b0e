// Hyperelastic laws: energies, stresses and tangents against differences, coefficients against
// their known meaning, stability against its known limit.
#include "sinew/material/hyperelastic.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/material/principal.hpp"
#include "sinew/material/scaled.hpp"

#include "lane_matrices.hpp"

namespace sinew::material {
namespace {

using Stretches = std::array<double, 3>;

struct NamedLaw {
  std::string name;
  Hyperelastic law;
};

std::ostream& operator<<(std::ostream& out, const NamedLaw& law) { return out << law.name; }

Hyperelastic with_bulk(Hyperelastic law, double bulk) {
  law.bulk_modulus = bulk;
  return law;
}

std::vector<NamedLaw> laws() {
  return {{"neo_hookean", with_bulk(neo_hookean(1.3), 7.0)},
          {"mooney_rivlin", with_bulk(mooney_rivlin(0.8, 0.3), 7.0)},
          {"yeoh", with_bulk(yeoh({0.6, -0.02, 0.01}), 7.0)},
          {"ogden",
           with_bulk(ogden({{1.2, 1.7}, {0.01, 7.1}, {-0.4, -2.4}}, OgdenConvention::mu_over_alpha),
                     7.0)},
          {"arruda_boyce", with_bulk(arruda_boyce(1.1, 2.5), 7.0)},
          {"saint_venant_kirchhoff", saint_venant_kirchhoff(3.0, 0.3)}};
}

class EveryEnergy : public testing::TestWithParam<NamedLaw> {
 protected:
  const Hyperelastic& law() const { return GetParam().law; }

  Lanes9x9 tangent_at(const Matrix3& f, Projection projection) const {
    const Lanes3x3 lanes_f = broadcast(f);
    const Principal at = principal(lanes_f);
    Lanes9x9 result;
    tangent(lanes_f, at, response_at(at), projection, result);
    return result;
  }
  LanesLogResponse response_at(const Principal& at) const {
    LanesLogResponse response = respond(law(), at);
    if (law().saint_venant_shear == 0.0) {
      add_volumetric(response, at.determinant, law().bulk_modulus);
    }
    return response;
  }
  double energy(const Matrix3& f) const { return response_at(principal(broadcast(f))).energy[5]; }
  Matrix3 stress(const Matrix3& f) const {
    const Lanes3x3 lanes_f = broadcast(f);
    const Principal at = principal(lanes_f);
    return lane_of(first_piola(lanes_f, at, response_at(at)), 5);
  }
  static std::vector<Matrix3> gradients() {
    RandomMatrices random;
    std::vector<Matrix3> list = {Matrix3::Identity(),
                                 random.rotation(),
                                 random.with_stretches(1.3, 1.3, 1.3),
                                 random.with_stretches(1.4, 1.4, 0.6),
                                 random.with_stretches(0.7, 1.2, 1.2),
                                 random.with_stretches(1.2, 1.2 + 3e-5, 0.8),
                                 random.with_stretches(1.2, 1.2 + 5e-4, 1.2 - 5e-4),
                                 random.with_stretches(0.35, 1.1, 2.2)};
    for (int k = 0; k < 8; ++k) {
      Matrix3 f = Matrix3::Identity() + random.entries(0.3);
      list.push_back(random.rotation() * f);
    }
    return list;
  }
};

TEST_P(EveryEnergy, LogDerivativesAreThoseOfTheEnergy) {
  constexpr double kStep = 1e-5;
  for (const Stretches l : {Stretches{1.0, 1.0, 1.0}, Stretches{1.3, 0.8, 0.9},
                            Stretches{2.0, 0.6, 0.6}, Stretches{0.5, 1.1, 1.7}}) {
    const LogResponse here = respond(law(), l);
    for (std::size_t i = 0; i < 3; ++i) {
      Stretches up = l, down = l;
      up[i] *= std::exp(kStep);
      down[i] *= std::exp(-kStep);
      const LogResponse above = respond(law(), up), below = respond(law(), down);
      const double scale = 1.0 + std::abs(here.first[i]);
      EXPECT_NEAR(here.first[i], (above.energy - below.energy) / (2 * kStep), 1e-8 * scale);
      for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_NEAR(here.second[i][j], (above.first[j] - below.first[j]) / (2 * kStep),
                    1e-7 * (1.0 + std::abs(here.second[i][j])));
      }
    }
  }
}

TEST_P(EveryEnergy, LanesSayWhatScalarsSay) {
  for (const Matrix3& f : gradients()) {
    const Principal at = principal(broadcast(f));
    const Stretches l = {at.stretch[0][2], at.stretch[1][2], at.stretch[2][2]};
    const LogResponse scalar = respond(law(), l);
    const LanesLogResponse wide = response_at(at);
    EXPECT_NEAR(wide.energy[2], scalar.energy, 1e-12 * (1.0 + std::abs(scalar.energy)));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(wide.first[i][2], scalar.first[i], 1e-11 * (1.0 + std::abs(scalar.first[i])));
      for (std::size_t j = 0; j <= i; ++j) {
        EXPECT_NEAR(wide.second[i][j][2], scalar.second[i][j],
                    1e-11 * (1.0 + std::abs(scalar.second[i][j])));
      }
    }
  }
}

TEST_P(EveryEnergy, StressIsTheDerivativeOfTheEnergy) {
  constexpr double kStep = 1e-5;
  for (const Matrix3& f : gradients()) {
    const Matrix3 p = stress(f);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const Matrix3 step = kStep * Vector3::Unit(r) * Vector3::Unit(c).transpose();
        const double difference = (energy(f + step) - energy(f - step)) / (2 * kStep);
        EXPECT_NEAR(p(r, c), difference, 3e-8 * (1.0 + p.norm()));
      }
    }
  }
}

TEST_P(EveryEnergy, TangentIsTheDerivativeOfTheStress) {
  constexpr double kStep = 1e-5;
  for (const Matrix3& f : gradients()) {
    const Lanes9x9 a = tangent_at(f, Projection::none);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        const Matrix3 step = kStep * Vector3::Unit(k) * Vector3::Unit(l).transpose();
        const Matrix3 difference = (stress(f + step) - stress(f - step)) / (2 * kStep);
        const double scale = 1.0 + difference.norm();
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) {
            // Near equal stretches the limit replaces the quotient: stretches 1e-4 apart give an
            // error of 1e-8.
            EXPECT_NEAR(a.m[3 * r + c][3 * k + l][4], difference(r, c), 2e-7 * scale);
          }
        }
      }
    }
  }
}

TEST_P(EveryEnergy, TheProjectionIsTheNearestPositiveOne) {
  using Matrix9 = Eigen::Matrix<double, 9, 9>;
  const auto dense = [](const Lanes9x9& a) {
    Matrix9 m;
    for (int r = 0; r < 9; ++r) {
      for (int c = 0; c < 9; ++c) m(r, c) = a.m[r][c][6];
    }
    return m;
  };
  int indefinite = 0;
  for (const Matrix3& f : gradients()) {
    const Matrix9 a = dense(tangent_at(f, Projection::none)),
                  projected = dense(tangent_at(f, Projection::positive));
    const linalg::SymmetricSpectrum spectrum(a);
    const MatrixX expected = spectrum.vectors() * spectrum.values().cwiseMax(0.0).asDiagonal() *
                             spectrum.vectors().transpose();
    indefinite += spectrum.values().minCoeff() < -1e-6 ? 1 : 0;
    EXPECT_LT((projected - expected).norm(), 1e-9 * (1.0 + a.norm()));
    Eigen::Matrix<double, 9, 3> spins;  // W F for spins about the axes
    for (int k = 0; k < 3; ++k) {
      const Matrix3 spin = cross_matrix(Vector3::Unit(k)) * f;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) spins(3 * r + c, k) = spin(r, c);
      }
    }
    const Matrix9 rest =
        Matrix9::Identity() - spins * (spins.transpose() * spins).inverse() * spins.transpose();
    const Matrix9 rates = dense(tangent_at(f, Projection::rates));
    EXPECT_LT((rates - rest * projected * rest).norm(), 1e-9 * (1.0 + a.norm()));
    EXPECT_LT((rates * spins).norm(), 1e-9 * (1.0 + a.norm()));
  }
  EXPECT_GT(indefinite, 0) << "nothing was to be projected";
}

TEST_P(EveryEnergy, AtRestItIsHookesLaw) {
  const double mu = law().shear_modulus(), kappa = law().bulk_modulus;
  const Lanes9x9 a = tangent_at(Matrix3::Identity(), Projection::none);
  const double lambda = kappa - 2.0 / 3.0 * mu;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) {
          const double expected =
              lambda * (r == c && k == l) + mu * (r == k && c == l) + mu * (r == l && c == k);
          EXPECT_NEAR(a.m[3 * r + c][3 * k + l][0], expected, 1e-10 * (mu + kappa));
        }
      }
    }
  }
  EXPECT_LT(stress(Matrix3::Identity()).norm(), 1e-14);
  const double e = law().young_modulus(), nu = law().poisson_ratio();
  EXPECT_NEAR(e / (2 * (1 + nu)), mu, 1e-12 * mu);
  EXPECT_NEAR(e / (3 * (1 - 2 * nu)), kappa, 1e-12 * kappa);
}

TEST_P(EveryEnergy, ARotationChangesNothing) {
  RandomMatrices random;
  const Matrix3 f = Matrix3::Identity() + random.entries(0.3), q = random.rotation();
  EXPECT_NEAR(energy(q * f), energy(f), 1e-12 * (1.0 + energy(f)));
  EXPECT_LT((stress(q * f) - q * stress(f)).norm(), 1e-11);
  EXPECT_LT((stress(f * q) - stress(f) * q).norm(), 1e-11) << "isotropic";
}

TEST_P(EveryEnergy, ScaledHasTheSameShape) {
  Hyperelastic own = law();
  own.mullins = MullinsEffect{2.1, 0.4, 0.1};
  const Hyperelastic other = scaled(own, 1.7);
  const Stretches stretches = {1.4, 0.9, 0.7};
  const LogResponse one = respond(own, stretches), more = respond(other, stretches);
  ASSERT_GT(one.energy, 1e-3);
  EXPECT_NEAR(more.energy, 1.7 * one.energy, 1e-14 * more.energy);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(more.first[i], 1.7 * one.first[i], 1e-13 * std::abs(one.first[i]));
  }
  EXPECT_NEAR(other.poisson_ratio(), own.poisson_ratio(), 1e-15);
  EXPECT_DOUBLE_EQ(other.mullins->m, 1.7 * 0.4);
  EXPECT_EQ(other.mullins->beta, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Laws, EveryEnergy, testing::ValuesIn(laws()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Hyperelastic, StressesAreThoseOfTextbooks) {
  // Neo-Hookean and Mooney-Rivlin in closed form (Treloar, The Physics of Rubber Elasticity, 1975).
  const double mu = 0.4, c10 = 0.15, c01 = 0.05;
  for (const double l : {0.5, 0.9, 1.0, 1.5, 4.0}) {
    EXPECT_NEAR(nominal_stress(neo_hookean(mu), DeformationMode::uniaxial, l),
                mu * (l - 1 / (l * l)), 1e-14);
    EXPECT_NEAR(nominal_stress(neo_hookean(mu), DeformationMode::equibiaxial, l),
                mu * (l - std::pow(l, -5)), 1e-13);
    EXPECT_NEAR(nominal_stress(neo_hookean(mu), DeformationMode::planar, l),
                mu * (l - std::pow(l, -3)), 1e-14);
    EXPECT_NEAR(nominal_stress(mooney_rivlin(c10, c01), DeformationMode::uniaxial, l),
                2 * (c10 + c01 / l) * (l - 1 / (l * l)), 1e-14);
  }
}

TEST(Hyperelastic, ArrudaBoyceIsItsSeries) {
  const double mu = 0.7, locking = 2.0;
  const Hyperelastic law = arruda_boyce(mu, locking);
  constexpr std::array<double, 5> c = {0.5, 1.0 / 20, 11.0 / 1050, 19.0 / 7000, 519.0 / 673750};
  for (const double l : {0.7, 1.0, 1.8}) {
    const double i1 = l * l + 2 / l;
    double energy = 0.0;
    for (int k = 1; k <= 5; ++k) {
      energy += mu * c[static_cast<std::size_t>(k - 1)] / std::pow(locking, 2 * k - 2) *
                (std::pow(i1, k) - std::pow(3, k));
    }
    EXPECT_NEAR(respond(law, incompressible_stretches(DeformationMode::uniaxial, l), false).energy,
                energy, 1e-13);
  }
}

TEST(Hyperelastic, BothReadingsOfOgdensModuli) {
  // Ecoflex 00-50: the sum of mu is the initial shear modulus under one convention only.
  const std::vector<OgdenTerm> terms = {{107.9e3, 1.55}, {21.47, 7.86}, {-87.1e3, -1.91}};
  const Hyperelastic as_sum = ogden(terms, OgdenConvention::two_mu_over_alpha_squared);
  EXPECT_NEAR(as_sum.shear_modulus(), 20.82e3, 5.0);
  EXPECT_NEAR(ogden(terms, OgdenConvention::mu_over_alpha).shear_modulus(), 166.9e3, 100.0);
  const auto converted =
      convert(terms, OgdenConvention::two_mu_over_alpha_squared, OgdenConvention::mu_over_alpha);
  const Hyperelastic same = ogden(converted, OgdenConvention::mu_over_alpha);
  for (const double l : {0.6, 1.4, 3.0}) {
    EXPECT_NEAR(nominal_stress(same, DeformationMode::uniaxial, l),
                nominal_stress(as_sum, DeformationMode::uniaxial, l), 1e-9);
  }
}

TEST(Hyperelastic, StabilityEndsWhereItIsKnownTo) {
  // Ecoflex 00-30 as published, with mu_3 > 0 and alpha_3 < 0, and with the sign of mu_3 that
  // stabilises it.
  const auto ecoflex = [](double third) {
    return ogden({{24.361e3, 1.7138}, {66.703, 7.0679}, {third, -3.3659}},
                 OgdenConvention::mu_over_alpha);
  };
  const auto [low, high] = stable_range(ecoflex(453.81), DeformationMode::uniaxial);
  EXPECT_NEAR(low, 0.31, 0.005);
  // In tension, stability ends where the two equal lateral stretches t = l^-1/2 separate: sum mu_p
  // alpha_p t^alpha_p = 0.
  const double t = 1.0 / std::sqrt(high);
  EXPECT_NEAR(24361 * 1.7138 * std::pow(t, 1.7138) + 66.703 * 7.0679 * std::pow(t, 7.0679) -
                  453.81 * 3.3659 * std::pow(t, -3.3659),
              0.0, 1.0);
  EXPECT_NEAR(high, 3.68, 0.01);
  EXPECT_EQ(stable_range(ecoflex(-453.81), DeformationMode::uniaxial), std::pair(0.1, 10.0));
  // Yeoh with a negative last coefficient: W' changes sign where 3 w_3 x^2 + 2 w_2 x + w_1 does.
  EXPECT_LT(stable_range(yeoh({1.0, -0.1}), DeformationMode::uniaxial).second, 3.0);
  EXPECT_EQ(stable_range(neo_hookean(1.0), DeformationMode::planar), std::pair(0.1, 10.0));
}

TEST(Hyperelastic, RefusesWhatIsNoMaterial) {
  const double nan = std::nan("");
  for (const Hyperelastic& bad :
       {with_bulk(neo_hookean(-1.0), 1.0), with_bulk(neo_hookean(1.0), 0.0),
        with_bulk(neo_hookean(nan), 1.0), with_bulk(neo_hookean(1.0), nan),
        with_bulk(Hyperelastic{.powers = {{1.0, 0.0}, {1.0, 2.0}}, .polynomial = {}}, 1.0),
        with_bulk(yeoh({}), 1.0), with_bulk(mooney_rivlin(1.0, -1.0), 1.0),
        saint_venant_kirchhoff(1.0, 0.5)}) {
    try {
      bad.validate("material");
      ADD_FAILURE() << "taken for a material";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_material);
    }
  }
}

}  // namespace
}  // namespace sinew::material
