#include <gtest/gtest.h>

#include "sinew/linalg/factorisation.hpp"

#include "cholmod_matrix.hpp"

namespace sinew::linalg {
namespace {

TEST(Cholmod, AgreesOnSlenderAndBulkyMeshes) {
  for (const testing::BlockSystem& system :
       {testing::elastic_block(3, 3, 40, 11), testing::elastic_half_tube(2, 20, 25, 11),
        testing::elastic_block(10, 10, 12, 11)}) {
    ThreadPool pool(1);
    const auto factorisation = analyse(system.pattern, system.border)->create(pool);
    ASSERT_EQ(factorisation->factorise(system.matrix, system.rows, system.right),
              FactorStatus::positive_definite);
    for (const bool supernodal : {true, false}) {
      testing::CholmodSolver cholmod(system, supernodal);
      ASSERT_TRUE(cholmod.factorise());
      const MatrixX h = system.dense_rows();
      const MatrixX w = h * cholmod.solve(h.transpose());
      const VectorX free = h * cholmod.solve(system.dense_right());
      EXPECT_LT((factorisation->compliance() - w).norm(), 1e-9 * w.norm());
      EXPECT_LT((factorisation->free_motion() - free).norm(), 1e-9 * free.norm());
    }
  }
}

}  // namespace
}  // namespace sinew::linalg
