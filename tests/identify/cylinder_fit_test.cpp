// Drive cylinders and actuators from synthetic records.
#include "sinew/identify/cylinder_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/random.hpp"
#include "sinew/identify/actuator_fit.hpp"
#include "sinew/pcc/excitation.hpp"

#include "support/error_kind.hpp"

namespace sinew::identify {
namespace {

using pcc::DriveCylinder;
using pcc::Excitation;
using sinew::testing::kind_of;

DriveRecord record_of(const DriveCylinder& cylinder, double noise, std::uint64_t seed,
                      Eigen::Index samples = 1000) {
  DriveRecord record;
  record.name = "trial " + std::to_string(seed);
  record.sample_time = cylinder.sample_time;
  const VectorX times =
      VectorX::LinSpaced(samples, 0.0, static_cast<double>(samples - 1) * cylinder.sample_time);
  record.input = Excitation({.amplitude = 3e-5, .seed = seed}).sample(times);
  record.output = cylinder.simulate(record.input, {1e-5, -1e-5});
  Random random(1000 + seed);
  for (double& y : record.output) y += noise * random.normal();
  return record;
}

const DriveCylinder kTrueCylinder = DriveCylinder::second_order(0.9, 15.0, 0.6, 0.01);

double a1(const DriveCylinder& c) { return -c.a.trace(); }
double a2(const DriveCylinder& c) { return c.a.determinant(); }

TEST(CylinderFit, SubspaceIsExactWithoutNoise) {
  const std::vector<DriveRecord> records = {record_of(kTrueCylinder, 0.0, 1),
                                            record_of(kTrueCylinder, 0.0, 2)};
  const CylinderFit fit = fit_cylinder(records);
  for (const DriveCylinder* found : {&fit.start, &fit.cylinder}) {
    EXPECT_NEAR(a1(*found), a1(kTrueCylinder), 1e-6);
    EXPECT_NEAR(a2(*found), a2(kTrueCylinder), 1e-6);
    EXPECT_NEAR(found->gain(), 0.9, 1e-6);
  }
  EXPECT_LT(fit.trials[1].nrmse, 1e-6);
}

TEST(CylinderFit, OutputErrorHoldsTheTruthAndPredictsOtherRecords) {
  constexpr double kNoise = 1e-6;
  const std::vector<DriveRecord> records = {record_of(kTrueCylinder, kNoise, 1),
                                            record_of(kTrueCylinder, kNoise, 2)};
  const CylinderFit fit = fit_cylinder(records);
  const Eigen::Matrix2d shifted = kTrueCylinder.a + a1(kTrueCylinder) * Eigen::Matrix2d::Identity();
  const double truth[] = {a1(kTrueCylinder), a2(kTrueCylinder),
                          kTrueCylinder.c.dot(kTrueCylinder.b),
                          kTrueCylinder.c.dot(shifted * kTrueCylinder.b)};
  for (std::size_t k = 0; k < 4; ++k) {
    const FittedParameter& p = fit.fit.parameters[k];
    // Four standard errors, for one run with one seed.
    EXPECT_NEAR(p.value, truth[k], 4.0 * p.standard_error) << p.name;
  }
  // b1 and b2 separately act at high frequencies only, which the signal does not contain.
  EXPECT_LT(fit.fit.parameters[0].standard_error, 0.05);
  EXPECT_NEAR(fit.cylinder.gain(), 0.9, 0.01);
  EXPECT_NEAR(fit.fit.noise, kNoise, 0.1 * kNoise);
  // Refinement is never worse than its start, which is biased by noise.
  EXPECT_LE(fit.fit.cost, fit.fit.start_cost);
  std::vector<DriveRecord> others;
  for (std::uint64_t seed = 11; seed <= 14; ++seed)
    others.push_back(record_of(kTrueCylinder, kNoise, seed));
  for (const CylinderTrial& trial : validate_cylinder(fit.cylinder, others)) {
    // Noise alone gives 1e-6 over a standard deviation of about 1.4e-5.
    EXPECT_LT(trial.nrmse, 0.1) << trial.name;
    EXPECT_GT(trial.nrmse, 0.03) << trial.name;
  }
}

TEST(CylinderFit, FindsAFeedthrough) {
  DriveCylinder truth = kTrueCylinder;
  truth.d = 0.2;
  const std::vector<DriveRecord> records = {record_of(truth, 0.0, 3)};
  const CylinderFit fit = fit_cylinder(records, {.feedthrough = true});
  EXPECT_NEAR(fit.cylinder.d, 0.2, 1e-6);
  EXPECT_NEAR(a1(fit.cylinder), a1(kTrueCylinder), 1e-6);
}

TEST(CylinderFit, RefusesWhatItCannotUse) {
  const auto fit = [](DriveRecord record) { fit_cylinder(std::vector<DriveRecord>{record}); };
  const DriveRecord good = record_of(kTrueCylinder, 0.0, 1);
  EXPECT_EQ(kind_of([] { fit_cylinder({}); }), ErrorKind::empty_list);
  EXPECT_EQ(kind_of([&] { fit(record_of(kTrueCylinder, 0.0, 1, 30)); }), ErrorKind::too_few_points);
  DriveRecord bad = good;
  bad.output.conservativeResize(500);
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::wrong_length);
  bad = good;
  bad.input.setConstant(1.0);
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::out_of_range);
  bad = good;
  bad.output[7] = NAN;
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::not_finite);
  bad = good;
  bad.sample_time = 0.0;
  EXPECT_EQ(kind_of([&] { fit(bad); }), ErrorKind::out_of_range);
}

