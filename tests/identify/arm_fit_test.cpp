// Arms from synthetic motion capture: the fit recovers the parameters that generated the records.
#include "sinew/identify/arm_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/linalg/dense.hpp"
#include "sinew/pcc/excitation.hpp"

#include "arm_records.hpp"
#include "pcc/arms.hpp"
#include "support/error_kind.hpp"

namespace sinew::identify {
namespace {

using pcc::testing::fluidic;
using pcc::testing::make;
using sinew::testing::kind_of;
using testing::Capture;
using testing::release;

const VectorX kFirst{{0.9, 0.4, 0.6, 0.5}}, kSecond{{-0.9, 0.7, -0.6, 0.8}},
    kThird{{0.6, -0.8, -0.4, 0.6}};
constexpr Capture kCapture{.duration = 3.0, .noise = 3e-4};

/// Initial guess: the fluidic arm with wrong parameters.
ArmModel guess(const ArmModel& truth) {
  pcc::ArmSettings settings = truth.arm->settings();
  settings.centre = pcc::MassCentre::arc;
  const double masses[] = {0.9, 1.0, 0.85, 1.15};
  for (std::size_t i = 0; i < settings.segments.size(); ++i) {
    settings.segments[i].mass *= masses[i];
    settings.segments[i].stiffness *= 0.9;
    settings.segments[i].damping *= 0.8;
  }
  ArmModel result{make(settings), truth.actuators};
  for (auto& actuator : result.actuators) {
    actuator.cubic *= 1.2;
    actuator.delay *= 0.5;
  }
  return result;
}

ArmFitSettings wide(std::vector<std::string> fixed) {
  return {.mass_spread = 0.9,
          .stiffness_spread = 0.5,
          .damping_lower = 1e-4,
          .damping_upper = 2e-2,
          .fixed = std::move(fixed)};
}

std::vector<MotionRecord> two_releases(const ArmModel& truth, std::uint64_t seed) {
  return {release(truth, kFirst, kCapture, 2 * seed, {}, "a"),
          release(truth, kSecond, kCapture, 2 * seed + 1, {}, "b")};
}

std::vector<double> true_values(const ArmModel& truth) {
  std::vector<double> values;
  for (const auto& segment : truth.arm->settings().segments) values.push_back(segment.mass);
  values.push_back(truth.arm->stiffness()[0]);
  values.push_back(truth.arm->damping()[0]);
  for (const auto& actuator : truth.actuators) values.push_back(actuator.cubic);
  if (!truth.actuators.empty()) values.push_back(truth.actuators[0].delay);
  return values;
}

/// The arm with all segments but the first actuated, at rest until the volumes start.
ArmModel actuated(pcc::MassCentre centre = pcc::MassCentre::arc) {
  pcc::ArmSettings settings = fluidic(centre);
  settings.actuation = MatrixX::Zero(4, 3);
  settings.actuation.bottomRows(3).setIdentity();
  const pcc::FluidicActuator actuator{0.0, 4e12, 0.08};
  return {make(settings), {actuator, actuator, actuator}};
}

MotionRecord driven(const ArmModel& truth, std::uint64_t seed, const std::string& name,
                    bool torques = false) {
  Capture capture = kCapture;
  capture.jitter = 0.0;
  capture.duration = 5.0;
  const Eigen::Index samples = 251;
  const VectorX times = VectorX::LinSpaced(samples, 0.0, 5.0);
  MatrixX inputs(samples, 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const pcc::Excitation volume(
        {.amplitude = 3e-5, .seed = 100 * seed + static_cast<std::uint64_t>(i)});
    inputs.col(i) = volume.sample(times);
    // Faded in from rest over half a second.
    for (Eigen::Index k = 0; k < samples; ++k) {
      inputs(k, i) *= std::pow(std::sin(1.5707963267948966 * std::min(1.0, times[k] / 0.5)), 2);
    }
  }
  if (torques) inputs = 4e12 * inputs.array().cube();
  return release(truth, VectorX::Zero(4), capture, seed, inputs, name);
}

TEST(ArmFit, RecoversAPassiveArmAndPredictsOtherRecords) {
  const ArmModel truth{make(fluidic()), {}};
  const ArmFit fit = fit_arm(guess(truth), two_releases(truth, 1), wide({"mass_1"}));
  EXPECT_TRUE(fit.fit.converged);
  EXPECT_EQ(fit.undetermined(), 0);
  EXPECT_EQ(fit.own, 6);  // N + 2
  const auto values = true_values(truth);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const FittedParameter& p = fit.fit.parameters[k];
    EXPECT_NEAR(p.value, values[k], 4.0 * p.standard_error + 1e-12) << p.name;
    EXPECT_LT(p.standard_error, 0.15 * values[k]) << p.name;
  }
  EXPECT_NEAR(fit.fit.noise, kCapture.noise, 0.05 * kCapture.noise);
  const std::vector<MotionRecord> others = {release(truth, kThird, kCapture, 77)};
  EXPECT_LT(validate_arm(fit.model, others, {.time_step = 5e-3})[0].nrmse, 0.05);
  EXPECT_GT(validate_arm(guess(truth), others, {.time_step = 5e-3})[0].nrmse, 0.05);
}

TEST(ArmFit, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const ArmModel truth{make(fluidic()), {}};
  const auto values = true_values(truth);
  constexpr int kSeeds = 20;
  int inside = 0, all = 0;
  double distance = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ArmFit fit = fit_arm(guess(truth), two_releases(truth, seed), wide({"mass_1"}));
    for (std::size_t k = 0; k < values.size(); ++k) {
      const FittedParameter& p = fit.fit.parameters[k];
      if (p.fixed) continue;
      EXPECT_FALSE(p.at_bound) << p.name;
      inside += p.interval_lower <= values[k] && values[k] <= p.interval_upper ? 1 : 0;
      ++all;
    }
    // Mahalanobis distance, chi squared with five degrees of freedom: the intervals of one fit are
    // correlated.
    std::vector<Eigen::Index> free = {0, 2, 3, 4, 5};
    VectorX error(5);
    for (Eigen::Index k = 0; k < 5; ++k) {
      const Eigen::Index at = free[static_cast<std::size_t>(k)];
      error[k] = fit.fit.values[at] - values[static_cast<std::size_t>(at)];
    }
    const MatrixX covariance = fit.fit.covariance(free, free);
    const VectorX unit = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const VectorX scaled = unit.asDiagonal() * error;
    distance += scaled.dot(VectorX(
        linalg::solve_symmetric(unit.asDiagonal() * covariance * unit.asDiagonal(), scaled)));
  }
  EXPECT_EQ(all, 5 * kSeeds);
  EXPECT_GE(inside, 87);  // 95 expected
  // The probability that chi squared with 100 degrees of freedom is outside these limits is one per
  // cent.
  EXPECT_GT(distance, 67.0);
  EXPECT_LT(distance, 140.0);
}

