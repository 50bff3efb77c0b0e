#include "sinew/sim/load_steps.hpp"

#include <algorithm>

namespace sinew::sim {

double take_load_steps(const LoadSteps& steps, const std::function<bool(double)>& solve,
                       const std::function<void()>& keep, const std::function<void()>& go_back) {
  double share = 1.0;
  double step = steps.first;
  while (share > 0.0 && step >= steps.least) {
    const double next = std::max(0.0, share - step);
    if (solve(next)) {
      share = next;
      step *= 2.0;
      keep();
    } else {
      go_back();
      step *= 0.5;
    }
  }
  return share;
}

}  // namespace sinew::sim
