#include "sinew/identify/material_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/error_kind.hpp"

namespace sinew::identify {
namespace {

using material::DeformationMode;

RubberTest made_of(const material::Hyperelastic& law, DeformationMode mode, double last) {
  RubberTest test{.name = std::string(mode_name(mode)), .mode = mode, .stretch = {}, .stress = {}};
  for (int k = 0; k <= 20; ++k) {
    test.stretch.push_back(1.0 + (last - 1.0) * k / 20);
    test.stress.push_back(material::nominal_stress(law, mode, test.stretch.back()));
  }
  return test;
}

std::vector<RubberTest> tests_of(const material::Hyperelastic& law) {
  return {made_of(law, DeformationMode::uniaxial, 4.0),
          made_of(law, DeformationMode::equibiaxial, 2.5),
          made_of(law, DeformationMode::planar, 3.0)};
}

using sinew::testing::kind_of;

TEST(MaterialFit, FindsTheLawThatMadeTheData) {
  const auto check = [](const material::Hyperelastic& law, const char* model) {
    const auto tests = tests_of(law);
    const FitResult fit = fit_material(tests, {.model = model});
    EXPECT_NEAR(fit.energy.shear_modulus(), law.shear_modulus(), 1e-4 * law.shear_modulus())
        << model;
    for (const TestFit& test : fit.tests) EXPECT_LT(test.relative, 1e-5) << model;
  };
  check(material::neo_hookean(30e3), "neo-hookean");
  check(material::mooney_rivlin(12e3, 2e3), "mooney-rivlin");
  check(material::yeoh({12e3, -300.0, 40.0}), "yeoh3");
  check(material::arruda_boyce(25e3, 3.0), "arruda-boyce");
  check(material::ogden({{20e3, 1.7}, {-500.0, -3.4}}, material::OgdenConvention::mu_over_alpha),
        "ogden2");
}

TEST(MaterialFit, SameSeedSameFit) {
  const auto tests = tests_of(material::yeoh({12e3, -300.0, 40.0}));
  const FitResult a = fit_material(tests, {.model = "ogden2", .starts = 3});
  const FitResult b = fit_material(tests, {.model = "ogden2", .starts = 3});
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.coefficients[0].value, b.coefficients[0].value);
}

TEST(MaterialFit, FindsSoftening) {
  const material::Hyperelastic law = material::neo_hookean(30e3);
  RubberTest test = made_of(law, DeformationMode::uniaxial, 3.0);
  const double most =
      material::respond(law, material::incompressible_stretches(test.mode, 3.0), false).energy;
  for (int k = 19; k >= 0; --k) {
    const double stretch = 1.0 + 2.0 * k / 20;
    const double energy =
        material::respond(law, material::incompressible_stretches(test.mode, stretch), false)
            .energy;
    test.stretch.push_back(stretch);
    test.stress.push_back(material::nominal_stress(law, test.mode, stretch) *
                          (1.0 - std::erf((most - energy) / (5e3 + 0.2 * most)) / 2.5));
  }
  const std::vector<RubberTest> tests = {test};
  const FitResult plain = fit_material(tests, {.model = "neo-hookean"});
  const FitResult soft =
      fit_material(tests, {.model = "neo-hookean", .starts = 5, .mullins = true});
  EXPECT_GT(plain.tests[0].relative, 0.05);
  EXPECT_LT(soft.tests[0].relative, 1e-4);
  ASSERT_TRUE(soft.mullins);
  EXPECT_NE(material_yaml(soft, tests, 0.49).find("softening: {r: 2."), std::string::npos);
  EXPECT_NEAR(soft.mullins->r, 2.5, 0.01);
}

TEST(RubberTest, ReadsWhatItsHeaderSays) {
  const auto first =
      parse_rubber_test("stretch,nominal_stress_MPa\n1,0\n1.5,0.1\n2,0.2\n", "a.csv");
  EXPECT_EQ(first.mode, DeformationMode::uniaxial);
  EXPECT_DOUBLE_EQ(first.stress[2], 2e5);
  const auto percent = parse_rubber_test(
      "strain [%];engineering stress [kPa]\n0;0\n50;10\n100;20\n", "x_equibiaxial.csv");
  EXPECT_EQ(percent.mode, DeformationMode::equibiaxial);
  EXPECT_DOUBLE_EQ(percent.stretch[1], 1.5);
  EXPECT_DOUBLE_EQ(percent.stress[1], 1e4);
  const auto truly = parse_rubber_test("true strain,true stress (MPa)\n0,0\n0.1,0.1\n0.2,0.2\n",
                                       "a.csv", DeformationMode::planar);
  EXPECT_EQ(truly.mode, DeformationMode::planar);
  EXPECT_NEAR(truly.stretch[2], std::exp(0.2), 1e-15);
  EXPECT_NEAR(truly.stress[2], 2e5 / std::exp(0.2), 1e-9);
}

TEST(RubberTest, PassesOverAPreambleAndPrefersEngineeringMeasures) {
  const auto test = parse_rubber_test(
      "PARAMETER;INFO;;;\nSpecimen Width (mm);6;;;\n;;;;\n"
      "Time (s);True Strain;True Stress (MPa);Engineering Strain;Engineering Stress (MPa)\n"
      "0.3;0.06574;0.0015;0.06795;0.00149\n0.4;0.08;0.003;0.09;0.003\n0.5;0.1;0.004;0.11;0.004\n",
      "silicone.csv");
  EXPECT_DOUBLE_EQ(test.stretch[0], 1.06795);
  EXPECT_DOUBLE_EQ(test.stress[0], 1490.0);
}

TEST(RubberTest, RefusesWhatItCannotRead) {
  EXPECT_EQ(kind_of([] { parse_rubber_test("a,b\n1,2\n1,2\n1,2\n", "x"); }),
            ErrorKind::wrong_columns);
  EXPECT_EQ(kind_of([] { parse_rubber_test("stretch,stress\n1,2\n1,2\n1,2\n", "x"); }),
            ErrorKind::wrong_columns);
  EXPECT_EQ(kind_of([] { parse_rubber_test("stretch,stress [m]\n1,2\n1,2\n1,2\n", "x"); }),
            ErrorKind::wrong_columns);
  EXPECT_EQ(kind_of([] { parse_rubber_test("stretch,stress [Pa]\n1,2\n2,2\n", "x"); }),
            ErrorKind::too_few_points);
  EXPECT_EQ(kind_of([] { parse_rubber_test("stretch,stress [Pa]\n0,2\n2,2\n3,3\n", "x"); }),
            ErrorKind::out_of_range);
}

TEST(MaterialFit, RefusesBadSettings) {
  const auto tests = tests_of(material::neo_hookean(30e3));
  EXPECT_EQ(kind_of([&] { fit_material(tests, {.model = "ogden9"}); }), ErrorKind::unknown_choice);
  EXPECT_EQ(kind_of([&] { fit_material({}, {}); }), ErrorKind::empty_list);
  EXPECT_EQ(kind_of([&] { fit_material(tests, {.starts = 0}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { fit_material(tests, {.poisson_ratio = 0.5}); }), ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::identify
