#include "sinew/material/library.hpp"

#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/material/instability.hpp"

namespace sinew::material {
namespace {

constexpr std::array kModes = {DeformationMode::uniaxial, DeformationMode::equibiaxial,
                               DeformationMode::planar};

// The second derivative of the compressible law at J = 1, on (1, 0, -1), (0, 1, -1), (1, 1, 1), and
// its determinant.
struct Tangent {
  double first = 0.0, minor = 0.0, determinant = 0.0;
};

Tangent tangent(const Hyperelastic& law, DeformationMode mode, double stretch) {
  const auto h = respond(law, incompressible_stretches(mode, stretch), true).second;
  const double a = h[0][0] - 2.0 * h[0][2] + h[2][2];
  const double b = h[1][1] - 2.0 * h[1][2] + h[2][2];
  const double c = h[0][1] - h[0][2] - h[1][2] + h[2][2];
  const double det = h[0][0] * (h[1][1] * h[2][2] - h[1][2] * h[2][1]) -
                     h[0][1] * (h[1][0] * h[2][2] - h[1][2] * h[2][0]) +
                     h[0][2] * (h[1][0] * h[2][1] - h[1][1] * h[2][0]);
  return {a, a * b - c * c, det};
}

TEST(Library, LawsAreStableOverTheStretchesOfRobotsOrNamedPublished) {
  for (const NamedMaterial& entry : material_library()) {
    const bool published = entry.name.ends_with("-published");
    EXPECT_EQ(instability(entry.energy).empty(), !published) << entry.name;
    if (!published) continue;
    EXPECT_EQ(instability(named_material(entry.better).energy), "");
  }
}

TEST(Library, TheTangentOfTheCompressibleLawIsPositiveWhereALawIsCalledStable) {
  for (const NamedMaterial& entry : material_library()) {
    bool positive = true;
    for (const DeformationMode mode : kModes) {
      for (int k = 0; k <= 100; ++k) {
        const double stretch = kLeastStretch * std::pow(kMostStretch / kLeastStretch, 0.01 * k);
        const Tangent own = tangent(entry.energy, mode, stretch);
        // det H = kappa det A: cancellation loses digits where the law is far softer than kappa.
        EXPECT_NEAR(
            own.determinant, entry.energy.bulk_modulus * own.minor,
            1e-6 * entry.energy.bulk_modulus * (own.first * own.first + std::abs(own.minor)))
            << entry.name << " at " << stretch;
        positive = positive && own.first > 0.0 && own.minor > 0.0 && own.determinant > 0.0;
      }
    }
    EXPECT_EQ(positive, instability(entry.energy).empty()) << entry.name;
  }
}

TEST(Library, StabilityCoversTheStatedRange) {
  for (const NamedMaterial& entry : material_library()) {
    if (entry.highest == 0.0) continue;
    for (const DeformationMode mode : kModes) {
      const auto [low, high] = stable_range(entry.energy, mode, entry.lowest, entry.highest);
      EXPECT_EQ(low, entry.lowest) << entry.name;
      EXPECT_EQ(high, entry.highest) << entry.name;
    }
  }
}

TEST(Instability, NamesTheStretches) {
  EXPECT_EQ(instability(named_material("ecoflex-00-50-published").energy),
            "above 1.13 and below 0.885 in uniaxial stretch, above 1.06 and below 0.94 in "
            "equibiaxial stretch, above 1.11 and below 0.899 in planar stretch");
  // A Yeoh law with a negative last coefficient.
  EXPECT_THAT(instability(yeoh({1.0, -0.1})), testing::HasSubstr("above 2.01 in uniaxial stretch"));
  EXPECT_EQ(instability(saint_venant_kirchhoff(1e5, 0.3)), "below 0.577 in uniaxial stretch");
  EXPECT_EQ(instability(neo_hookean(1e4)), "");
}

TEST(Library, LawsThatAreSofterThanAnotherTestAreCalledTooSoft) {
  for (const NamedMaterial& entry : material_library()) {
    const bool tensile = entry.source.starts_with("Our fit to the tensile curve");
    const bool softer = entry.measured_modulus > 1.2 * entry.energy.young_modulus();
    const bool stable = instability(entry.energy).empty();
    EXPECT_EQ(entry.soft_below > 1.0, tensile || (softer && stable)) << entry.name;
    if (entry.better.empty() || entry.soft_below == 0.0) continue;
    const NamedMaterial& better = named_material(entry.better);
    EXPECT_NEAR(better.energy.young_modulus() / better.measured_modulus, 1.0, 0.01) << entry.name;
    // The fit is the softer one up to the stretch below which it is called too soft.
    for (const double stretch : {1.05, 1.3, 1.6, 0.99 * entry.soft_below}) {
      EXPECT_LT(nominal_stress(entry.energy, DeformationMode::uniaxial, stretch),
                0.85 * nominal_stress(better.energy, DeformationMode::uniaxial, stretch))
          << entry.name << " at " << stretch;
    }
    EXPECT_THAT(small_strain_remedy(entry), testing::HasSubstr("write " + better.name));
  }
}

}  // namespace
}  // namespace sinew::material
