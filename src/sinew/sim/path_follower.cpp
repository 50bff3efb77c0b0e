#include "sinew/sim/path_follower.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/shape_contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/sim/path_loads.hpp"
#include "sinew/sim/path_step.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/static_search.hpp"
#include "sinew/sim/step_failure.hpp"

namespace sinew::sim {

namespace {

constexpr double kWantedIterations = 6.0;  // of a step of suitable length
constexpr int kMaxPathHalvings = 14;

}  // namespace

void PathFollower::check() const {
  const ContactPlanes& planes = run_.world.contacts().planes();
  for (std::size_t i = 0; i < planes.contacts().size(); ++i) {
    const constraint::ShapeContact* contact = planes.shape(i);
    if (contact == nullptr || !contact->curved() || contact->friction().sticking == 0.0) continue;
    throw Error(ErrorKind::not_in_this_version,
                {.item = fmt::format("contact '{}'", contact->name())},
                "paths along curved surfaces with friction are not followed yet",
                "step through the load in time");
  }
  for (const ContactModel& contact : run_.model->contacts()) {
    if (contact.aggregate == 0.0) continue;
    throw Error(ErrorKind::not_in_this_version, {.item = fmt::format("contact '{}'", contact.name)},
                "paths with aggregated contact are not followed yet",
                "leave `aggregate` out, or step through the load in time");
  }
  for (std::size_t i = 0; i < run_.model->contacts().size(); ++i) {
    const constraint::Contact& contact = run_.model->contact(static_cast<int>(i));
    if (contact.other_body() < 0 && !contact.is_found_anew()) continue;
    throw Error(ErrorKind::not_in_this_version, {.item = "follow_path"},
                "paths on which bodies touch each other are not followed yet",
                "step through the load in time");
  }
  if (run_.world.joints().block_count() > 0) {
    throw Error(ErrorKind::bad_argument, {.item = "follow_path"},
                "paths do not pass limits and friction of joints", "step through the load in time");
  }
  if (!run_.model->guides().empty()) {
    throw Error(ErrorKind::bad_argument, {.item = "follow_path"},
                "cables with friction have no path of their own", "step through the load in time");
  }
}

// With contacts, a path must begin at an equilibrium, which determines the touching points.
void PathFollower::settle(PathLoads& loads) {
  if (run_.world.contacts().empty()) return;
  loads.set_fraction(0.0);
  std::vector<step::ActuatorBlock>& blocks = run_.world.problem().actuators;
  const std::vector<step::ActuatorBlock> goal = blocks;
  for (step::ActuatorBlock& block : blocks) {
    block.hold_effort(run_.effort[static_cast<std::size_t>(block.row)]);
  }
  const StaticSettings settings{.tolerance = settings_.tolerance};
  StaticSearch search(run_, settings);
  run_.solver.begin_step();
  const bool found = search.equilibrate(0.0);
  blocks = goal;
  run_.world.bodies().end_step({});
  if (found) return;
  if (search.last().status == NewtonStatus::singular) {
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

std::vector<PathPoint> PathFollower::follow(const std::function<void()>& visit) {
  State start;
  run_.keep(start);
  run_.watch.begin();
  run_.now = run_.time();
  run_.surroundings.move_bases(run_.now);
  check();
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
  PathStep step(run_, settings_, loads);
  std::vector<PathPoint> path;
  double length = settings_.first_step * run_.model->size();
  const double longest = settings_.largest_step * run_.model->size();
  while (step.point().load_fraction < 1.0 && static_cast<int>(path.size()) < settings_.max_points) {
    int iterations = from_before([&] { return step.take(length); });
    for (int halving = 0; iterations == 0; ++halving) {
      if (halving == kMaxPathHalvings) {
        run_.restore(start);
        throw Error(
            ErrorKind::not_converged, {.item = "path"},
            fmt::format("after {} points, at {:.4g} of the load, even a step of {:.2g} m "
                        "finds no equilibrium",
                        path.size(), step.point().load_fraction, length),
            "begin with a smaller first_step, or disturb the symmetry before a bifurcation");
      }
      length *= 0.5;
      iterations = from_before([&] { return step.take(length); });
    }
    path.push_back(step.point());
    rest();
    if (visit) visit();
    length = std::min(longest, length * std::clamp(kWantedIterations / iterations, 0.5, 2.0));
  }
  run_.forget_history();
  run_.ledger.restart();
  return path;
}

}  // namespace sinew::sim
