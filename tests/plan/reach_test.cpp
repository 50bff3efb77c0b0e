// Static reach: samples, nearest equilibria and proofs are consistent.
#include "sinew/plan/reach.hpp"

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm.hpp"

#include "tasks.hpp"

namespace sinew::plan {
namespace {

using testing::grab;
using testing::kGoals;
using testing::make;

TEST(Reach, SamplesAreEquilibriaWithinTheirLimits) {
  const auto arm = make(pcc::testing::fluidic());
  const ArmLimits limits = grab().limits;
  const ReachMap map = sample_reach(arm, limits, 40);
  ASSERT_GT(map.tip.rows(), 40);
  pcc::ArmEquations equations(arm);
  const VectorX still = VectorX::Zero(4);
  for (Eigen::Index i = 0; i < map.tip.rows(); ++i) {
    const VectorX q = map.position.row(i);
    EXPECT_LT((equations.residual(q, still, still) - map.torque.row(i).transpose()).norm(), 1e-9);
    EXPECT_LT((equations.endpoints(q).row(3) - map.tip.row(i)).norm(), 1e-12);
    EXPECT_TRUE(
        (map.torque.row(i).transpose().cwiseAbs().array() <= limits.torque_upper.array()).all());
  }
}

TEST(Reach, NearestIsAsNearAsAnySample) {
  const auto arm = make(pcc::testing::fluidic());
  const ReachMap map = sample_reach(arm, grab().limits, 200);
  for (const Vector3& goal : kGoals) {
    const NearestReach nearest = nearest_reach(arm, grab().limits, goal, 10);
    ASSERT_TRUE(nearest.found);
    const double sampled = (map.tip.rowwise() - goal.transpose()).rowwise().norm().minCoeff();
    EXPECT_LE(nearest.distance, sampled + 1e-6);
    EXPECT_GT(nearest.distance, 0.8 * sampled);
  }
}

TEST(Reach, GoalsOfGrabsAreProvenOutOfReach) {
  const auto arm = make(pcc::testing::fluidic());
  for (const Vector3& goal : kGoals) {
    const ReachProof proof = prove_out_of_reach(arm, grab().limits, goal);
    EXPECT_EQ(proof.verdict, ReachProof::Verdict::out_of_reach);
    EXPECT_GT(proof.boxes, 100);
  }
}

/// Soundness: the search never proves a point out of reach at which there is an equilibrium.
TEST(Reach, NeverProvesAnEquilibriumAway) {
  for (const bool turned : {false, true}) {
    pcc::ArmSettings settings =
        pcc::testing::fluidic(turned ? pcc::MassCentre::chord : pcc::MassCentre::distributed);
    if (turned) {
      settings.segments[2].gamma = 0.5;
      settings.segments[1].dead_length = 0.02;
      settings.gravity = {1.0, 0.5, -9.0};
    }
    const auto arm = make(settings);
    ArmLimits limits = grab().limits;
    limits.torque_upper[0] = 0.05;
    limits.torque_lower = -limits.torque_upper;
    const ReachMap map = sample_reach(arm, limits, 20, 5);
    for (Eigen::Index i = 0; i < map.tip.rows(); ++i) {
      const ReachProof proof = prove_out_of_reach(arm, limits, map.tip.row(i).transpose(),
                                                  {.tolerance = 2e-3, .max_boxes = 20000});
      EXPECT_NE(proof.verdict, ReachProof::Verdict::out_of_reach) << i;
    }
  }
}

TEST(Reach, FindsWhatCanBeReached) {
  const auto arm = make(pcc::testing::fluidic());
  const ReachProof proof = prove_out_of_reach(arm, grab().limits, {0.1, 0.0, -0.5});
  ASSERT_EQ(proof.verdict, ReachProof::Verdict::reachable);
  pcc::ArmEquations equations(arm);
  EXPECT_LT((equations.endpoints(proof.position).row(3).transpose() - Vector3(0.1, 0.0, -0.5))
                .cwiseAbs()
                .maxCoeff(),
            0.021);
}

TEST(Reach, RefusesWhatItCannotDo) {
  EXPECT_THROW(prove_out_of_reach(make(pcc::testing::mixed()), {}, Vector3::Zero()), Error);
  EXPECT_THROW(sample_reach(make(pcc::testing::fluidic()), {}, 10), Error);  // no limits
  EXPECT_THROW(sample_reach(make(pcc::testing::fluidic()), grab().limits, 0), Error);
}

}  // namespace
}  // namespace sinew::plan
