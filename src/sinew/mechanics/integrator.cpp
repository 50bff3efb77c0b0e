#include "sinew/mechanics/integrator.hpp"

#include <cmath>

namespace sinew::mechanics {

namespace {

StepWeights backward_euler(double h) {
  StepWeights weights;
  weights.velocity = {.motion = 1.0 / h};
  weights.acceleration = {.motion = 1.0 / h * (1.0 / h), .velocity = -1.0 / h};
  // Error of q: h^2/2 a.
  weights.error_jump = 0.5 * h;
  weights.error_of = StepWeights::Jump::velocity;
  return weights;
}

StepWeights bdf2(double h, double before) {
  const double w = h / before;
  const double now = (1.0 + 2.0 * w) / (1.0 + w) / h, last = w * w / (1.0 + w) / h;
  StepWeights weights;
  weights.velocity = {.motion = now, .first = -last};
  // a = now (v - v_start) - last (v_start - v_before).
  weights.acceleration = {
      .motion = now * now, .velocity = -now - last, .first = -now * last, .second = last};
  weights.first = {.motion = 1.0};
  weights.second = {.velocity = 1.0};
  // Error of q: 2/9 h^3 times the third derivative, for equal steps.
  weights.error_jump = 2.0 / 9.0 * h * h;
  weights.error_of = StepWeights::Jump::acceleration;
  weights.step_before = before;
  return weights;
}

StepWeights generalized_alpha(double h, double rho) {
  const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0);
  const double gamma = 0.5 - alpha_m + alpha_f;
  const double beta = 0.25 * (1.0 - alpha_m + alpha_f) * (1.0 - alpha_m + alpha_f);
  StepWeights weights;
  // The algorithmic acceleration at the end, a'.
  weights.first = {
      .motion = 1.0 / (h * h * beta), .velocity = -1.0 / (h * beta), .first = -(0.5 - beta) / beta};
  const Combination& end = weights.first;
  weights.velocity = {.motion = h * gamma * end.motion,
                      .velocity = 1.0 + h * gamma * end.velocity,
                      .first = h * (1.0 - gamma) + h * gamma * end.first};
  const double part = 1.0 / (1.0 - alpha_f);
  weights.acceleration = {.motion = part * (1.0 - alpha_m) * end.motion,
                          .velocity = part * (1.0 - alpha_m) * end.velocity,
                          .first = part * ((1.0 - alpha_m) * end.first + alpha_m),
                          .second = -part * alpha_f};
  weights.second = weights.acceleration;
  // Zienkiewicz & Xie, Earthq. Eng. Struct. Dyn. 20, 1991.
  weights.error_jump = h * h * std::abs(beta - 1.0 / 6.0);
  weights.error_of = StepWeights::Jump::first;
  return weights;
}

}  // namespace

std::string_view integrator_name(Integrator integrator) {
  switch (integrator) {
    case Integrator::quasi_static:
      return "quasi-static";
    case Integrator::backward_euler:
      return "backward-euler";
    case Integrator::bdf2:
      return "bdf2";
    case Integrator::generalized_alpha:
      return "generalized-alpha";
    case Integrator::event_driven:
      return "event-driven";
  }
  return "unknown";
}

int history_count(Integrator integrator) {
  const bool two = integrator == Integrator::bdf2 || integrator == Integrator::generalized_alpha;
  return two ? 2 : 0;
}

StepWeights step_weights(Integrator integrator, double time_step, double step_before,
                         double spectral_radius) {
  const bool bdf = integrator == Integrator::bdf2;
  StepWeights weights;
  weights.time_step = time_step;  // materials relax in quasi-static steps, too
  if (integrator == Integrator::quasi_static) return weights;
  const bool alone =
      integrator == Integrator::backward_euler || integrator == Integrator::event_driven;
  if (alone || !(step_before > 0.0)) {
    weights = backward_euler(time_step);
    if (bdf) {  // the history of bdf2()
      weights.first = {.motion = 1.0};
      weights.second = {.velocity = 1.0};
    } else {
      weights.first = weights.second = weights.acceleration;
    }
  } else {
    weights = bdf ? bdf2(time_step, step_before) : generalized_alpha(time_step, spectral_radius);
  }
  weights.time_step = time_step;
  return weights;
}

StepWeights midpoint_weights(double time_step) {
  const double rate = 1.0 / time_step;
  StepWeights weights;
  weights.velocity = {.motion = 2.0 * rate, .velocity = -1.0};
  weights.acceleration = {.motion = 2.0 * rate * rate, .velocity = -2.0 * rate};
  weights.time_step = time_step;
  return weights;
}

}  // namespace sinew::mechanics
