#include "sinew/sim/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/sim/path_predictor.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/static_search.hpp"
#include "sinew/sim/step_failure.hpp"

namespace sinew::sim {

namespace {

constexpr int kMostIterations = 25;
constexpr double kWantedIterations = 6.0;  // of a step of the right length
constexpr int kMostPathHalvings = 14;
constexpr double kFarthest = 5.0;   // of a step's length, that its corrections may go
constexpr double kDiagonal = 1.75;  // more than the largest coordinate's part of a motion in space

}  // namespace

void PathFollower::check() const {
  for (const auto& contact : run_.world.contacts().planes().contacts()) {
    if (contact->friction() == 0.0 && !contact->curved()) continue;
    throw Error(ErrorKind::not_in_this_version,
                {.item = fmt::format("contact '{}'", contact->name())},
                "paths beside contacts with friction or curved surfaces are not followed yet",
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

// A path beside contacts begins at an equilibrium: it needs to know what touches there.
void PathFollower::settle() {
  if (run_.world.contacts().empty()) return;
  std::vector<step::ActuatorBlock>& blocks = run_.world.problem().actuators;
  const std::vector<step::ActuatorBlock> goal = blocks;
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i].hold_effort(efforts_[i].from);
  const StaticSettings settings{.tolerance = settings_.tolerance};
  StaticSearch search(run_, settings);
  run_.solver.begin_step();
  set_share(0.0);
  const bool found = search.equilibrate(0.0);
  blocks = goal;
  run_.world.bodies().end_step({});
  if (found) return;
  fail(run_, ErrorKind::not_converged,
       "from where the robot is, Newton's method finds no equilibrium under the loads that acted "
       "last",
       "let solve_static() find one before the load grows");
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

// m: the largest of any joint and of the points that touch.
double PathFollower::gap() const {
  const step::StepProblem& problem = run_.world.problem();
  double largest = 0.0;
  for (const step::BilateralBlock& block : problem.bilaterals) {
    largest = std::max(largest, std::abs(problem.delta[block.row]));
  }
  for (const int row : touching_) largest = std::max(largest, std::abs(problem.delta[row]));
  return largest;
}

// The robot, condensed, as its joints and the points that touch hold it.
HeldMotions PathFollower::hold() {
  std::vector<step::HeldRow> held;
  step::append_joints(run_.world.problem(), held);
  for (const int row : touching_) held.push_back({row, 0.0});
  HeldMotions motions(run_.world, std::move(held));
  negative_pivots_ = motions.negative_pivots();
  return motions;
}

bool PathFollower::predict(const VectorX& here, const VectorX& ahead, double length) {
  if (run_.world.condense() == linalg::FactorStatus::singular) return false;
  HeldMotions joints = hold();
  HeldAnswer by_rest, by_load;
  joints.solve(here, joints.gaps(), by_rest);
  joints.solve(ahead - here, VectorX::Zero(joints.gaps().size()), by_load);
  PathPrediction prediction;
  PathPredictor predictor(run_.world, joints);
  if (!predictor.predict(by_rest, by_load, direction_, length, run_.effort, prediction)) {
    return false;
  }
  moved_.setZero(by_load.motion.size());
  origin_ = prediction.origin;
  move(joints.rows(), prediction.answer, prediction.share);
  touching_ = std::move(prediction.touching);
  return true;
}

bool PathFollower::correct(const VectorX& here, const VectorX& ahead) {
  if (run_.world.condense() == linalg::FactorStatus::singular) return false;
  HeldMotions motions = hold();
  HeldAnswer answer, by_load;
  motions.solve(here, motions.gaps(), answer);
  motions.solve(ahead - here, VectorX::Zero(answer.efforts.size()), by_load);
  const VectorX normal = moved_ - origin_;
  const double along = normal.dot(by_load.motion);
  if (along == 0.0) return false;
  const double by = -normal.dot(answer.motion) / along;
  answer.motion += by * by_load.motion;
  answer.efforts += by * by_load.efforts;
  move(motions.rows(), answer, by);
  return true;
}

// Proposes a motion. Efforts of stiffness are part of no equilibrium.
void PathFollower::move(std::span<const step::HeldRow> held, const HeldAnswer& answer,
                        double share) {
  share_ += share;
  moved_ += answer.motion;
  run_.world.bodies().propose_motion(answer.motion);
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (held[k].compliance != 0.0) continue;
    const int row = run_.world.numbering().row_of(held[k].row);
    run_.effort[static_cast<std::size_t>(row)] += answer.efforts[static_cast<Eigen::Index>(k)];
  }
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

// Whether points that touch are pressed, and all others outside. What is pulled by rounding is not.
bool PathFollower::obeys_contacts() {
  const step::StepProblem& problem = run_.world.problem();
  const double nothing = settings_.tolerance * run_.model->size();
  const double slack = settings_.tolerance * run_.world.bodies().force_scale();
  bool obeyed = run_.world.contacts().deepest_left_out() <= nothing;
  for (const step::ContactBlock& block : problem.contacts) {
    double& force = run_.effort[static_cast<std::size_t>(run_.world.numbering().row_of(block.row))];
    obeyed = obeyed && force >= -slack && problem.delta[block.row] >= -nothing;
    force = std::max(force, 0.0);
  }
  return obeyed;
}

// Contacts change what is unstable from one iteration to the next: here, not before the last.
void PathFollower::count() {
  if (run_.world.contacts().empty()) return;
  if (run_.world.condense() != linalg::FactorStatus::singular) hold();
}

// The iterations that a step took; 0: it failed.
int PathFollower::step(double length) {
  run_.world.begin_step(run_.time(), run_.time(), run_.effort, kFarthest * kDiagonal * length);
  touching_.clear();
  VectorX here, ahead;
  for (int iteration = 0; iteration <= kMostIterations; ++iteration) {
    imbalance_at(share_ + 1.0, ahead);
    imbalance_at(share_, here);
    run_.report.relative_residual = here.norm() / (run_.world.bodies().force_scale() + 1e-300);
    const bool arrived = run_.report.relative_residual <= settings_.tolerance &&
                         gap() <= settings_.tolerance * run_.model->size();
    if (iteration > 0 && arrived) {
      if (!obeys_contacts()) return 0;
      count();
      return iteration;
    }
    const bool found = iteration == 0 ? predict(here, ahead, length) : correct(here, ahead);
    if (!found || !is_sound(length)) return 0;
  }
  return 0;
}

// The same, taken back where it failed.
int PathFollower::step_or_give_up(double length) {
  run_.keep(run_.before);
  const double share_before = share_;
  const int iterations = step(length);
  if (iterations > 0) {
    direction_ = moved_ - origin_;
  } else {
    run_.restore(run_.before);
    share_ = share_before;
  }
  return iterations;
}

void PathFollower::rest() {
  run_.world.bodies().end_step({});
  run_.finish_step();
}

std::vector<PathPoint> PathFollower::follow(const std::function<void()>& visit) {
  State start;
  run_.keep(start);
  run_.now = run_.time();
  run_.surroundings.move_bases(run_.now);
  plan();
  run_.keep(run_.before);
  settle();
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
