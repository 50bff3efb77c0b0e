// Simulation::follow_path: equilibria along a load that grows, through limit points and back, by
// the length of the path rather than by the load.
//
// The equation is r(q, s) = b(q, s) + H^T lambda(s) = 0. A step predicts along the tangent of the
// path, (A^-1 dr/ds, 1), and corrects in the plane normal to it (Riks, Int. J. Solids Struct. 15
// (1979) 529; Ramm 1981; Crisfield 1991, sec. 9.3): with m_r = A^-1 r and m_p = A^-1 dr/ds,
//   dq = m_r + ds m_p,   ds = -(D . m_r)/(D . m_p),
// D the motion since the step began. A, the exact tangent, may be indefinite on the way.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

namespace {

constexpr int kMostIterations = 25;
constexpr double kWantedIterations = 6.0;  // of a step of the right length
constexpr int kMostPathHalvings = 14;
constexpr double kFarthest = 5.0;  // of a step's length, that its corrections may go

}  // namespace

// Where the loads and efforts that `path_` names stand at a share of the way.
void Simulation::set_share(double share) {
  for (std::size_t k = 0; k < load_factors_.size(); ++k) {
    const auto [from, to] = path_loads_[k];
    apply_load(k, from + share * (to - from));
  }
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    const auto [from, to] = path_efforts_[i];
    effort_[static_cast<std::size_t>(model_->actuators()[i].row)] = from + share * (to - from);
  }
}

void Simulation::plan_path() {
  if (!model_->contacts().empty()) {
    throw Error(ErrorKind::not_in_this_version, {.item = "follow_path"},
                "paths of robots with contacts are not followed yet",
                "step through the load in time");
  }
  if (!model_->welds().empty()) {
    throw Error(ErrorKind::not_in_this_version, {.item = "follow_path"},
                "paths of robots with joints are not followed yet",
                "step through the load in time");
  }
  if (!model_->guides().empty()) {
    throw Error(ErrorKind::bad_argument, {.item = "follow_path"},
                "cables with friction have no path of their own", "step through the load in time");
  }
  read_commands(time(), std::numeric_limits<double>::infinity());
  path_efforts_.clear();
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    const step::ActuatorBlock& range = world_.problem().actuators[i];
    const bool fixed = range.owned || range.drive != nullptr;
    const double told = range.owned ? actuators_[i].effort : range.value;
    if (!range.owned && (fixed || range.kind != CommandKind::effort)) {
      throw Error(
          ErrorKind::bad_argument,
          {.item = fmt::format("actuator '{}'", model_->actuators()[i].name)},
          "a path grows loads and commanded efforts; this actuator has a drive or is told a "
          "motion",
          "command its effort; what is held at a motion needs no path: solve_static() "
          "passes limit points by itself");
    }
    path_efforts_.push_back({actuators_[i].effort, told});
  }
  path_loads_.clear();
  for (std::size_t k = 0; k < load_factors_.size(); ++k) {
    path_loads_.push_back({load_applied_[k], load_factors_[k].value(time())});
  }
}

// r at a share of the way; the bodies stay linearised there.
void Simulation::imbalance_at(double share, VectorX& imbalance) {
  set_share(share);
  world_.linearise({{}, mechanics::Tangent::exact, true, true});
  world_.form_rows(effort_, model_->curved_constraints());
  world_.imbalance(effort_, imbalance);
}

// One step of the path; the iterations that it took, 0 if it failed and was taken back.
int Simulation::step_path(double length, double& share, VectorX& direction, double tolerance) {
  keep(state_before_);
  const double share_before = share;
  const auto give_up = [&] {
    restore(state_before_);
    share = share_before;
    return 0;
  };
  VectorX here, ahead, by_rest, by_load, moved;
  for (int iteration = 0; iteration <= kMostIterations; ++iteration) {
    imbalance_at(share + 1.0, ahead);
    imbalance_at(share, here);
    report_.relative_residual = here.norm() / (world_.force_scale() + 1e-300);
    if (iteration > 0 && report_.relative_residual <= tolerance) {
      direction = moved;
      return iteration;
    }
    if (world_.condense() == linalg::FactorStatus::singular) return give_up();
    ahead -= here;
    world_.solve(here, by_rest);
    world_.solve(ahead, by_load);
    if (iteration == 0) {
      const double largest = by_load.cwiseAbs().maxCoeff();
      if (!(largest > 0.0)) return give_up();
      const bool back = direction.size() > 0 && direction.dot(by_load) < 0.0;
      const double by = (back ? -length : length) / largest;
      share += by;
      moved = by * by_load + by_rest;
      world_.propose_motion(moved);
    } else {
      const double along = moved.dot(by_load);
      if (along == 0.0) return give_up();
      const double by = -moved.dot(by_rest) / along;
      share += by;
      const VectorX correction = by_rest + by * by_load;
      moved += correction;
      world_.propose_motion(correction);
    }
    const auto motion = world_.apply_motion(1.0);
    const auto volume = motion.finite ? world_.smallest_volume() : mechanics::SmallestVolume{};
    if (!motion.finite || !(volume.ratio > 0.0) ||
        !(moved.cwiseAbs().maxCoeff() < kFarthest * length)) {
      return give_up();
    }
    volume_ratio_ = volume.ratio;
  }
  return give_up();
}

std::vector<PathPoint> Simulation::follow_path(const PathSettings& settings,
                                               const std::function<void()>& visit) {
  const State start = state();
  now_ = time();
  move_bases(now_);
  plan_path();
  world_.begin_step(time(), time(), effort_);
  std::vector<PathPoint> path;
  VectorX direction;
  double share = 0.0;
  double length = settings.first_step * model_->size();
  const double longest = settings.largest_step * model_->size();
  const auto rest = [&] {
    world_.end_step({});
    world_.begin_step(time(), time(), effort_);
    finish_step();
  };
  while (share < 1.0 && static_cast<int>(path.size()) < settings.max_points) {
    int iterations = step_path(length, share, direction, settings.tolerance);
    for (int halving = 0; iterations == 0; ++halving) {
      if (halving == kMostPathHalvings) {
        restore(start);
        throw Error(
            ErrorKind::not_converged, {.item = "path"},
            fmt::format("after {} points, at {:.4g} of the load, even a step of {:.2g} m "
                        "finds no equilibrium",
                        path.size(), share, length),
            "begin with a smaller first_step, or disturb the symmetry before a bifurcation");
      }
      length *= 0.5;
      iterations = step_path(length, share, direction, settings.tolerance);
    }
    path.push_back({share, world_.negative_pivots()});
    rest();
    if (visit) visit();
    length = std::min(longest, length * std::clamp(kWantedIterations / iterations, 0.5, 2.0));
  }
  step_before_ = 0.0;
  ledger_.restart();
  return path;
}

}  // namespace sinew::sim
