#include "sinew/identify/bending_fit.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "support/error_kind.hpp"

namespace sinew::identify {
namespace {

using pcc::BendingModulus;
using pcc::BendingParameters;
using pcc::ModulusKind;
using sinew::testing::kind_of;

/// Pressure A/2 (1 - cos(2 pi t/T)) above `floor`, at uneven times with a gap.
TipRecord record_of(const BendingParameters& p, double floor, double amplitude, double noise) {
  TipRecord record;
  record.name = "made";
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> jitter(0.6, 1.5);
  for (int k = 0; k < 100; ++k) {
    const double t = 0.05 * (k + jitter(random) - 0.6);
    if (t > 1.5 && t < 1.9) continue;  // the tip was hidden
    record.time.push_back(t);
    record.pressure.push_back(floor +
                              0.5 * amplitude * (1.0 - std::cos(0.4 * std::numbers::pi * t)));
  }
  const auto actuator = std::make_shared<const pcc::BendingActuator>(p);
  const auto states = pcc::simulate(actuator, record.time, record.pressure,
                                    {.angle = actuator->equilibrium(record.pressure[0])}, 2e-3);
  record.tip.resize(static_cast<Eigen::Index>(states.size()), 2);
  std::normal_distribution<double> normal(0.0, noise > 0.0 ? noise : 1.0);
  Eigen::Index row = 0;
  for (const auto& state : states) {
    record.tip.row(row) = actuator->point(state.angle).transpose();
    if (noise > 0.0) record.tip.row(row) += Eigen::RowVector2d(normal(random), normal(random));
    ++row;
  }
  return record;
}

BendingParameters robot(BendingModulus modulus) {
  BendingParameters p;
  p.inclination = 0.4;
  p.stiffness_damping = 5e-3;
  p.modulus = std::move(modulus);
  return p;
}

TEST(BendingFit, FindsTheConstantThatMadeTheRecord) {
  const std::vector<TipRecord> records{record_of(robot(BendingModulus(170e3)), 0.0, 70e3, 0.0)};
  BendingFitSettings settings{.kind = ModulusKind::shear};
  settings.longest_step = 2e-3;
  const BendingFit fit = fit_bending(robot(BendingModulus(400e3)), records, settings);
  EXPECT_TRUE(fit.converged);
  EXPECT_FALSE(fit.at_bound);
  EXPECT_NEAR(fit.parameters.modulus.value(0.0), 170e3, 1.0);
  EXPECT_LT(fit.errors[0].mean_of_length, 1e-6);
}

TEST(BendingFit, FindsThePolynomialAndTheDamping) {
  const BendingModulus truth = BendingModulus::published();
  std::vector<TipRecord> records;
  for (const double amplitude : {40e3, 80e3}) {
    records.push_back(record_of(robot(truth), 10e3, amplitude, 1e-4));
  }
  BendingFitSettings settings{.degree = 5, .damping = true, .highest_damping = 0.1};
  const BendingFit fit = fit_bending(robot(BendingModulus(0.2e6)), records, settings);
  EXPECT_TRUE(fit.converged);
  for (const double pressure : {20e3, 40e3, 60e3, 88e3}) {
    EXPECT_NEAR(fit.parameters.modulus.value(pressure) / truth.value(pressure), 1.0, 0.01);
  }
  EXPECT_EQ(kind_of([&] { fit.parameters.modulus.value(95e3); }), ErrorKind::out_of_range);
  // The residual is the noise: 0.1 mm per axis, over about a hundred rows.
  for (const TipErrors& errors : fit.errors) {
    EXPECT_NEAR(errors.root_mean_square[0], 1e-4, 2.5e-5);
    EXPECT_NEAR(errors.root_mean_square[1], 1e-4, 2.5e-5);
  }
  // A constant modulus fits worse.
  const BendingFit constant = fit_bending(robot(BendingModulus(0.2e6)), records, {});
  EXPECT_GT(constant.cost, 2.0 * fit.cost);
}

TEST(BendingFit, SaysThatABoundDecides) {
  const std::vector<TipRecord> records{record_of(robot(BendingModulus(170e3)), 0.0, 70e3, 0.0)};
  BendingFitSettings settings{.kind = ModulusKind::shear, .lowest = 200e3, .highest = 500e3};
  const BendingFit fit = fit_bending(robot(BendingModulus(400e3)), records, settings);
  EXPECT_TRUE(fit.at_bound);
  EXPECT_NEAR(fit.parameters.modulus.value(0.0), 200e3, 1.0);
}

TEST(TipErrors, AreThoseByHand) {
  PlanePoints found(2, 2), measured(2, 2);
  found << 3e-3, 4e-3, 0.0, 0.0;
  measured << 0.0, 0.0, 0.0, 1e-3;
  const TipErrors errors = tip_errors(found, measured, 0.1);
  EXPECT_DOUBLE_EQ(errors.mean, 3e-3);
  EXPECT_DOUBLE_EQ(errors.largest, 5e-3);
  EXPECT_DOUBLE_EQ(errors.mean_of_length, 0.03);
  EXPECT_DOUBLE_EQ(errors.largest_of_length, 0.05);
  EXPECT_DOUBLE_EQ(errors.mean_absolute[0], 1.5e-3);
  EXPECT_DOUBLE_EQ(errors.mean_absolute[1], 2.5e-3);
  EXPECT_DOUBLE_EQ(errors.root_mean_square[0], std::sqrt(4.5e-6));
  EXPECT_DOUBLE_EQ(errors.root_mean_square[1], std::sqrt(8.5e-6));
  EXPECT_EQ(kind_of([&] { tip_errors(found, PlanePoints(3, 2), 0.1); }), ErrorKind::wrong_length);
  EXPECT_EQ(kind_of([&] { tip_errors(found, measured, 0.0); }), ErrorKind::out_of_range);
}

TEST(TipRecord, UnitsComeFromTheHeader) {
  const TipRecord record = parse_tip_record(
      "frame,time_ms,x [mm],y (cm),pressure_kPa\n1,0,1,-10,20\n2,100,2,-9,30\n3,250,3,-8,40\n",
      "a/tip.csv");
  EXPECT_EQ(record.name, "tip");
  EXPECT_DOUBLE_EQ(record.time[2], 0.25);
  EXPECT_DOUBLE_EQ(record.tip(1, 0), 2e-3);
  EXPECT_DOUBLE_EQ(record.tip(1, 1), -0.09);
  EXPECT_DOUBLE_EQ(record.pressure[0], 20e3);
  EXPECT_TRUE(parse_tip_record("t_s,x_m,z_m\n0,0,0\n1,0,0\n2,0,0\n", "b").pressure.empty());
}

TEST(TipRecord, RefusesBrokenTables) {
  const auto kind = [](const char* text) {
    return kind_of([&] { parse_tip_record(text, "tip"); });
  };
  EXPECT_EQ(kind("time_s,x_m\n0,0\n1,0\n2,0\n"), ErrorKind::wrong_columns);
  EXPECT_EQ(kind("time,x_m,y_m\n0,0,0\n1,0,0\n2,0,0\n"), ErrorKind::wrong_columns);
  EXPECT_EQ(kind("time_s,x_s,y_m\n0,0,0\n1,0,0\n2,0,0\n"), ErrorKind::wrong_columns);
  EXPECT_EQ(kind("0,0,0\n1,0,0\n2,0,0\n"), ErrorKind::wrong_columns);
  EXPECT_EQ(kind("time_s,x_m,y_m\n0,0,0\n1,0,0\n"), ErrorKind::too_few_points);
  EXPECT_EQ(kind("time_s,x_m,y_m\n0,0,0\n2,0,0\n1,0,0\n"), ErrorKind::non_monotonic_time);
}

TEST(BendingFit, RefusesWhatCannotBeFitted) {
  const BendingParameters p = robot(BendingModulus(170e3));
  const TipRecord good = record_of(p, 0.0, 70e3, 0.0);
  const auto kind = [&](const auto& change, BendingFitSettings settings) {
    std::vector<TipRecord> records{good};
    change(records);
    return kind_of([&] { fit_bending(p, records, settings); });
  };
  const auto same = [](auto&) {};
  EXPECT_EQ(kind([](auto& r) { r.clear(); }, {}), ErrorKind::empty_list);
  EXPECT_EQ(kind([](auto& r) { r[0].pressure.clear(); }, {}), ErrorKind::missing_key);
  EXPECT_EQ(kind([](auto& r) { r[0].pressure.pop_back(); }, {}), ErrorKind::wrong_length);
  EXPECT_EQ(kind([](auto& r) { r[0].time[2] = r[0].time[1]; }, {}), ErrorKind::non_monotonic_time);
  EXPECT_EQ(kind([](auto& r) { r[0].tip(3, 1) = NAN; }, {}), ErrorKind::not_finite);
  EXPECT_EQ(kind([](auto& r) { r[0].pressure.assign(r[0].time.size(), 1e4); }, {.degree = 1}),
            ErrorKind::out_of_range);
  EXPECT_EQ(kind(same, {.degree = 6}), ErrorKind::out_of_range);
  EXPECT_EQ(kind(same, {.lowest = 2e5, .highest = 1e5}), ErrorKind::contradictory_limits);
  EXPECT_EQ(kind(same, {.damping = true, .highest_damping = 0.0}), ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::identify
