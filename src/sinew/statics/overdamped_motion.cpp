#include "sinew/statics/overdamped_motion.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/run/run.hpp"
#include "sinew/statics/static_search.hpp"
#include "sinew/world/stability.hpp"

namespace sinew::statics {

namespace {

// Steps follow the motion approximately; near its end, Newton's method takes over.
constexpr double kRelaxationTolerance = 1e-4;
constexpr int kMaxIterationsOfStep = 12;
constexpr int kStandingSteps = 2, kStandingTries = 4;
constexpr int kFewIterations = 4;
constexpr int kManyIterations = 8;
constexpr double kLighter = 0.25;  // factor of sigma after an easy step
constexpr double kHeavier = 2.0;   // after a hard one
// Smallest sigma relative to the first, at which all but neutral motions have come to rest.
constexpr double kLightest = 1e-10;
// A robot that has moved by this multiple of its size slides or falls without end.
constexpr double kRunsAway = 10.0;
constexpr double kHeaviest = 8.0;  // after a failed one
constexpr int kMaxFailures = 8;    // in a row
// A decreasing motion below this fraction of the robot's size per step is settling.
constexpr double kSettling = 0.02;
constexpr double kLater = 0.25;
constexpr double kNearRest = 1e-5;  // of the robot's size per step
// Distance to the equilibrium that was left, relative to the disturbance, at which the state has
// returned.
constexpr double kBack = 0.1;
constexpr double kSmall = 1e-6;  // of the robot's size: test motion for measurements
// Initial inertia relative to that at which the softest direction would be neutral.
constexpr double kFirstInertia = 2.0;

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

OverdampedMotion::End OverdampedMotion::leave(const world::Stability& stability,
                                              double disturbance) {
  const VectorX& mode = stability.mode();
  const double curvature = stability.curvature();
  if (mode.size() == 0) return End::failed;
  world::Bodies& bodies = run_.world.bodies();
  const double mass = search_.mass_along(mode);
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

bool OverdampedMotion::relax_from_here(double first) {
  const double sigma = first_sigma(first);
  if (!(sigma > 0.0)) return false;
  left_.clear();
  return relax(sigma, 0.0) == End::arrived;
}

// The first step closes gaps that are open by rounding, and the second begins without them.
bool OverdampedMotion::stand() {
  double sigma = sigma_of_loads();
  const run::NewtonReport last = search_.last();
  run_.keep(sound_);
  for (int tries = 0; sigma > 0.0 && tries < kStandingTries; ++tries, sigma *= kHeaviest) {
    bool stands = true;
    for (int round = 0; stands && round < kStandingSteps; ++round) {
      stands = search_.step(search_.overdamped(sigma), search_.settings().tolerance,
                            kMaxIterationsOfStep);
    }
    if (stands && search_.rests()) return true;
    run_.restore(sound_);
  }
  search_.put_back(last);
  return false;
}

// In the Newton direction, the inertia exceeds the curvature. A singular tangent has no such
// direction, and that of a loose robot may be the one of its anchors: along the forces, the first
// step then moves by a small part of the robot's size.
double OverdampedMotion::first_sigma(double first) {
  world::World& world = run_.world;
  world::Bodies& bodies = world.bodies();
  search_.begin();
  search_.linearise();
  const std::vector<double> before = run_.effort;
  const bool singular = world.condense() == linalg::FactorStatus::singular;
  const bool lawless = !singular && world.solve_step(run_.solver, nullptr, run_.effort,
                                                     run_.clock) == run::LawStatus::failed;
  if (lawless) run_.effort = before;
  VectorX imbalance, direction;
  bodies.imbalance(run_.effort, imbalance);
  run_.effort = before;
  if (lawless && run_.model->is_loose()) return sigma_of_loads();
  if (!(imbalance.norm() > 0.0)) return 0.0;
  double along_forces = kInfinity;
  if (singular || run_.model->is_loose()) {
    if (!singular) bodies.solve(imbalance, direction);
    const double far = first * run_.model->size() / imbalance.cwiseAbs().maxCoeff();
    along_forces = imbalance.squaredNorm() / (far * search_.mass_along(imbalance));
    if (singular || !(direction.norm() > 0.0)) return along_forces;
  } else {
    bodies.solve(imbalance, direction);
  }
  const double mass = direction.norm() > 0.0 ? search_.mass_along(direction) : 0.0;
  if (!(mass > 0.0)) return 0.0;
  const double curved = kFirstInertia * std::abs(direction.dot(imbalance)) / mass;
  return std::min(curved, along_forces);
}

// Forces that act on rigid bodies at a distance from their centres have a stiffness of their size
// over a length, of either sign, and the laws of contacts have no solution by a tangent that is
// indefinite. This inertia is of the same order.
double OverdampedMotion::sigma_of_loads() {
  world::Bodies& bodies = run_.world.bodies();
  const VectorX test = world::scattered(static_cast<Eigen::Index>(bodies.size()));
  const double mass = search_.mass_along(test) / test.squaredNorm();
  search_.begin();
  search_.linearise();
  bodies.residual(run_.effort);
  return mass > 0.0 ? kFirstInertia * bodies.force_scale() / (run_.model->size() * mass) : 0.0;
}

// Whether the displacements since `before` are against those of the step before, which they
// replace.
bool OverdampedMotion::turns_back(const std::vector<Points>& before,
                                  std::vector<Points>& last) const {
  double along = 0.0;
  last.resize(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Points now = run_.world.bodies().all()[i]->positions() - before[i];
    if (last[i].rows() == now.rows()) along += now.cwiseProduct(last[i]).sum();
    last[i] = now;
  }
  return along < 0.0;
}

// @param sigma of the first step, 1/s^2. @param near m: distance to left_ that counts as a return.
OverdampedMotion::End OverdampedMotion::relax(double sigma, double near) {
  run_.watch.enter(run::SearchStage::overdamped);
  run_.world.homotopy().set_fraction(0.0);
  int& steps = search_.report().relaxation_steps;
  const double least = kLightest * sigma;
  const double largest = kRunsAway * run_.model->size();
  const std::vector<Points> start = positions();
  const double still = search_.settings().tolerance * run_.model->size();
  double settled = kSettling * run_.model->size();
  double tolerance = kRelaxationTolerance;
  double moved_before = 0.0;
  int failures = 0;
  std::vector<Points> last;  // displacements of the last step
  while (steps < search_.settings().max_relaxation_steps) {
    ++steps;
    run_.keep(sound_);
    const std::vector<Points> before = positions();
    if (!search_.step(search_.overdamped(sigma), tolerance, kMaxIterationsOfStep)) {
      run_.restore(sound_);
      if (++failures == kMaxFailures) break;
      sigma *= kHeaviest;
      continue;
    }
    failures = 0;
    const int iterations = search_.last().iterations;
    const double moved = moved_since(before);
    const bool turned = turns_back(before, last);
    if (!left_.empty() && moved_since(left_) < near) {
      return search_.equilibrate(0.0) ? End::returned : End::failed;
    }
    if (!(moved_since(start) < largest)) break;
    const bool slows = moved < moved_before || moved <= still;
    if (slows && moved < settled) {
      if (arrives()) return End::arrived;
      settled = kLater * moved;
      // Where Newton's method cannot, the motion must find the rest by itself.
      const bool alone = run_.model->is_loose() ||
                         search_.last().status == run::NewtonStatus::singular ||
                         moved < kNearRest * run_.model->size();
      if (alone) tolerance = search_.settings().tolerance;
    }
    moved_before = moved;
    // While the robot moves away from left_, less inertia could let a step overshoot.
    // A tangent without the curvature of what touches overshoots once sigma is below it.
    if (turned && !slows) sigma *= kHeavier;
    if (slows && !turned && iterations <= kFewIterations) sigma = std::max(least, kLighter * sigma);
    if (iterations > kManyIterations) sigma *= kHeavier;
  }
  return End::failed;
}

// Whether this is an equilibrium or Newton's method finds one from here; if not, the state is
// restored. Bodies that nothing but contact holds have no tangent for Newton's method.
bool OverdampedMotion::arrives() {
  run_.keep(sound_);
  if (search_.rests()) return true;
  if (search_.equilibrate(0.0)) return true;
  run_.restore(sound_);
  return false;
}

}  // namespace sinew::statics
