#include "sinew/sim/overdamped_motion.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/sim/run.hpp"
#include "sinew/sim/stability.hpp"
#include "sinew/sim/static_search.hpp"

namespace sinew::sim {

namespace {

// Steps follow the motion approximately; near its end, Newton's method takes over.
constexpr double kRelaxationTolerance = 1e-4;
constexpr int kMaxIterationsOfStep = 12;
constexpr int kFewIterations = 4;
constexpr int kManyIterations = 8;
constexpr double kLighter = 0.25;  // factor of sigma after an easy step
constexpr double kHeavier = 2.0;   // after a hard one
constexpr double kHeaviest = 8.0;  // after a failed one
constexpr int kMaxFailures = 8;    // in a row
// A decreasing motion below this fraction of the robot's size per step is settling.
constexpr double kSettling = 0.02;
constexpr double kLater = 0.25;
// Distance to the equilibrium that was left, relative to the disturbance, at which the state has
// returned.
constexpr double kBack = 0.1;
constexpr double kSmall = 1e-6;  // of the robot's size: test motion for measurements
// Initial inertia relative to that at which the softest direction would be neutral.
constexpr double kFirstInertia = 2.0;

mechanics::StepWeights overdamped(double sigma) {
  mechanics::StepWeights weights;
  weights.acceleration.motion = sigma;
  return weights;
}

}  // namespace

OverdampedMotion::OverdampedMotion(StaticSearch& search) : search_(search), run_(search.run()) {}

std::vector<Points> OverdampedMotion::positions() const {
  std::vector<Points> result;
  for (const auto& body : run_.world.bodies().all()) result.push_back(body->positions());
  return result;
}

double OverdampedMotion::moved_since(const std::vector<Points>& before) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Points& now = run_.world.bodies().all()[i]->positions();
    if (now.rows() > 0) worst = std::max(worst, (now - before[i]).cwiseAbs().maxCoeff());
  }
  return worst;
}

// d^T M d, from the change of the residual by inertia in a small motion along d; kg m^2 or similar.
double OverdampedMotion::mass_along(const VectorX& direction) {
  Bodies& bodies = run_.world.bodies();
  search_.begin();
  const double scale = kSmall * run_.model->size() / direction.cwiseAbs().maxCoeff();
  bodies.propose_motion(direction);
  bodies.apply_motion(scale);
  VectorX still, moving;
  search_.linearise({});
  bodies.imbalance(run_.effort, still);
  double sigma = 1.0;
  double mass = 0.0;
  for (int round = 0; round < 2; ++round) {  // the second with inertia well above rounding
    search_.linearise(overdamped(sigma));
    bodies.imbalance(run_.effort, moving);
    mass = direction.dot(still - moving) / (sigma * scale);
    const double inertia = (still - moving).norm();
    if (!(inertia > 0.0)) sigma *= 1e12;
    if (inertia > 0.0) sigma *= std::max(1.0, still.norm() / inertia);
  }
  bodies.apply_motion(0.0);
  return mass;
}

OverdampedMotion::End OverdampedMotion::leave(const Stability& stability, double disturbance) {
  const VectorX& mode = stability.mode();
  const double curvature = stability.curvature();
  if (mode.size() == 0) return End::failed;
  Bodies& bodies = run_.world.bodies();
  const double mass = mass_along(mode);
  if (!(mass > 0.0)) return End::failed;
  left_ = positions();
  bodies.propose_motion(mode);
  disturbance *= run_.model->size();
  bodies.apply_motion(kSmall * run_.model->size());
  double scale = kSmall * run_.model->size() * disturbance / moved_since(left_);
  const auto is_sound = [&] {
    return bodies.apply_motion(scale).finite && bodies.smallest_volume().ratio > 0.0;
  };
  while (!is_sound()) {
    scale *= 0.5;
    disturbance *= 0.5;
  }
  return relax(kFirstInertia * std::abs(curvature) / mass, kBack * disturbance);
}

// Starts at the last equilibrium of the path, in the Newton direction.
bool OverdampedMotion::relax_from_here() {
  World& world = run_.world;
  Bodies& bodies = world.bodies();
  search_.begin();
  search_.linearise({});
  if (world.condense() == linalg::FactorStatus::singular) return false;
  const std::vector<double> before = run_.effort;
  if (world.solve_step(run_.solver, nullptr, run_.effort, run_.clock) == LawStatus::failed) {
    run_.effort = before;
  }
  VectorX imbalance, direction;
  bodies.imbalance(run_.effort, imbalance);
  bodies.solve(imbalance, direction);
  if (!(direction.norm() > 0.0)) return false;
  const double curvature = std::abs(direction.dot(imbalance));
  run_.effort = before;
  const double mass = mass_along(direction);
  if (!(mass > 0.0)) return false;
  left_.clear();
  return relax(kFirstInertia * curvature / mass, 0.0) == End::arrived;
}

// @param sigma of the first step, 1/s^2. @param near m: distance to left_ that counts as a return.
OverdampedMotion::End OverdampedMotion::relax(double sigma, double near) {
  run_.watch.enter(SearchStage::overdamped);
  run_.world.homotopy().set_fraction(0.0);
  int& steps = search_.report().relaxation_steps;
  double settled = kSettling * run_.model->size();
  double moved_before = 0.0;
  int failures = 0;
  while (steps < search_.settings().max_relaxation_steps) {
    ++steps;
    run_.keep(sound_);
    const std::vector<Points> before = positions();
    if (!search_.step(overdamped(sigma), kRelaxationTolerance, kMaxIterationsOfStep)) {
      run_.restore(sound_);
      if (++failures == kMaxFailures) break;
      sigma *= kHeaviest;
      continue;
    }
    failures = 0;
    const int iterations = search_.last().iterations;
    const double moved = moved_since(before);
    if (!left_.empty() && moved_since(left_) < near) {
      return search_.equilibrate(0.0) ? End::returned : End::failed;
    }
    const bool slows = moved < moved_before;
    if (slows && moved < settled) {
      if (arrives()) return End::arrived;
      settled = kLater * moved;
    }
    moved_before = moved;
    // While the robot moves away from left_, less inertia could let a step overshoot.
    if (slows && iterations <= kFewIterations) sigma *= kLighter;
    if (iterations > kManyIterations) sigma *= kHeavier;
  }
  return End::failed;
}

// Whether Newton's method finds an equilibrium from here; if not, the state is restored.
bool OverdampedMotion::arrives() {
  run_.keep(sound_);
  if (search_.equilibrate(0.0)) return true;
  run_.restore(sound_);
  return false;
}

}  // namespace sinew::sim
