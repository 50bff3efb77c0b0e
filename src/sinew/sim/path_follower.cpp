#include "sinew/sim/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/sim/held_motions.hpp"
#include "sinew/sim/run.hpp"

namespace sinew::sim {

namespace {

constexpr int kMostIterations = 25;
constexpr double kWantedIterations = 6.0;  // of a step of the right length
constexpr int kMostPathHalvings = 14;
constexpr double kFarthest = 5.0;  // of a step's length, that its corrections may go

}  // namespace

void PathFollower::check() const {
  if (!run_.model->contacts().empty()) {
    throw Error(ErrorKind::not_in_this_version, {.item = "follow_path"},
                "paths of robots with contacts are not followed yet",
                "step through the load in time");
  }
  if (!run_.model->guides().empty()) {
    throw Error(ErrorKind::bad_argument, {.item = "follow_path"},
                "cables with friction have no path of their own", "step through the load in time");
  }
}

void PathFollower::plan() {
  check();
  run_.read_commands(run_.time(), std::numeric_limits<double>::infinity());
  const std::vector<ActuatorState>& actuators = run_.actuation.states();
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const step::ActuatorBlock& range = run_.world.problem().actuators[i];
    const bool fixed = range.owned || range.drive != nullptr;
    const double told = range.owned ? actuators[i].effort : range.value;
    if (!range.owned && (fixed || range.kind != CommandKind::effort)) {
      throw Error(
          ErrorKind::bad_argument,
          {.item = fmt::format("actuator '{}'", run_.model->actuators()[i].name)},
          "a path grows loads and commanded efforts; this actuator has a drive or is told a "
          "motion",
          "command its effort; what is held at a motion needs no path: solve_static() "
          "passes limit points by itself");
    }
    efforts_.push_back({actuators[i].effort, told});
  }
  const Surroundings& loads = run_.surroundings;
  for (std::size_t k = 0; k < loads.applied().size(); ++k) {
    loads_.push_back({loads.applied()[k], loads.factors()[k].value(run_.time())});
  }
}

// Where loads and efforts stand at a share of the way.
void PathFollower::set_share(double share) {
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    const auto [from, to] = loads_[k];
    run_.surroundings.apply(k, from + share * (to - from));
  }
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    const auto [from, to] = efforts_[i];
    const int row = run_.model->actuators()[i].row;
    run_.effort[static_cast<std::size_t>(row)] = from + share * (to - from);
  }
}

// r at a share of the way; the bodies stay linearised there.
void PathFollower::imbalance_at(double share, VectorX& imbalance) {
  set_share(share);
  run_.world.linearise({{}, mechanics::Tangent::exact, true, true});
  run_.world.form_rows(run_.effort, run_.model->curved_constraints());
  run_.world.bodies().imbalance(run_.effort, imbalance);
}

// m: the largest of any joint.
double PathFollower::gap() const {
  double largest = 0.0;
  for (const step::BilateralBlock& block : run_.world.problem().bilaterals) {
    largest = std::max(largest, std::abs(run_.world.problem().delta[block.row]));
  }
  return largest;
}

// The answers of the robot as its joints hold it together; false where there is none.
bool PathFollower::solve(const VectorX& here, const VectorX& ahead) {
  if (run_.world.condense() == linalg::FactorStatus::singular) return false;
  const step::StepProblem& problem = run_.world.problem();
  held_.clear();
  step::append_joints(problem, held_);
  HeldMotions motions(run_.world, held_);
  VectorX gap(static_cast<Eigen::Index>(held_.size()));
  for (Eigen::Index k = 0; k < gap.size(); ++k) {
    const step::HeldRow& row = held_[static_cast<std::size_t>(k)];
    gap[k] = row.compliance == 0.0 ? problem.delta[row.row] : 0.0;
  }
  motions.solve(here, gap, by_rest_.motion, by_rest_.efforts);
  motions.solve(ahead - here, VectorX::Zero(gap.size()), by_load_.motion, by_load_.efforts);
  negative_pivots_ = motions.negative_pivots();
  return true;
}

