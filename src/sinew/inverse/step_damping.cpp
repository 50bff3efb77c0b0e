#include "sinew/inverse/step_damping.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inverse {

namespace {

constexpr double kMost = 1e8;
constexpr double kGrowth = 4.0;
constexpr double kDecay = 0.5;
constexpr double kBad = 0.75;
constexpr double kGood = 0.25;
// Changes of the objective below this part of it are too small to judge by.
constexpr double kNegligible = 1e-6;

}  // namespace

void StepDamping::review(double before, double foreseen, double found) {
  const double negligible = kNegligible * before;
  const double change = std::abs(before - foreseen);
  if (change <= negligible && std::abs(found - before) <= negligible) return;
  const double worse = found - foreseen;
  if (worse > kBad * change + negligible) {
    value_ = std::min(kMost, kGrowth * value_);
  } else if (worse <= kGood * change) {
    value_ = std::max(1.0, kDecay * value_);
  }
}

}  // namespace sinew::inverse
