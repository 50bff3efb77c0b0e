/// @file
/// How the steps of a simulation are solved.
#pragma once

#include <optional>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::model {

/// How many times a step is linearised.
enum class Method {
  one_linearisation,  ///< one linear solve per step, as in real-time codes; checked, not corrected
  newton,             ///< as many as the tolerance requires; one if little changes
};

/// When the iterations of a quasi-static step end. Materials with memory always take `converged`.
enum class Equilibrium {
  converged,  ///< at equilibrium, to the tolerance or to rounding
  /// Once the error is of second order in the motion of the step, which the next step removes. The
  /// report bounds the distance to the equilibrium (StepReport::distance).
  following,
};

/// Divides time steps into smaller ones if the integrator's error requires it or a step fails.
struct AdaptiveStep {
  double tolerance = 1e-4;  ///< step error in any coordinate, relative to the robot's size
  double smallest = 0.0;    ///< s, > 0, smallest step
};

/// Default tolerance of quasi-static steps.
inline constexpr double kQuasiStaticTolerance = 1e-6;
/// The same for Equilibrium::following. At higher residuals, an error of second order in the motion
/// of an iteration is left to the next step.
inline constexpr double kFollowingTolerance = 1e-4;
/// Default tolerance where the error of a step persists: as an impulse in dynamics, as a strain in
/// materials with memory.
inline constexpr double kLastingTolerance = 1e-8;
/// Such a step also counts as solved below this residual if iterations no longer reduce it: contact
/// laws and friction are solved iteratively, and near an instability the equation amplifies their
/// errors.
inline constexpr double kStalledTolerance = 1e-6;

/// How each step is solved.
struct StepSettings {
  Location place;           ///< where the scene names the integrator, for messages
  double time_step = 0.01;  ///< s, > 0
  mechanics::Integrator integrator = mechanics::Integrator::quasi_static;
  /// Of generalized-alpha at infinite frequency, 0 to 1; see check_held_radius().
  double spectral_radius = 0.8;
  double restitution = 0.0;  ///< of event-driven integration, 0 to 1: default of the contacts
  std::optional<AdaptiveStep> adaptive;
  Method method = Method::newton;
  /// The exact tangent includes the geometric stiffness of all cables; without it, the tangent of a
  /// compressed robot may be indefinite although the robot with its constraints is stable. If the
  /// tangent is indefinite for the robot with its constraints too, the projected one is used
  /// instead.
  mechanics::Tangent tangent = mechanics::Tangent::exact;
  /// When quasi-static steps end. None: `following` with an attached controller or commander and
  /// after Simulation::follow(), otherwise `converged`.
  std::optional<Equilibrium> equilibrium;
  /// Tolerance of Newton's method: residual relative to the loads, and violation relative to the
  /// robot's size; no larger error is accepted in any step. None: one of the constants above.
  std::optional<double> tolerance;
  int max_iterations = 50;  ///< of Newton's method

  bool dynamic() const { return integrator != mechanics::Integrator::quasi_static; }
  bool event_driven() const { return integrator == mechanics::Integrator::event_driven; }
  double contact_tolerance = 1e-10;  ///< on the residual of the contact laws, see qp::ConeResult
};

}  // namespace sinew::model
