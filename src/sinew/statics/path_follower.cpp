#include "sinew/statics/path_follower.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/path_loads.hpp"
#include "sinew/statics/path_obstacle.hpp"
#include "sinew/statics/path_step.hpp"
#include "sinew/statics/static_search.hpp"
#include "sinew/statics/step_failure.hpp"

namespace sinew::statics {

namespace {

constexpr double kWantedIterations = 6.0;  // of a step of suitable length
constexpr double kShortest = 1e-8;         // first trial of a step, relative to the robot's size
constexpr int kMaxPathHalvings = 14;
constexpr int kMaxBisections = 40;  // of a step that passes a bifurcation

}  // namespace

// A path begins at an equilibrium, which with contacts determines the touching points. Without, the
// first step also finds one from a start that Newton's method leaves.
void PathFollower::settle(PathLoads& loads) {
  const bool touches = !run_.world.contacts().empty();
  loads.set_fraction(0.0);
  std::vector<law::ActuatorBlock>& blocks = run_.world.problem().actuators;
  const std::vector<law::ActuatorBlock> goal = blocks;
  for (law::ActuatorBlock& block : blocks) {
    block.hold_effort(run_.effort[static_cast<std::size_t>(block.row)]);
  }
  const StaticSettings settings{.tolerance = settings_.tolerance};
  StaticSearch search(run_, settings);
  run_.solver.begin_step();
  const bool found = search.equilibrate(0.0);
  blocks = goal;
  if (!found && !touches) return run_.restore(run_.before);
  run_.world.bodies().end_step({});
  if (found) return;
  if (search.last().status == run::NewtonStatus::singular) {
    fail(run_, ErrorKind::not_in_this_version,
         "contacts alone hold a body: its own tangent is singular, and paths need one that is not",
         "fix a region of it, or weld it to a body that is held");
  }
  fail(run_, ErrorKind::not_converged,
       "from where the robot is, Newton's method finds no equilibrium under the loads that acted "
       "last",
       "let solve_static() find one before the load grows");
}

void PathFollower::rest() {
  run_.world.bodies().end_step({});
  run_.finish_step();
}

// Makes a step of at most this length, halved until it succeeds.
// @param length m; overwritten by the last length that was tried.
// @return the number of iterations; 0 if it failed.
int PathFollower::take(PathStep& step, double& length) {
  for (int halving = 0; halving <= kMaxPathHalvings; ++halving) {
    const int iterations = step.take(length);
    if (iterations > 0) return iterations;
    length = 0.5 * std::min(length, step.length());
  }
  return 0;
}

// The next point. A step that passes a bifurcation is undone and halved until the load at it is
// known; the point behind it is then on the same branch as the one before.
// @param length m, of this step; overwritten by that of the next one.
// @return whether there is one.
bool PathFollower::advance(PathStep& step, double& length) {
  const double longest = settings_.largest_step * run_.model->size();
  for (int halving = 0;; ++halving) {
    const int iterations = take(step, length);
    if (iterations == 0) return false;
    const bool passes = step.change().bifurcates();
    if (!passes || step.change().is_narrow() || halving == kMaxBisections) {
      bisects_ = bisects_ && !passes;
      const double next = step.length() * std::clamp(kWantedIterations / iterations, 0.5, 2.0);
      length = std::min(bisects_ ? step.length() : longest, next);
      length = std::max(length, kShortest * run_.model->size());
      return true;
    }
    step.undo();
    bisects_ = true;
    length = 0.5 * step.length();
  }
}

void PathFollower::add_point(const PathStep& step, Path& path) {
  const PathPoint point = step.point();
  if (point.event == PathEvent::limit_point && !path.limit_load && step.change().from.slope > 0.0) {
    path.limit_load = step.change().peak();
  }
  path.points.push_back(point);
}

Path PathFollower::follow(const std::function<void()>& visit) {
  run::State start;
  run_.keep(start);
  run_.watch.begin();
  run_.now = run_.time();
  run_.surroundings.move_bases(run_.now);
  if (const auto obstacle = find_path_obstacle(run_)) throw Error(*obstacle);
  PathLoads loads(run_);
  run_.keep(run_.before);
  // An exception of the watcher leaves the state of the last point.
  const auto from_before = [&](auto&& part) {
    try {
      return part();
    } catch (...) {
      run_.go_back();
      throw;
    }
  };
  from_before([&] { settle(loads); });
  PathStep step(run_, settings_.tolerance, [&](double part) { loads.set_fraction(part); });
  Path path{.points = {}, .end = PathEnd::full_load, .limit_load = {}, .reason = {}};
  double length = settings_.first_step * run_.model->size();
  bisects_ = false;
  while (step.point().load_fraction < 1.0) {
    if (static_cast<int>(path.points.size()) >= settings_.max_points) {
      path.end = PathEnd::max_points;
      path.reason = fmt::format("{} points end at {:.4g} of the load; allow more max_points",
                                path.points.size(), step.point().load_fraction);
      break;
    }
    if (!from_before([&] { return advance(step, length); })) {
      path.end = PathEnd::no_equilibrium;
      end_early(path, step, length, start);
      break;
    }
    add_point(step, path);
    rest();
    if (visit) visit();
  }
  run_.forget_history();
  run_.ledger.rest();
  return path;
}

// Without any point, nothing has been found: throws, with the state of the start.
void PathFollower::end_early(Path& path, const PathStep& step, double length,
                             const run::State& start) {
  const std::string where = fmt::format(
      "after {} points, at {:.4g} of the load, even a step of {:.2g} m finds no "
      "equilibrium",
      path.points.size(), step.point().load_fraction, length);
  const std::string remedy =
      "begin with a smaller first_step, or disturb the symmetry before a bifurcation";
  path.reason = where + "; " + remedy;
  if (!path.points.empty()) return;
  run_.restore(start);
  throw Error(ErrorKind::not_converged, {.item = "path"}, where, remedy);
}

}  // namespace sinew::statics
