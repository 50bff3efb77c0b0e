// Motion to a given accuracy: against explicit steps where they can follow, and against itself.
#include "sinew/pcc/adaptive_motion.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

#include "arms.hpp"

namespace sinew::pcc {
namespace {

using testing::make;

VectorX swing(double time) {
  return VectorX{{0.02 * std::sin(5.0 * time), 0.05 * std::sin(9.0 * time),
                  -0.04 * std::sin(7.0 * time), 0.03 * (1.0 - std::cos(6.0 * time))}};
}

VectorX state_of(const AdaptiveMotion& motion) {
  VectorX y(2 * motion.position().size());
  y << motion.position(), motion.rate();
  return y;
}

/// The classical method of fourth order, explicit: steps far below the arm's fastest decay.
VectorX classical(const std::shared_ptr<const Arm>& arm, VectorX y, double end, int steps) {
  ArmEquations equations(arm);
  const Eigen::Index n = arm->coordinates();
  const auto slope = [&](double time, const VectorX& at) {
    VectorX result(2 * n);
    result << at.tail(n), equations.acceleration(at.head(n), at.tail(n), swing(time));
    return result;
  };
  const double h = end / steps;
  for (int k = 0; k < steps; ++k) {
    const double time = k * h;
    const VectorX k1 = slope(time, y), k2 = slope(time + 0.5 * h, y + 0.5 * h * k1),
                  k3 = slope(time + 0.5 * h, y + 0.5 * h * k2), k4 = slope(time + h, y + h * k3);
    y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return y;
}

TEST(AdaptiveMotion, IsThatOfExplicitSteps) {
  // Without damping the lumped masses' fast modes do not decay, and small steps can follow.
  ArmSettings settings = testing::fluidic(MassCentre::distributed);
  for (Segment& segment : settings.segments) segment.damping = 1e-5;
  const auto arm = make(settings);
  VectorX start(8);
  start << 0.3, -0.2, 0.5, 0.1, 0.5, -1.0, 0.2, 0.4;
  const VectorX coarse = classical(arm, start, 0.2, 20000),
                expected = classical(arm, start, 0.2, 40000);
  ASSERT_LT((coarse - expected).norm(), 1e-9);
  AdaptiveMotion motion(arm, {.relative = 1e-9, .angle = 1e-10, .rate = 1e-9});
  motion.set_state(start.head(4), start.tail(4));
  motion.advance(0.2, swing);
  EXPECT_LT((state_of(motion) - expected).norm(), 1e-6);
  EXPECT_EQ(motion.time(), 0.2);
}

/// A hundredth of the error for a thousandth of the tolerance and better: what is asked for is
/// what steps are chosen by, of the published arm too, whose fastest decay is 1e7 1/s.
TEST(AdaptiveMotion, AccuracyIsWhatIsAskedFor) {
  const auto arm = make(testing::fluidic());
  const VectorX q{{0.05, -0.05, 0.05, 0.02}}, rate{{0.5, -1.0, 0.2, 0.4}};
  const auto run = [&](double accuracy, long* steps) {
    AdaptiveMotion motion(arm, {.relative = accuracy, .angle = 0.01 * accuracy, .rate = accuracy});
    motion.set_state(q, rate);
    motion.advance(0.5, swing);
    *steps = motion.steps();
    return state_of(motion);
  };
  long coarse_steps = 0, steps = 0, fine_steps = 0;
  const VectorX finest = run(1e-10, &fine_steps);
  const double coarse = (run(1e-4, &coarse_steps) - finest).norm();
  const double fine = (run(1e-7, &steps) - finest).norm();
  EXPECT_LT(coarse, 1e-2);
  EXPECT_LT(fine, 1e-5);
  EXPECT_LT(fine, 0.01 * coarse);
  EXPECT_GT(steps, coarse_steps);
  EXPECT_LT(steps, 2000);
}

TEST(AdaptiveMotion, GoesOnInPieces) {
  const auto arm = make(testing::fluidic());
  AdaptiveMotion whole(arm), pieces(arm);
  whole.advance(0.3, swing);
  for (const double end : {0.1, 0.1 + 1e-12, 0.25, 0.3}) pieces.advance(end, swing);
  EXPECT_LT((state_of(whole) - state_of(pieces)).norm(), 1e-5);
}

TEST(AdaptiveMotion, GivesUpWithAReason) {
  AdaptiveMotion motion(make(testing::fluidic()), {.most_steps = 3});
  try {
    motion.advance(1.0, swing);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_converged);
  }
}

}  // namespace
}  // namespace sinew::pcc
