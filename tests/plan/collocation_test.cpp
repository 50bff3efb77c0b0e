// Compares the exact derivatives of every part of the program with finite differences.
#include "sinew/plan/collocation.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tasks.hpp"

namespace sinew::plan {
namespace {

using testing::grab;
using testing::make;

struct Kind {
  const char* name;
  CollocationMethod method;
  bool free, mixed, driven = false;
};

class Derivatives : public ::testing::TestWithParam<Kind> {
 protected:
  static PlanTask task() {
    PlanTask task = grab();
    const bool mixed = GetParam().mixed;
    if (mixed) task.limits = {};
    task.goal.position = {0.1, 0.05, -0.2};
    task.grid.method = GetParam().method;
    task.grid.intervals = 3;
    task.grid.fractions = VectorX{{0.3, 0.5, 0.2}};
    task.grid.duration = 0.3;
    if (GetParam().free) {
      task.grid.min_duration = 0.1;
      task.grid.max_duration = 1.0;
    }
    task.objective = {0.7, 1.3, 0.4};
    task.limits.torque_rate = VectorX::Constant(mixed ? 6 : 4, 2.0);
    task.obstacles = {
        {.point = {0.3, 0.1, -0.1}, .radius = 0.05, .clearance = 0.01},
        {.kind = Obstacle::Kind::plane, .point = {0.0, 0.0, -0.8}, .normal = {0.1, 0, 2}}};
    task.backbone_points = 2;
    if (GetParam().driven) {
      task.drive = drive();
      task.limits.command_rate = VectorX{{kNoBound, 9.0, kNoBound, 5.0}};
      task.objective.command = 1e-3;
    }
    return task;
  }
  /// Drives with volumes and torques of about one, for accurate differences: with fractional
  /// delays, with and without feedthrough, and one that its limits keep at rest.
  static DriveTrain drive() {
    DriveTrain drive;
    for (const double delay : {0.0, 0.033, 0.05, 0.0771}) {
      DriveChannel channel{{0.4, 0.9, delay},
                           pcc::DriveCylinder::second_order(1.1, 40.0, 0.8, 0.01)};
      if (delay == 0.05) channel.cylinder.d = 0.2;
      drive.channels.push_back(channel);
    }
    return drive;
  }
  Derivatives()
      : arm_(make(GetParam().mixed ? pcc::testing::mixed() : pcc::testing::fluidic())),
        program_(arm_, completed(*arm_, task())) {
    program_.set_aim({.position = {0.01, 0.0, -0.02},
                      .velocity = {-0.1, 0.2, 0.0},
                      .clearance = VectorX{{0.003, 0.0}}});
    std::mt19937 random(7);
    x_ = pcc::testing::random_vector(random, program_.variables(), 0.5);
    if (GetParam().free) x_[x_.size() - 1] = 0.35;
    multipliers_ = pcc::testing::random_vector(random, program_.constraints(), 1.0);
  }
  /// Gradient of factor f + multipliers . c.
  VectorX lagrangian_gradient(const VectorX& x, double factor) {
    VectorX result;
    program_.gradient(x, result);
    return factor * result + jacobian(x).transpose() * multipliers_;
  }
  MatrixX jacobian(const VectorX& x) {
    const auto& pattern = program_.jacobian_pattern();
    std::vector<double> values(pattern.size());
    program_.jacobian(x, values.data());
    MatrixX result = MatrixX::Zero(program_.constraints(), program_.variables());
    for (std::size_t i = 0; i < values.size(); ++i) {
      result(pattern[i].row, pattern[i].column) += values[i];
    }
    return result;
  }

  std::shared_ptr<const pcc::Arm> arm_;
  Collocation program_;
  VectorX x_, multipliers_;
};

TEST_P(Derivatives, GradientIsThatOfTheObjective) {
  VectorX gradient;
  program_.gradient(x_, gradient);
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double h = 1e-6;
    VectorX to = x_, from = x_;
    to[i] += h;
    from[i] -= h;
    const double difference = (program_.objective(to) - program_.objective(from)) / (2.0 * h);
    EXPECT_NEAR(gradient[i], difference, 1e-8 * (1.0 + std::abs(difference))) << i;
  }
}

TEST_P(Derivatives, JacobianIsThatOfTheConstraints) {
  const MatrixX exact = jacobian(x_);
  VectorX above, below;
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double h = 1e-6;
    VectorX to = x_, from = x_;
    to[i] += h;
    from[i] -= h;
    program_.constraints(to, above);
    program_.constraints(from, below);
    const VectorX difference = (above - below) / (2.0 * h);
    EXPECT_LT((exact.col(i) - difference).cwiseAbs().maxCoeff(),
              1e-7 * (1.0 + difference.cwiseAbs().maxCoeff()))
        << i;
  }
}

