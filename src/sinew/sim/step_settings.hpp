/// @file
/// How the steps of a simulation are solved.
#pragma once

#include <optional>

#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::sim {

/// How many linearisations a step takes.
enum class Method {
  one_linearisation,  ///< one linear solve a step, as real-time codes do; watched, not corrected
  newton,             ///< as many as the tolerance asks for: one where little changes
};

/// Smaller steps inside each time step where the integrator's error asks for them or a step fails.
struct AdaptiveStep {
  double tolerance = 1e-4;  ///< error of a step in any coordinate, relative to the robot's size
  double smallest = 0.0;    ///< s, > 0
};

/// Of quasi-static steps; what is of second order in an iteration's move is left to the next step
/// at higher residuals.
inline constexpr double kQuasiStaticTolerance = 1e-4;
/// Where the error of a step stays: as an impulse in dynamics, as a strain in materials with
/// memory.
inline constexpr double kLastingTolerance = 1e-8;

/// How each step is solved.
struct StepSettings {
  double time_step = 0.01;  ///< s, > 0
  mechanics::Integrator integrator = mechanics::Integrator::quasi_static;
  double spectral_radius = 0.8;  ///< of generalized-alpha, 0 to 1
  double restitution = 0.0;      ///< of event-driven integration, 0 to 1: of contacts without own
  std::optional<AdaptiveStep> adaptive;
  Method method = Method::newton;
  /// The exact tangent comes with the geometric stiffness of all cables, without which it says
  /// little: a compressed robot's own tangent may be indefinite where the held robot is stable.
  /// Where it is indefinite for the held robot, too, the projected one takes its place.
  mechanics::Tangent tangent = mechanics::Tangent::exact;
  /// Newton: residual relative to the loads, and motion to the size; nothing above it is left to
  /// the next step. None: kQuasiStaticTolerance, and what is left (docs/solver.md), or
  /// kLastingTolerance.
  std::optional<double> tolerance;
  int max_iterations = 50;  ///< Newton

  bool dynamic() const { return integrator != mechanics::Integrator::quasi_static; }
  bool event_driven() const { return integrator == mechanics::Integrator::event_driven; }
  double contact_tolerance = 1e-10;  ///< of the contacts' residual, see qp::ConeResult
};

}  // namespace sinew::sim
