/// @file
/// How the steps of a simulation are solved.
#pragma once

#include <optional>

#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::sim {

/// How many linearisations a step takes.
enum class Method {
  one_linearisation,  ///< one linear solve a step, as real-time codes do
  newton,             ///< Newton's iterations to the tolerance
};

/// Smaller steps inside each time step where the integrator's error asks for them or a step fails.
struct AdaptiveStep {
  double tolerance = 1e-4;  ///< error of a step in any coordinate, relative to the robot's size
  double smallest = 0.0;    ///< s, > 0
};

/// How each step is solved.
struct StepSettings {
  double time_step = 0.01;  ///< s, > 0
  mechanics::Integrator integrator = mechanics::Integrator::quasi_static;
  double spectral_radius = 0.8;  ///< of generalized-alpha, 0 to 1
  std::optional<AdaptiveStep> adaptive;
  Method method = Method::one_linearisation;
  /// The exact tangent comes with the geometric stiffness of all cables, without which it says
  /// little: a compressed robot's own tangent may be indefinite where the held robot is stable.
  mechanics::Tangent tangent = mechanics::Tangent::real_time;
  double tolerance = 1e-8;  ///< Newton: residual relative to the loads, and motion to the size
  int max_iterations = 50;  ///< Newton
  double contact_tolerance = 1e-10;  ///< of the contacts' residual, see qp::ConeResult
};

}  // namespace sinew::sim
