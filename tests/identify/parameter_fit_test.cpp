// Fits of named parameters of any model, and records of motion.
#include "sinew/identify/parameter_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/random.hpp"
#include "sinew/identify/motion_record.hpp"
#include "sinew/identify/statistics.hpp"

#include "support/error_kind.hpp"

namespace sinew::identify {
namespace {

using sinew::testing::kind_of;

const VectorX kTimes = VectorX::LinSpaced(60, 0.0, 3.0);

/// p0 e^(-p1 t) + p2.
VectorX decay(const VectorX& p) {
  return kTimes.unaryExpr([&](double t) { return p[0] * std::exp(-p[1] * t) + p[2]; });
}

ForwardModel decay_model() {
  return {kTimes.size(), [](const VectorX& p, VectorX& prediction, MatrixX* jacobian) {
            prediction = decay(p);
            if (jacobian == nullptr) return;
            jacobian->col(0) = kTimes.unaryExpr([&](double t) { return std::exp(-p[1] * t); });
            jacobian->col(1) =
                kTimes.unaryExpr([&](double t) { return -t * p[0] * std::exp(-p[1] * t); });
            jacobian->col(2).setOnes();
          }};
}

const std::vector<Parameter> kParameters = {
    {"size", 1.0, 0.0, 10.0}, {"rate", 0.3, 0.0, 10.0}, {"offset", 0.0, -5.0, 5.0}};
const VectorX kTruth{{2.0, 1.5, 0.7}};

VectorX measured(double noise, std::uint64_t seed) {
  Random random(seed);
  VectorX result = decay(kTruth);
  for (double& value : result) value += noise * random.normal();
  return result;
}

TEST(ParameterFit, IntervalsCoverAsTheySay) {
  constexpr int kSeeds = 400;
  int inside[3] = {0, 0, 0};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ParameterFit fit = fit_parameters(decay_model(), measured(0.05, seed), kParameters);
    for (std::size_t k = 0; k < 3; ++k) {
      const FittedParameter& p = fit.parameters[k];
      const double truth = kTruth[static_cast<Eigen::Index>(k)];
      inside[k] += p.interval_lower <= truth && truth <= p.interval_upper ? 1 : 0;
    }
  }
  // 380 +- 4.4 expected for each; within three standard errors.
  for (const int count : inside) EXPECT_NEAR(count, 380, 14);
}

TEST(ParameterFit, DifferencesDoAsWellAsDerivatives) {
  const VectorX data = measured(0.02, 5);
  const ParameterFit exact = fit_parameters(decay_model(), data, kParameters);
  const ParameterFit numeric =
      fit_parameters(with_differences(kTimes.size(), decay, VectorX::Ones(3)), data, kParameters);
  EXPECT_LT((exact.values - numeric.values).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(exact.parameters[1].standard_error, numeric.parameters[1].standard_error, 1e-6);
}

TEST(ParameterFit, GapsAreLeftOut) {
  VectorX data = measured(0.0, 1);
  for (Eigen::Index i = 0; i < data.size(); i += 3) data[i] = NAN;
  const ParameterFit fit = fit_parameters(decay_model(), data, kParameters);
  EXPECT_LT((fit.values - kTruth).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_TRUE(std::isnan(fit.residual[0]));
  EXPECT_EQ(fit.degrees_of_freedom, 40 - 3);
}

TEST(ParameterFit, SolutionsOnBoundsAreExact) {
  std::vector<Parameter> parameters = kParameters;
  parameters[1].upper = 1.2;  // the truth is 1.5
  const VectorX data = measured(0.02, 3);
  const ParameterFit bounded = fit_parameters(decay_model(), data, parameters);
  EXPECT_TRUE(bounded.parameters[1].at_bound);
  EXPECT_EQ(bounded.values[1], 1.2);
  // The optimum of the other parameters with the rate fixed at its bound.
  parameters[1] = {"rate", 1.2, 0.0, 10.0, "", true};
  const ParameterFit held = fit_parameters(decay_model(), data, parameters);
  EXPECT_NEAR(bounded.cost, held.cost, 1e-9 * held.cost);
  EXPECT_NEAR(bounded.values[0], held.values[0], 1e-6);
  EXPECT_NEAR(bounded.parameters[0].standard_error, held.parameters[0].standard_error, 1e-6);
}

TEST(ParameterFit, TellsDirectionsThatDataDoNotDetermine) {
  // Only the product of size and gain affects the data.
  const auto predict = [](const VectorX& p) { return decay(VectorX{{p[0] * p[3], p[1], p[2]}}); };
  std::vector<Parameter> parameters = kParameters;
  parameters.push_back({"gain", 1.0, 0.0, 10.0});
  const ParameterFit fit = fit_parameters(
      with_differences(kTimes.size(), predict, VectorX::Ones(4)), measured(0.01, 2), parameters);
  ASSERT_EQ(fit.undetermined(), 1);
  const VectorX& weights = fit.directions.back().weights;
  EXPECT_NEAR(std::abs(weights[0]), std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(weights[0], -weights[3], 1e-4);
  EXPECT_FALSE(fit.parameter("gain").determined);
  EXPECT_TRUE(std::isinf(fit.parameter("size").standard_error));
  EXPECT_TRUE(fit.parameter("rate").determined);
  EXPECT_LT(fit.parameter("rate").standard_error, 0.1);
  EXPECT_NEAR(fit.values[0] * fit.values[3], 2.0, 0.05);
}

TEST(ParameterFit, ManyStartsFindTheDeeperMinimum) {
  // The cost has a local minimum near each alias of the frequency.
  const auto predict = [](const VectorX& p) -> VectorX {
    return kTimes.unaryExpr([&](double t) { return std::sin(p[0] * t); });
  };
  const VectorX data = predict(VectorX{{8.0}});
  const ForwardModel model = with_differences(kTimes.size(), predict, VectorX::Ones(1));
  const std::vector<Parameter> parameters = {{"frequency", 1.0, 0.5, 12.0}};
  EXPECT_GT(fit_parameters(model, data, parameters).cost, 1.0);
  const ParameterFit fit = fit_parameters(model, data, parameters, {.starts = 30});
  EXPECT_NEAR(fit.values[0], 8.0, 1e-6);
  EXPECT_EQ(fit.costs.size(), 30u);
  EXPECT_GT(fit.best_start, 0);
}

TEST(ParameterFit, FailedRunsAreSteppedRoundAndOtherErrorsCome) {
  const auto failing = [](ErrorKind kind) {
    return with_differences(
        kTimes.size(),
        [kind](const VectorX& p) {
          if (p[1] > 2.0) throw Error(kind, {}, "too far");
          return decay(p);
        },
        VectorX::Ones(3));
  };
  std::vector<Parameter> parameters = kParameters;
  const ParameterFit fit =
      fit_parameters(failing(ErrorKind::diverged), measured(0.0, 1), parameters, {.starts = 5});
  EXPECT_LT((fit.values - kTruth).cwiseAbs().maxCoeff(), 1e-6);
  parameters[1].start = 3.0;
  EXPECT_EQ(
      kind_of([&] { fit_parameters(failing(ErrorKind::diverged), measured(0.0, 1), parameters); }),
      ErrorKind::not_converged);
  EXPECT_EQ(kind_of([&] {
              fit_parameters(failing(ErrorKind::unknown_key), measured(0.0, 1), parameters);
            }),
            ErrorKind::unknown_key);
}

TEST(ParameterFit, RefusesWhatItCannotFit) {
  const VectorX data = measured(0.0, 1);
  const auto fit = [&](std::vector<Parameter> parameters, ParameterFitSettings settings = {}) {
    fit_parameters(decay_model(), data, parameters, settings);
  };
  auto parameters = kParameters;
  parameters[0].lower = 20.0;
  EXPECT_EQ(kind_of([&] { fit(parameters); }), ErrorKind::contradictory_limits);
  parameters = kParameters;
  parameters[0].start = 11.0;
  EXPECT_EQ(kind_of([&] { fit(parameters); }), ErrorKind::out_of_range);
  parameters[0].start = NAN;
  EXPECT_EQ(kind_of([&] { fit(parameters); }), ErrorKind::not_finite);
  EXPECT_EQ(kind_of([&] { fit({}); }), ErrorKind::empty_list);
  EXPECT_EQ(kind_of([&] { fit(kParameters, {.confidence = 1.0}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { fit_parameters(decay_model(), VectorX::Zero(3), kParameters); }),
            ErrorKind::wrong_length);
  VectorX gaps = VectorX::Constant(60, NAN);
  gaps[0] = gaps[1] = 1.0;
  EXPECT_EQ(kind_of([&] { fit_parameters(decay_model(), gaps, kParameters); }),
            ErrorKind::too_few_points);
  EXPECT_EQ(kind_of([&] { fit_parameters(decay_model(), data, kParameters).parameter("siz"); }),
            ErrorKind::unknown_name);
}

TEST(StudentQuantile, IsThatOfTheTables) {
  EXPECT_NEAR(student_quantile(0.975, 1), 12.706, 1e-3);
  EXPECT_NEAR(student_quantile(0.975, 2), 4.3027, 1e-4);
  EXPECT_NEAR(student_quantile(0.975, 5), 2.5706, 2e-3);
  EXPECT_NEAR(student_quantile(0.975, 30), 2.0423, 1e-4);
  EXPECT_NEAR(student_quantile(0.995, 10), 3.1693, 2e-3);
  EXPECT_NEAR(student_quantile(0.975, 1000000), 1.95996, 1e-5);
  EXPECT_NEAR(student_quantile(0.5, 7), 0.0, 1e-12);
}

TEST(Nrmse, IsOneForTheMeanAndZeroForTheTruth) {
  MatrixX data(4, 2);
  data << 1, 10, 2, 20, 3, 30, 4, NAN;
  MatrixX mean(4, 2);
  mean.col(0).setConstant(2.5);
  mean.col(1).setConstant(20.0);
  EXPECT_NEAR(nrmse(mean, data), 1.0, 1e-12);
  EXPECT_EQ(nrmse(data.unaryExpr([](double x) { return std::isnan(x) ? 0.0 : x; }), data), 0.0);
  EXPECT_EQ(kind_of([] { nrmse(MatrixX::Ones(3, 1), MatrixX::Ones(3, 1)); }),
            ErrorKind::out_of_range);
}

constexpr const char* kTable =
    "Take 2026-01-01;;;;;;\n"
    "Frame time [ms];x_0 [mm];z_0 [mm];x_1 [mm];y_1 [mm];z_1 [mm];volume_0 [ml]\n"
    "0;10;-140;20;;-280;1\n"
    "9;11;-141;nan;2;-281;2\n"
    "21;;;;;;3\n";

TEST(MotionRecord, ReadsUnitsAndGaps) {
  std::string table = kTable;
  table.replace(table.find("Frame time"), 10, "time");
  const MotionRecord record = parse_motion_record(table, "take.csv", 2);
  EXPECT_EQ(record.name, "take");
  EXPECT_DOUBLE_EQ(record.time[1], 0.009);
  EXPECT_DOUBLE_EQ(record.position(0, 0), 0.01);
  EXPECT_DOUBLE_EQ(record.position(1, 4), 0.002);
  EXPECT_TRUE(std::isnan(record.position(0, 1)));  // no column
  EXPECT_TRUE(std::isnan(record.position(0, 4)));  // an empty cell
  EXPECT_TRUE(std::isnan(record.position(1, 3)));
  EXPECT_EQ(record.seen(), 4 + 4);
  EXPECT_DOUBLE_EQ(record.input(2, 0), 3e-6);
  const MotionRecord again = parse_motion_record(motion_csv(record), "take.csv", 2);
  EXPECT_EQ(again.seen(), record.seen());
  EXPECT_EQ(again.position(1, 5), record.position(1, 5));
  EXPECT_EQ(again.input(2, 0), record.input(2, 0));
}

TEST(MotionRecord, RefusesWhatItCannotRead) {
  const auto kind = [](const char* table) {
    return kind_of([&] { parse_motion_record(table, "x.csv", 1); });
  };
  EXPECT_EQ(kind("time [s],x_0 [mm]\n0,1\n1,2\n1,3\n"), ErrorKind::non_monotonic_time);
  EXPECT_EQ(kind("time [s],x_0 [mm]\n0,1\n1,2\n"), ErrorKind::too_few_points);
  EXPECT_EQ(kind("time [s],x_0\n0,1\n1,2\n2,3\n"), ErrorKind::wrong_columns);
  EXPECT_EQ(kind("time [s],x_1 [mm]\n0,1\n1,2\n2,3\n"), ErrorKind::wrong_columns);
  EXPECT_EQ(kind("x_0 [mm],y_0 [mm]\n0,1\n1,2\n2,3\n"), ErrorKind::wrong_columns);
  EXPECT_EQ(kind("time [s],x_0 [mm],volume_1 [ml]\n0,1,1\n1,2,1\n2,3,1\n"),
            ErrorKind::wrong_columns);
  EXPECT_EQ(kind("time [s],x_0 [mm],volume_0 [ml],torque_0 [N m]\n0,1,1,1\n1,2,1,1\n2,3,1,1\n"),
            ErrorKind::wrong_columns);
  EXPECT_EQ(kind("time [s],x_0 [mm],volume_0 [ml]\n0,1,1\n1,2,\n2,3,1\n"), ErrorKind::not_finite);
  EXPECT_EQ(kind("time [s],x_0 [mm]\n0,\n1,\n2,\n"), ErrorKind::out_of_range);
  EXPECT_EQ(kind("time [s],x_0 [mm]\n0,a\n1,2\n2,3\n"), ErrorKind::malformed_table);
}

TEST(InputSignal, IsExactForParabolasAndConstantOutside) {
  MotionRecord record;
  record.time = VectorX{{0.0, 0.1, 0.35, 0.4, 0.9}};
  const auto parabola = [](double t) { return 2.0 - 3.0 * t + 5.0 * t * t; };
  record.input = record.time.unaryExpr(parabola);
  const InputSignal signal(record);
  for (const double t : {0.0, 0.05, 0.2, 0.37, 0.6, 0.89}) {
    EXPECT_NEAR(signal.at(0, t).value, parabola(t), 1e-12);
    EXPECT_NEAR(signal.at(0, t).rate, -3.0 + 10.0 * t, 1e-10);
  }
  EXPECT_EQ(signal.at(0, -1.0).value, 2.0);
  EXPECT_EQ(signal.at(0, -1.0).rate, 0.0);
  EXPECT_EQ(signal.at(0, 2.0).rate, 0.0);
  EXPECT_DOUBLE_EQ(signal.at(0, 2.0).value, parabola(0.9));
}

}  // namespace
}  // namespace sinew::identify
