#include "sinew/sim/static_search.hpp"

#include "sinew/sim/run.hpp"

namespace sinew::sim {

namespace {

constexpr int kIdle = 6;
// Stick and slip, and points that open and close, settle after some iterations without progress.
constexpr int kIdleInContact = 20;

mechanics::LinearisationRequest request(const mechanics::StepWeights& weights) {
  return {weights, mechanics::Tangent::exact, true, true};
}

}  // namespace

int max_idle(const Model& model) {
  const bool sticks = !model.contacts().empty() || !model.guides().empty();
  return sticks ? kIdleInContact : kIdle;
}

void StaticSearch::begin() { run_.world.begin_step(run_.time(), run_.time(), run_.effort); }

void StaticSearch::linearise(const mechanics::StepWeights& weights) {
  run_.world.linearise(request(weights));
  run_.world.form_rows(run_.effort, run_.model->geometric_stiffness().all);
}

bool StaticSearch::equilibrate(double fraction) {
  run_.world.homotopy().set_fraction(fraction);
  return step({}, settings_.tolerance, settings_.max_iterations, max_idle(*run_.model));
}

bool StaticSearch::step(const mechanics::StepWeights& weights, double tolerance, int max_iterations,
                        int max_idle) {
  begin();
  last_ = run_.newton(nullptr, {request(weights),
                                tolerance,
                                tolerance,
                                max_iterations,
                                run_.model->geometric_stiffness().all,
                                {},
                                0,
                                max_idle});
  report_.iterations += last_.iterations;
  return last_.status == NewtonStatus::converged;
}

}  // namespace sinew::sim
