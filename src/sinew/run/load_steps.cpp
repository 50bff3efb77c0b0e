#include "sinew/run/load_steps.hpp"

#include <algorithm>

namespace sinew::run {

double take_load_steps(const LoadSteps& steps, const std::function<bool(double)>& solve,
                       const std::function<void()>& keep, const std::function<void()>& go_back) {
  double fraction = 1.0;
  double step = steps.first;
  int wanted = 1, successes = 0;  // required before doubling; since the last change of the step
  bool doubled = false;
  const auto is_long_enough = [&] {
    return step >= (fraction == 1.0 ? std::max(steps.min, steps.min_at_first) : steps.min);
  };
  while (fraction > 0.0 && is_long_enough()) {
    const double next = std::max(0.0, fraction - step);
    if (solve(next)) {
      fraction = next;
      keep();
      doubled = ++successes >= wanted;
      if (!doubled) continue;
      step *= 2.0;
    } else {
      go_back();
      step *= 0.5;
      if (doubled) wanted *= 2;
      doubled = false;
    }
    successes = 0;
  }
  return fraction;
}

}  // namespace sinew::run