TEST(ArmFit, ScaleIsReportedWhereMotionAloneIsSeen) {
  const ArmModel truth{make(fluidic()), {}};
  const auto records = two_releases(truth, 3);
  const ArmFit free = fit_arm(guess(truth), records, wide({}));
  ASSERT_EQ(free.undetermined(), 1);
  const Direction& scale = free.fit.directions.back();
  EXPECT_LT(scale.singular_value, 1e-9 * free.fit.directions.front().singular_value);
  // Masses, stiffness and damping scale by a common factor.
  for (Eigen::Index k = 0; k < 6; ++k) {
    EXPECT_NEAR(std::abs(scale.weights[k]), 1.0 / std::sqrt(6.0), 1e-6);
    EXPECT_FALSE(free.fit.parameters[static_cast<std::size_t>(k)].determined);
  }
  // The scale is free: the motion fits equally well with a fixed mass.
  const ArmFit fixed = fit_arm(guess(truth), records, wide({"mass_1"}));
  EXPECT_EQ(fixed.undetermined(), 0);
  EXPECT_NEAR(free.fit.cost, fixed.fit.cost, 1e-6 * fixed.fit.cost);
}

TEST(ArmFit, ActuatedArmHasTwoNAndTwoParameters) {
  const ArmModel truth = actuated();
  const std::vector<MotionRecord> records = {driven(truth, 1, "a"), driven(truth, 2, "b")};
  const ArmFit fit = fit_arm(guess(truth), records, wide({"mass_1"}));
  EXPECT_EQ(fit.own, 10);  // 2 N + 2
  EXPECT_EQ(fit.undetermined(), 0);
  const auto values = true_values(truth);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const FittedParameter& p = fit.fit.parameters[k];
    EXPECT_NEAR(p.value, values[k], 4.0 * p.standard_error + 1e-12) << p.name;
    EXPECT_LT(p.standard_error, 0.15 * values[k]) << p.name;
  }
  const std::vector<MotionRecord> others = {driven(truth, 5, "c")};
  EXPECT_LT(validate_arm(fit.model, others, {.time_step = 5e-3})[0].nrmse, 0.05);
  // The scale also affects the actuators' coefficients, but not the delay.
  const ArmFit free = fit_arm(guess(truth), records, wide({}));
  ASSERT_EQ(free.undetermined(), 1);
  const VectorX& weights = free.fit.directions.back().weights;
  for (Eigen::Index k = 0; k < 9; ++k) EXPECT_NEAR(std::abs(weights[k]), 1.0 / 3.0, 1e-5);
  EXPECT_NEAR(weights[9], 0.0, 1e-6);
  EXPECT_TRUE(free.fit.parameter("delay").determined);
}