TEST(DriveRecord, ReadsItsHeader) {
  const DriveRecord record =
      parse_drive_record("time [ms],command,volume [ml]\n0,1,2\n10,2,3\n20,3,4\n", "first.csv");
  EXPECT_EQ(record.name, "first");
  EXPECT_DOUBLE_EQ(record.sample_time, 0.01);
  EXPECT_DOUBLE_EQ(record.input[2], 3.0);
  EXPECT_DOUBLE_EQ(record.output[1], 3e-6);
  const auto parse = [](const char* text) { parse_drive_record(text, "x"); };
  EXPECT_DOUBLE_EQ(
      parse_drive_record("time [s],command [mV],volume [ml]\n0,1,2\n1,2,2\n2,3,2\n", "x").input[1],
      2e-3);
  EXPECT_EQ(kind_of([&] { parse("time [s],command,volume [m]\n0,1,2\n1,1,2\n2,1,2\n"); }),
            ErrorKind::wrong_dimension);
  EXPECT_EQ(kind_of([&] { parse("time [s],command [units],volume [ml]\n0,1,2\n1,1,2\n2,1,2\n"); }),
            ErrorKind::unknown_unit);
  EXPECT_EQ(kind_of([&] { parse("time [s],volume [ml]\n0,1\n1,1\n2,1\n"); }),
            ErrorKind::wrong_columns);
  EXPECT_EQ(kind_of([&] { parse("time [s],command,volume [ml]\n0,1,2\n1,1,2\n1,1,2\n2,1,2\n"); }),
            ErrorKind::non_monotonic_time);
  EXPECT_EQ(kind_of([&] { parse("time [s],command,volume [ml]\n0,1,2\n1,1,2\n3,1,2\n"); }),
            ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { parse("time [s],command,volume [ml]\n0,1,2\n1,1,2\n"); }),
            ErrorKind::too_few_points);
}

TEST(ActuatorFit, FindsCoefficientAndDelay) {
  const pcc::FluidicActuator truth{0.0, 4e12, 0.085};
  const Excitation volume({.amplitude = 2.5e-5, .seed = 4});
  ActuatorRecord record;
  record.name = "bench";
  record.time = VectorX::LinSpaced(500, 0.0, 4.99);
  record.volume = volume.sample(record.time);
  Random random(9);
  record.torque = record.time.unaryExpr(
      [&](double t) { return truth.torque(volume.at(t - truth.delay)) + 1e-3 * random.normal(); });
  // The volume before the record is unknown.
  record.torque.head(10).setConstant(NAN);
  const ActuatorFit fit = fit_actuator(std::vector<ActuatorRecord>{record});
  const auto& cubic = fit.fit.parameter("cubic");
  const auto& delay = fit.fit.parameter("delay");
  EXPECT_NEAR(cubic.value, truth.cubic, 4.0 * cubic.standard_error);
  EXPECT_NEAR(delay.value, truth.delay, 4.0 * delay.standard_error);
  EXPECT_LT(delay.standard_error, 1e-3);
  EXPECT_LT(cubic.standard_error, 0.02 * truth.cubic);
  EXPECT_EQ(fit.actuator.linear, 0.0);
  // An existing linear term is identified.
  const pcc::FluidicActuator both{900.0, 4e12, 0.085};
  record.torque =
      record.time.unaryExpr([&](double t) { return both.torque(volume.at(t - both.delay)); });
  record.torque.head(10).setConstant(NAN);
  const ActuatorFit second = fit_actuator(std::vector<ActuatorRecord>{record}, true);
  EXPECT_NEAR(second.actuator.linear, 900.0, 9.0);
  EXPECT_NEAR(second.actuator.cubic, 4e12, 4e10);
  EXPECT_NEAR(second.actuator.delay, 0.085, 1e-4);
  EXPECT_EQ(kind_of([] { fit_actuator({}); }), ErrorKind::empty_list);
  record.time[3] = record.time[2];
  EXPECT_EQ(kind_of([&] { fit_actuator(std::vector<ActuatorRecord>{record}); }),
            ErrorKind::non_monotonic_time);
}

}  // namespace
}  // namespace sinew::identify
