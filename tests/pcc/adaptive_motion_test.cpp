// Motion to a given accuracy: compared with explicit steps where these are stable, and with itself.
#include "sinew/pcc/adaptive_motion.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_simulation.hpp"

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

/// Steps of second order converge to the same motion; half the step size gives a quarter of the
/// error.
TEST(AdaptiveMotion, IsTheLimitOfTheImplicitSteps) {
  const auto arm = make(testing::fluidic());
  const double end = 0.5;
  AdaptiveMotion motion(arm, {.relative = 1e-8, .angle = 1e-10, .rate = 1e-8});
  motion.advance(end, swing);
  EXPECT_EQ(motion.time(), end);
  std::vector<double> apart;
  for (const int steps : {500, 1000}) {
    ArmSimulation simulation(arm, {.time_step = end / steps});
    for (int k = 1; k <= steps; ++k) simulation.step(swing(k * end / steps));
    apart.push_back((simulation.position() - motion.position()).norm() +
                    (simulation.rate() - motion.rate()).norm());
  }
  EXPECT_LT(apart[1], 1e-2);
  EXPECT_GT(apart[0] / apart[1], 3.0);
}

/// A hundredth of the tolerance gives a hundredth of the error or less, also for the published arm,
/// whose fastest decay rate is 1e7 1/s.
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
  const VectorX finest = run(1e-8, &fine_steps);
  const double coarse = (run(1e-4, &coarse_steps) - finest).norm();
  const double fine = (run(1e-6, &steps) - finest).norm();
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
  EXPECT_LT((state_of(whole) - state_of(pieces)).norm(), 1e-4);
}

TEST(AdaptiveMotion, GivesUpWithAReason) {
  AdaptiveMotion motion(make(testing::fluidic()), {.max_steps = 3});
  try {
    motion.advance(1.0, swing);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_converged);
  }
}

}  // namespace
}  // namespace sinew::pcc
