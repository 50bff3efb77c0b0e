// Refinement of meshes.
#include "sinew/plan/mesh.hpp"

#include <gtest/gtest.h>

namespace sinew::plan {
namespace {

TEST(Mesh, CutsWhereTheDefectIs) {
  const VectorX fractions{{0.25, 0.5, 0.25}};
  // (3 d / 0.1)^(1/4) is 0.4, 2.3, and more than four.
  const VectorX cut = refined(fractions, VectorX{{1e-3, 1.0, 1e6}});
  EXPECT_TRUE(cut.isApprox(
      VectorX{{0.25, 0.5 / 3, 0.5 / 3, 0.5 / 3, 0.0625, 0.0625, 0.0625, 0.0625}}, 1e-15));
  // No interval needs division, so all are halved.
  EXPECT_TRUE(refined(fractions, VectorX::Zero(3))
                  .isApprox(VectorX{{0.125, 0.125, 0.25, 0.25, 0.125, 0.125}}, 1e-15));
}

TEST(Mesh, SlopesOfLinesAreExact) {
  const VectorX times{{0.0, 0.1, 0.4, 0.5}};
  MatrixX values(4, 2);
  values << times * 3.0, VectorX::Constant(4, 2.0);
  const MatrixX slope = slopes(times, values);
  EXPECT_TRUE(slope.col(0).isApproxToConstant(3.0, 1e-14));
  EXPECT_LT(slope.col(1).norm(), 1e-14);
}

}  // namespace
}  // namespace sinew::plan