TEST_P(Derivatives, HessianIsThatOfTheLagrangian) {
  const double factor = 1.7;
  const auto& pattern = program_.hessian_pattern();
  std::vector<double> values(pattern.size());
  program_.hessian(x_, factor, multipliers_, values.data());
  MatrixX exact = MatrixX::Zero(x_.size(), x_.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_GE(pattern[i].row, pattern[i].column);
    exact(pattern[i].row, pattern[i].column) += values[i];
  }
  exact = MatrixX(exact.selfadjointView<Eigen::Lower>());
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double h = 1e-6;
    VectorX to = x_, from = x_;
    to[i] += h;
    from[i] -= h;
    const VectorX difference =
        (lagrangian_gradient(to, factor) - lagrangian_gradient(from, factor)) / (2.0 * h);
    EXPECT_LT((exact.col(i) - difference).cwiseAbs().maxCoeff(),
              1e-6 * (1.0 + difference.cwiseAbs().maxCoeff()))
        << i;
  }
}

TEST_P(Derivatives, KnotsPackAndUnpack) {
  if (GetParam().driven) {
    // Commands before the plan are fixed, and volumes follow from commands.
    const VectorX& lower = program_.variable_bounds().lower;
    const VectorX& upper = program_.variable_bounds().upper;
    x_ = (lower.array() == upper.array()).select(lower, x_);
    x_ = program_.pack(program_.unpack(x_));
  }
  EXPECT_EQ(program_.pack(program_.unpack(x_)), x_);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Derivatives,
    ::testing::Values(Kind{"Euler", CollocationMethod::backward_euler, false, false},
                      Kind{"EulerFree", CollocationMethod::backward_euler, true, false},
                      Kind{"Radau", CollocationMethod::radau, false, false},
                      Kind{"RadauFree", CollocationMethod::radau, true, false},
                      Kind{"RadauFreeMixed", CollocationMethod::radau, true, true},
                      Kind{"EulerDriven", CollocationMethod::backward_euler, false, false, true},
                      Kind{"RadauDriven", CollocationMethod::radau, false, false, true}),
    [](const auto& kind) { return kind.param.name; });

/// The stages of Radau are exact for cubic positions, and the last one for degree four. Backward
/// Euler is exact on a straight line.
TEST(Transcription, IsExactOnPolynomials) {
  const double h = 0.3;
  const auto quartic = [](double t, double fourth) {
    return std::array{1.0 - 2.0 * t + 3.0 * t * t - 4.0 * t * t * t + fourth * t * t * t * t,
                      -2.0 + 6.0 * t - 12.0 * t * t + 4.0 * fourth * t * t * t,
                      6.0 - 24.0 * t + 12.0 * fourth * t * t};
  };
  const Transcription rules(CollocationMethod::radau, h);
  EXPECT_EQ(rules.defects(), 0);
  for (const double fourth : {0.0, 5.0}) {
    VectorX knots(6);
    for (int k = 0; k < 2; ++k) {
      for (int b = 0; b < 3; ++b) {
        knots[3 * k + b] = quartic(k * h, fourth)[static_cast<std::size_t>(b)];
      }
    }
    double area = 0.0;
    for (const CollocationStage& stage : rules.stages) {
      const VectorX motion = stage.state.value * knots;
      const auto expected = quartic(stage.time * h, fourth);
      // The position at inner stages is exact for a cubic.
      for (int b = fourth == 0.0 || stage.time == 1.0 ? 0 : 1; b < 3; ++b) {
        EXPECT_NEAR(motion[b], expected[static_cast<std::size_t>(b)], 1e-12) << b;
      }
      area += h * stage.fraction * expected[1];
    }
    EXPECT_NEAR(area, knots[3] - knots[0], 1e-14);
  }
  const Transcription euler(CollocationMethod::backward_euler, h);
  const VectorX line{{1.0, -2.0, 1.0 - 2.0 * h, -2.0}};
  EXPECT_NEAR((euler.defect.value * line)[0], 0.0, 1e-15);
  EXPECT_NEAR((euler.stages[0].state.value * line)[2], 0.0, 1e-15);
}

/// For v' = -rate v over one interval, a mode that is faster than the knots decays by its end,
/// while Hermite-Simpson would keep its full size.
TEST(Transcription, DampsWhatKnotsDoNotResolve) {
  const double h = 0.032;
  const Transcription rules(CollocationMethod::radau, h);
  for (const double rate : {1.0, 1e3, 1e5, 1e7}) {
    Matrix3 left;
    Vector3 right;
    const VectorX start{{0.0, 1.0, 0.0}};
    for (int i = 0; i < 3; ++i) {
      const MatrixX& state = rules.stages[static_cast<std::size_t>(i)].state.value;
      const VectorX row = state.row(2) + rate * state.row(1);
      left.row(i) = row.tail(3);
      right[i] = -row.head(3).dot(start);
    }
    const double after = left.partialPivLu().solve(right)[1], z = -rate * h;
    // The (2, 3) Pade approximant (Hairer & Wanner 1996, IV.5).
    const double stability = (1.0 + 2.0 / 5.0 * z + z * z / 20.0) /
                             (1.0 - 3.0 / 5.0 * z + 3.0 / 20.0 * z * z - z * z * z / 60.0);
    EXPECT_NEAR(after, stability, 1e-9);
    EXPECT_LT(std::abs(after), rate > 1e4 ? 1e-3 : 1.0);
  }
}

}  // namespace
}  // namespace sinew::plan