// Along the tangent first, then in the plane normal to it; false where there is no such motion.
bool PathFollower::advance(bool first, double length) {
  double by = 0.0;
  if (first) {
    const double largest = by_load_.motion.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) return false;
    const bool back = direction_.size() > 0 && direction_.dot(by_load_.motion) < 0.0;
    by = (back ? -length : length) / largest;
    moved_.setZero(by_load_.motion.size());
  } else {
    const double along = moved_.dot(by_load_.motion);
    if (along == 0.0) return false;
    by = -moved_.dot(by_rest_.motion) / along;
  }
  share_ += by;
  const VectorX motion = by_rest_.motion + by * by_load_.motion;
  moved_ += motion;
  run_.world.bodies().propose_motion(motion);
  // Efforts of stiffness are part of no equilibrium.
  for (std::size_t k = 0; k < run_.world.problem().bilaterals.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const int row = run_.world.numbering().row_of(held_[k].row);
    run_.effort[static_cast<std::size_t>(row)] += by_rest_.efforts[i] + by * by_load_.efforts[i];
  }
  return true;
}

// Takes the motion; whether it may be taken.
bool PathFollower::is_sound(double length) {
  Bodies& bodies = run_.world.bodies();
  const auto motion = bodies.apply_motion(1.0);
  const auto volume = motion.finite ? bodies.smallest_volume() : mechanics::SmallestVolume{};
  if (!motion.finite || !(volume.ratio > 0.0) ||
      !(moved_.cwiseAbs().maxCoeff() < kFarthest * length)) {
    return false;
  }
  run_.volume_ratio = volume.ratio;
  return true;
}

// The iterations that a step took; 0: it failed.
int PathFollower::step(double length) {
  VectorX here, ahead;
  for (int iteration = 0; iteration <= kMostIterations; ++iteration) {
    imbalance_at(share_ + 1.0, ahead);
    imbalance_at(share_, here);
    run_.report.relative_residual = here.norm() / (run_.world.bodies().force_scale() + 1e-300);
    const bool arrived = run_.report.relative_residual <= settings_.tolerance &&
                         gap() <= settings_.tolerance * run_.model->size();
    if (iteration > 0 && arrived) return iteration;
    if (!solve(here, ahead) || !advance(iteration == 0, length) || !is_sound(length)) return 0;
  }
  return 0;
}

// The same, taken back where it failed.
int PathFollower::step_or_give_up(double length) {
  run_.keep(run_.before);
  const double share_before = share_;
  const int iterations = step(length);
  if (iterations > 0) {
    direction_ = moved_;
  } else {
    run_.restore(run_.before);
    share_ = share_before;
  }
  return iterations;
}

void PathFollower::rest() {
  run_.world.bodies().end_step({});
  run_.world.begin_step(run_.time(), run_.time(), run_.effort);
  run_.finish_step();
}

std::vector<PathPoint> PathFollower::follow(const std::function<void()>& visit) {
  State start;
  run_.keep(start);
  run_.now = run_.time();
  run_.surroundings.move_bases(run_.now);
  plan();
  run_.world.begin_step(run_.time(), run_.time(), run_.effort);
  std::vector<PathPoint> path;
  double length = settings_.first_step * run_.model->size();
  const double longest = settings_.largest_step * run_.model->size();
  while (share_ < 1.0 && static_cast<int>(path.size()) < settings_.max_points) {
    int iterations = step_or_give_up(length);
    for (int halving = 0; iterations == 0; ++halving) {
      if (halving == kMostPathHalvings) {
        run_.restore(start);
        throw Error(
            ErrorKind::not_converged, {.item = "path"},
            fmt::format("after {} points, at {:.4g} of the load, even a step of {:.2g} m "
                        "finds no equilibrium",
                        path.size(), share_, length),
            "begin with a smaller first_step, or disturb the symmetry before a bifurcation");
      }
      length *= 0.5;
      iterations = step_or_give_up(length);
    }
    path.push_back({share_, negative_pivots_});
    rest();
    if (visit) visit();
    length = std::min(longest, length * std::clamp(kWantedIterations / iterations, 0.5, 2.0));
  }
  run_.last_step = 0.0;
  run_.ledger.restart();
  return path;
}

}  // namespace sinew::sim
