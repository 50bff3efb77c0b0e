#include "sinew/material/elastic_constants.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew::material {
namespace {

TEST(ElasticConstants, LameConstantsGiveBackYoungAndPoisson) {
  for (const double nu : {-0.5, 0.0, 0.05, 0.3, 0.45, 0.499}) {
    const ElasticConstants constants{450e3, nu};
    const double mu = constants.shear_modulus(), lambda = constants.first_lame();
    EXPECT_NEAR(mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), 450e3, 1e-6);
    EXPECT_NEAR(lambda / (2.0 * (lambda + mu)), nu, 1e-12);
  }
}

TEST(ElasticConstants, RefusesWhatIsNoMaterial) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const ElasticConstants bad :
       {ElasticConstants{0.0, 0.3}, ElasticConstants{-1.0, 0.3}, ElasticConstants{nan, 0.3},
        ElasticConstants{infinity, 0.3}, ElasticConstants{1e5, 0.5}, ElasticConstants{1e5, -1.0},
        ElasticConstants{1e5, nan}, ElasticConstants{1e5, 0.6}}) {
    try {
      bad.validate("bodies.trunk.material");
      ADD_FAILURE() << bad.young_modulus << " " << bad.poisson_ratio;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_material);
      EXPECT_EQ(error.place().item, "bodies.trunk.material");
      EXPECT_FALSE(error.remedy().empty());
    }
  }
  EXPECT_NO_THROW(ElasticConstants({450e3, 0.45}).validate("material"));
}

}  // namespace
}  // namespace sinew::material
