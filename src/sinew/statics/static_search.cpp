#include "sinew/statics/static_search.hpp"

#include <algorithm>

#include "sinew/run/run.hpp"

namespace sinew::statics {

namespace {

constexpr int kIdle = 6;
// Stick and slip, and points that open and close, settle after some iterations without progress.
constexpr int kIdleInContact = 20;
constexpr double kTestMotion = 1e-6;  // of the robot's size: test motion for measurements

mechanics::LinearisationRequest request(const mechanics::StepWeights& weights) {
  return {weights, mechanics::Tangent::exact, true, true};
}

}  // namespace

int max_idle(const model::Model& model) {
  const bool sticks = !model.contacts().empty() || !model.guides().empty();
  return sticks ? kIdleInContact : kIdle;
}

void StaticSearch::begin() { run_.world.begin_at_rest(run_.now, run_.effort); }

mechanics::StepWeights StaticSearch::overdamped(double sigma) const {
  mechanics::StepWeights weights = rest_;
  weights.acceleration.motion = sigma;
  return weights;
}

void StaticSearch::linearise(const mechanics::StepWeights& weights) {
  run_.world.linearise(request(weights));
  run_.world.form_rows(run_.effort, run_.model->geometric_stiffness().all);
}

bool StaticSearch::equilibrate(double fraction, int max_idle) {
  run_.world.homotopy().set_fraction(fraction);
  return step(rest_, settings_.tolerance, settings_.max_iterations, max_idle);
}

bool StaticSearch::step(const mechanics::StepWeights& weights, double tolerance, int max_iterations,
                        int max_idle) {
  weights_ = weights;
  run_.world.begin_step(run_.now, run_.now, run_.effort);
  run::NewtonSettings settings;
  settings.request = request(weights);
  settings.tolerance = settings.motion_tolerance = tolerance;
  settings.max_iterations = max_iterations;
  settings.geometric = run_.model->geometric_stiffness().all;
  settings.max_idle = max_idle;
  last_ = run_.newton(nullptr, settings);
  report_.iterations += last_.iterations;
  return last_.status == run::NewtonStatus::converged;
}

bool StaticSearch::rests() {
  world::World& world = run_.world;
  begin();
  linearise();
  const double residual = world.bodies().residual(run_.effort);
  const double relative = residual / (world.bodies().force_scale() + 1e-300);
  if (!(relative <= settings_.tolerance)) return false;
  // The laws compare efforts with motions by the compliance, which needs a matrix without a null
  // space. The residual above is of a body at rest, this one is not used.
  linearise(weights_);
  if (world.condense() == linalg::FactorStatus::singular) return false;
  const double violation = world.violation(run_.effort, law::LawStatus::solved);
  if (!(violation <= settings_.tolerance * run_.model->size())) return false;
  last_.status = run::NewtonStatus::converged;
  last_.residual = residual;
  last_.relative_residual = relative;
  last_.violation = violation;
  last_.motion.volume = world.bodies().smallest_volume();
  return true;
}

double StaticSearch::curvature_along(const VectorX& direction) {
  world::Bodies& bodies = run_.world.bodies();
  begin();
  const double scale = kTestMotion * run_.model->size() / direction.cwiseAbs().maxCoeff();
  bodies.propose_motion(direction);
  VectorX ahead, behind;
  for (const double sense : {1.0, -1.0}) {
    bodies.apply_motion(sense * scale);
    linearise();
    bodies.imbalance(run_.effort, sense > 0.0 ? ahead : behind);
  }
  bodies.apply_motion(0.0);
  return direction.dot(behind - ahead) / (2.0 * scale);
}

double StaticSearch::mass_along(const VectorX& direction) {
  world::Bodies& bodies = run_.world.bodies();
  begin();
  const double scale = kTestMotion * run_.model->size() / direction.cwiseAbs().maxCoeff();
  bodies.propose_motion(direction);
  bodies.apply_motion(scale);
  VectorX still, moving;
  linearise();
  bodies.imbalance(run_.effort, still);
  double sigma = 1.0;
  double mass = 0.0;
  for (int round = 0; round < 2; ++round) {  // the second with inertia well above rounding
    linearise(overdamped(sigma));
    bodies.imbalance(run_.effort, moving);
    mass = direction.dot(still - moving) / (sigma * scale);
    const double inertia = (still - moving).norm();
    if (!(inertia > 0.0)) sigma *= 1e12;
    if (inertia > 0.0) sigma *= std::max(1.0, still.norm() / inertia);
  }
  bodies.apply_motion(0.0);
  return mass;
}

}  // namespace sinew::statics
