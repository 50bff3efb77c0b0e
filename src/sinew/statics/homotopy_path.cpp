#include "sinew/statics/homotopy_path.hpp"

#include <algorithm>

#include "sinew/run/run.hpp"
#include "sinew/statics/path_obstacle.hpp"
#include "sinew/statics/path_step.hpp"

namespace sinew::statics {

namespace {

// Lengths of the first step and of the longest one, relative to the robot's size.
constexpr double kFirst = 0.01;
constexpr double kLongest = 0.05;
constexpr double kSuitableIterations = 6.0;
constexpr int kMaxHalvings = 8;
// More iterations than these are not worth it: the methods that follow need no path.
constexpr int kMaxIterations = 150;
// The last point before a limit point is at most this fraction of its load below it.
constexpr double kNear = 2e-3;

}  // namespace

bool HomotopyPath::is_possible() const {
  const auto is_effort = [](const law::ActuatorBlock& block) {
    return block.drive == nullptr && !block.owned && block.kind == model::CommandKind::effort;
  };
  return std::ranges::all_of(goal_, is_effort) && !find_path_obstacle(run_);
}

// At a fraction of the path: 0 at the start, 1 at the goal.
void HomotopyPath::set_fraction(double fraction) {
  run_.world.homotopy().set_fraction(1.0 - fraction);
  for (std::size_t i = 0; i < goal_.size(); ++i) {
    const double from = start_[i].effort, to = goal_[i].value;
    run_.effort[static_cast<std::size_t>(goal_[i].row)] = from + fraction * (to - from);
  }
}

// Takes the steps of follow(). @return whether the load turned back.
bool HomotopyPath::advance(PathStep& step) {
  const double size = run_.model->size();
  const int first = run_.watch.iterations();
  double length = kFirst * size;
  bool turned = false;
  for (int halvings = 0; halvings <= kMaxHalvings && step.point().load_fraction < 1.0;) {
    if (run_.watch.iterations() - first > kMaxIterations) break;
    const int iterations = step.take(length);
    if (iterations == 0) {
      length = 0.5 * std::min(length, step.length());
      ++halvings;
      continue;
    }
    halvings = 0;
    if (const PathChange change = step.change(); change.turns()) {
      turned = true;
      step.undo();
      if (change.peak() - change.from.load_fraction <= kNear * change.peak()) break;
      length = 0.5 * step.length();
      continue;
    }
    run_.world.bodies().end_step({});
    const double next = step.length() * std::clamp(kSuitableIterations / iterations, 0.5, 2.0);
    length = std::min(kLongest * size, next);
  }
  return turned;
}

HomotopyPath::End HomotopyPath::follow(double& fraction) {
  const run::State before = run_.before;  // which PathStep overwrites
  PathStep step(run_, tolerance_, [this](double part) { set_fraction(part); });
  step.begin_at(1.0 - fraction);
  bool turned = false;
  try {
    turned = advance(step);
  } catch (...) {
    run_.before = before;
    throw;
  }
  run_.before = before;
  fraction = std::max(0.0, 1.0 - step.point().load_fraction);
  if (fraction == 0.0) return End::full_load;
  return turned ? End::turned : End::lost;
}

}  // namespace sinew::statics