TEST(ArmFit, KnownTorquesLeaveNoScale) {
  ArmModel truth = actuated();
  truth.actuators.clear();
  const std::vector<MotionRecord> records = {driven(truth, 1, "a", true)};
  const ArmFit fit = fit_arm(guess(truth), records, wide({}));
  EXPECT_EQ(fit.undetermined(), 0);
  const auto values = true_values(truth);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const FittedParameter& p = fit.fit.parameters[k];
    EXPECT_NEAR(p.value, values[k], 4.0 * p.standard_error) << p.name;
  }
}

TEST(ArmFit, MovingStartsAreFitted) {
  const ArmModel truth{make(fluidic()), {}};
  MotionRecord record = release(truth, kFirst, kCapture, 4);
  // The record starts at 0.2 s.
  const Eigen::Index from = 10, left = record.samples() - from;
  record.time = record.time.tail(left).eval();
  record.position = record.position.bottomRows(left).eval();
  record.input = MatrixX(left, 0);
  ArmFitSettings settings = wide({"mass_1"});
  settings.start = RecordStart::moving;
  const ArmFit moving = fit_arm(guess(truth), std::vector{record}, settings);
  EXPECT_NEAR(moving.fit.noise, kCapture.noise, 0.1 * kCapture.noise);
  EXPECT_GT(moving.records[0].start.rate.norm(), 0.5);
}

TEST(ArmFit, MeetsADistributedArmWithinPublishedBounds) {
  const ArmModel truth{make(fluidic(pcc::MassCentre::distributed)), {}};
  const auto records = two_releases(truth, 6);
  const ArmFit fit = fit_arm(guess(truth), records, {.fixed = {"mass_1"}});
  for (const RecordFit& record : fit.records) {
    EXPECT_LT(record.summed_error, 0.5 * record.start_summed_error);
  }
  // The model is wrong, and the residuals show it.
  EXPECT_GT(fit.fit.noise, 2.0 * kCapture.noise);
  for (const FittedParameter& p : fit.fit.parameters) {
    EXPECT_GE(p.value, p.lower) << p.name;
    EXPECT_LE(p.value, p.upper) << p.name;
  }
}

TEST(ArmFit, RefusesWhatItCannotUse) {
  const ArmModel truth{make(fluidic()), {}};
  const MotionRecord good = release(truth, kFirst, kCapture, 1);
  const auto fit = [&](const MotionRecord& record, ArmFitSettings settings = {}) {
    fit_arm(truth, std::vector{record}, settings);
  };
  EXPECT_EQ(kind_of([&] { fit_arm(truth, {}); }), ErrorKind::empty_list);
  MotionRecord bad = good;
  bad.time[5] = bad.time[4];
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::non_monotonic_time);
  bad = good;
  bad.time.conservativeResize(8);
  bad.position.conservativeResize(8, Eigen::NoChange);
  bad.input.resize(8, 0);
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::too_few_points);
  bad = good;
  bad.position.conservativeResize(Eigen::NoChange, 9);
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::wrong_length);
  bad = good;
  bad.input = MatrixX::Zero(bad.samples(), 2);
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::wrong_length);
  EXPECT_EQ(kind_of([&] { fit(good, {.fixed = {"mass_9"}}); }), ErrorKind::unknown_name);
  EXPECT_EQ(kind_of([&] { fit(good, {.mass_spread = 1.0}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { fit(good, {.damping_lower = 5e-3}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { fit(good, {.search = {.starts = 0}}); }), ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::identify
