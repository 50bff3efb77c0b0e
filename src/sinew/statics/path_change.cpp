#include "sinew/statics/path_change.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sinew::statics {

namespace {

// Relative difference of two loads between which a bifurcation is, half of the 1 % that is
// promised.
constexpr double kNarrow = 5e-3;
// The same in fractions of the full load, near a bifurcation without load.
constexpr double kNarrowest = 1e-5;
constexpr int kBisections = 60;

}  // namespace

bool PathChange::bifurcates() const {
  if (from.rubs || to.rubs) return false;
  return std::abs(to.negative_pivots - from.negative_pivots) != (turns() ? 1 : 0);
}

PathEvent PathChange::event() const {
  if (bifurcates()) return PathEvent::bifurcation;
  return turns() ? PathEvent::limit_point : PathEvent::none;
}

bool PathChange::is_narrow() const {
  const double least = std::min(std::abs(from.load_fraction), std::abs(to.load_fraction));
  return std::abs(to.load_fraction - from.load_fraction) <= std::max(kNarrow * least, kNarrowest);
}

double PathChange::peak() const {
  const double larger = std::max(from.load_fraction, to.load_fraction);
  if (from.touches || to.touches || !(from.slope > 0.0) || !turns()) return larger;
  // load(t) = from + a t + b t^2 + c t^3, t from 0 to 1; its derivative changes sign once.
  const double a = from.slope * length, end = to.slope * length;
  const double rise = to.load_fraction - from.load_fraction;
  const double b = 3.0 * rise - 2.0 * a - end, c = a + end - 2.0 * rise;
  double low = 0.0, high = 1.0;
  for (int k = 0; k < kBisections; ++k) {
    const double t = 0.5 * (low + high);
    (a + t * (2.0 * b + 3.0 * c * t) > 0.0 ? low : high) = t;
  }
  return std::max(larger, from.load_fraction + low * (a + low * (b + c * low)));
}

}  // namespace sinew::statics
