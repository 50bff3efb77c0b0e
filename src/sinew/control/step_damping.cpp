#include "sinew/control/step_damping.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::control {

namespace {

constexpr double kMaxDamping = 1e6;
constexpr double kGrowth = 4.0;
constexpr double kDecay = 0.5;
constexpr double kGrowthAfterFailure = 16.0;
constexpr double kBad = 0.75;
constexpr double kGood = 0.25;
// Relative changes of the objective below this are too small to judge by.
constexpr double kNegligible = 1e-6;

}  // namespace

bool StepDamping::review(double before, double foreseen, double found, double negligible) {
  const double noise = kNegligible * before + negligible;
  const double change = std::abs(before - foreseen);
  if (change <= noise && std::abs(found - before) <= noise) return false;
  const double worse = found - foreseen;
  if (worse > kBad * change + noise) {
    value_ = std::min(kMaxDamping, kGrowth * value_);
  } else if (worse <= kGood * change) {
    relax();
  }
  return true;
}

void StepDamping::reject() { value_ = std::min(kMaxDamping, kGrowthAfterFailure * value_); }

void StepDamping::relax() { value_ = std::max(1.0, kDecay * value_); }

}  // namespace sinew::control
