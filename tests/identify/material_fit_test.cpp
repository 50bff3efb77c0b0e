#include "sinew/identify/material_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "sinew/identify/fitted_law.hpp"

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

/// Adds an independent error to every stress, relative to the test's largest stress.
std::vector<RubberTest> disturbed(std::vector<RubberTest> tests, double size) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, size);
  for (RubberTest& test : tests) {
    const double largest = test.largest_stress();
    for (double& stress : test.stress) stress += largest * normal(random);
  }
  return tests;
}

// Tests of a law that none of the models represents, so richer models fit better.
std::vector<RubberTest> strange_tests() {
  return disturbed(tests_of(material::yeoh({12e3, -300.0, 90.0})), 0.01);
}

TEST(MaterialFit, RicherModelsNeverFitWorse) {
  const auto tests = strange_tests();
  const std::vector<std::string> models = fit_models();
  std::map<std::string, double> cost;
  for (const FitResult& fit : fit_materials(tests, models, {.starts = 1})) {
    cost[fit.model] = fit.cost;
  }
  for (const std::string& model : models) {
    const std::string simpler = contained_model(model);
    if (simpler.empty()) continue;
    EXPECT_LE(cost[model], cost[simpler] * (1.0 + 1e-9)) << model << " over " << simpler;
  }
  EXPECT_LT(cost["yeoh3"], 0.5 * cost["yeoh1"]);
  EXPECT_LT(cost["ogden2"], 0.9 * cost["ogden1"]);
}

TEST(MaterialFit, AModelFitsTheSameAloneAndAmongOthers) {
  const auto tests = strange_tests();
  const std::vector<std::string> models = {"yeoh2", "ogden3"};
  const FitResult alone = fit_material(tests, {.model = "ogden3", .starts = 2});
  const FitResult beside = fit_materials(tests, models, {.starts = 2}).back();
  EXPECT_EQ(alone.cost, beside.cost);
}

TEST(MaterialFit, TermsThatCoincideBecomeOne) {
  const auto law = material::ogden({{20e3, 2.4}}, material::OgdenConvention::mu_over_alpha);
  const FitResult fit = fit_material(tests_of(law), {.model = "ogden3"});
  ASSERT_EQ(fit.coefficients.size(), 2U);
  EXPECT_NEAR(fit.coefficients[0].value, 20e3, 1.0);
  EXPECT_NEAR(fit.coefficients[1].value, 2.4, 1e-4);
}

TEST(MaterialFit, RowsOutsideTheRangeDoNotCount) {
  auto tests = tests_of(material::neo_hookean(30e3));
  for (RubberTest& test : tests) {
    for (std::size_t i = 0; i < test.stretch.size(); ++i) {
      if (test.stretch[i] > 2.0 || test.stretch[i] < 1.1) test.stress[i] = 7e5;
    }
  }
  const FitResult all = fit_material(tests, {.model = "neo-hookean"});
  const FitResult part =
      fit_material(tests, {.model = "neo-hookean", .min_stretch = 1.1, .max_stretch = 2.0});
  EXPECT_GT(all.energy.shear_modulus(), 40e3);
  EXPECT_NEAR(part.energy.shear_modulus(), 30e3, 1e-3);
  EXPECT_LT(part.tests[0].rows, tests[0].stretch.size());
  EXPECT_LT(part.tests[0].relative, 1e-8);
  EXPECT_EQ(kind_of([&] { fit_material(tests, {.max_stretch = 1.01}); }),
            ErrorKind::too_few_points);
  EXPECT_EQ(kind_of([&] { fit_material(tests, {.min_stretch = 3.0, .max_stretch = 2.0}); }),
            ErrorKind::contradictory_limits);
}

// With independent errors, the information criterion prefers the model that generated the data,
// although richer models fit more closely.
TEST(MaterialFit, InformationTellsWhatMadeTheData) {
  const auto supported = [](const material::Hyperelastic& law) {
    const auto tests = disturbed(tests_of(law), 0.01);
    const auto fits = fit_materials(tests, fit_models(), {.starts = 1});
    const auto information = bayes_information(fits);
    const auto best = std::ranges::min_element(information) - information.begin();
    const double least = std::ranges::min(fits, {}, &FitResult::cost).cost;
    EXPECT_GT(fits[static_cast<std::size_t>(best)].cost, least);
    return fits[static_cast<std::size_t>(best)].model;
  };
  EXPECT_EQ(supported(material::neo_hookean(30e3)), "neo-hookean");
  EXPECT_EQ(supported(material::ogden({{20e3, 4.0}}, material::OgdenConvention::mu_over_alpha)),
            "ogden1");
}

TEST(MaterialFit, ATermsStressAndItsDerivative) {
  for (const DeformationMode mode :
       {DeformationMode::uniaxial, DeformationMode::equibiaxial, DeformationMode::planar}) {
    for (const double alpha : {-6.0, 0.3, 2.0, 11.0}) {
      for (const double stretch : {0.6, 1.0, 2.5}) {
        // A term with the whole of a shear modulus of 1 Pa: mu = 2/alpha.
        const auto law =
            material::ogden({{2.0 / alpha, alpha}}, material::OgdenConvention::mu_over_alpha);
        const TermStress found = term_stress(mode, stretch, alpha);
        const double reference = material::nominal_stress(law, mode, stretch);
        EXPECT_NEAR(found.value, reference, 1e-12 * (1.0 + std::abs(reference)));
        const double step = 1e-5;
        const double slope = (term_stress(mode, stretch, alpha + step).value -
                              term_stress(mode, stretch, alpha - step).value) /
                             (2.0 * step);
        EXPECT_NEAR(found.by_alpha, slope, 1e-7 * (1.0 + std::abs(slope)));
      }
    }
  }
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
  EXPECT_NE(material_yaml(soft, tests, {}).find("softening: {r: 2."), std::string::npos);
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
            ErrorKind::wrong_dimension);
  EXPECT_EQ(kind_of([] { parse_rubber_test("strain [mm],stress [Pa]\n1,2\n1,2\n1,2\n", "x"); }),
            ErrorKind::wrong_dimension);
  EXPECT_EQ(kind_of([] { parse_rubber_test("strain,stress [mpa]\n1,2\n1,2\n1,2\n", "x"); }),
            ErrorKind::unknown_unit);
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
