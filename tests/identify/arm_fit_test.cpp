// Arms from synthetic motion capture: what is found is what made the records.
#include "sinew/identify/arm_fit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pcc/arms.hpp"
#include "support/error_kind.hpp"

#include "arm_records.hpp"

namespace sinew::identify {
namespace {

using pcc::testing::fluidic;
using pcc::testing::make;
using testing::release;

/// The arm with masses, stiffness and damping off by these factors.
std::shared_ptr<const pcc::Arm> off(pcc::ArmSettings settings, const std::vector<double>& masses,
                                    double stiffness, double damping) {
  for (std::size_t i = 0; i < settings.segments.size(); ++i) {
    settings.segments[i].mass *= masses[i];
    settings.segments[i].stiffness *= stiffness;
    settings.segments[i].damping *= damping;
  }
  return make(settings);
}

const VectorX kPose{{0.5, 0.4, 0.6, 0.5}}, kOther{{-0.4, 0.7, -0.6, 0.8}};

TEST(ArmFit, RecoversAPassiveArm) {
  const ArmModel truth{make(fluidic()), {}};
  const std::vector<MotionRecord> records = {release(truth, kPose, {}, 1, {}, "a"),
                                             release(truth, kOther, {}, 2, {}, "b")};
  const ArmModel start{off(fluidic(), {0.85, 1.0, 0.85, 1.15}, 0.9, 0.8), {}};
  const ArmFit fit = fit_arm(start, records, {.fixed = {"mass_1"}});
  for (Eigen::Index k = 0; k < fit.own; ++k) {
    const auto& p = fit.fit.parameters[static_cast<std::size_t>(k)];
    fmt::print("{} {:.5g} [{:.5g}, {:.5g}] {} {}\n", p.name, p.value, p.interval_lower, p.interval_upper, p.at_bound, p.determined);
  }
  fmt::print("it {} cost {} -> {} noise {} nrmse {} summed {} -> {}\n", fit.fit.iterations, fit.fit.start_cost, fit.fit.cost,
             fit.fit.noise, fit.records[0].nrmse, fit.records[0].start_summed_error,
             fit.records[0].summed_error);
  for (const auto& d : fit.fit.directions) fmt::print("{:.4g} {:.4g} {}\n", d.singular_value, d.relative_error, d.undetermined);
}

}  // namespace
}  // namespace sinew::identify
