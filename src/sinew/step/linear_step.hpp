/// @file
/// A time step with one linear solution, as in real-time codes.
#pragma once

namespace sinew::mechanics {
struct LinearisationRequest;
}

namespace sinew::run {
struct Run;
}

namespace sinew::step {

/// Solves a step by one linearisation and measures the residual. In dynamics, it linearises about
/// the state extrapolated with the velocities: a rotation by an angle t is then followed to order
/// t^2, without stretching.
class LinearStep {
 public:
  /// @param run must outlive it; its step has begun when solve() is called.
  explicit LinearStep(run::Run& run) : run_(run) {}
  /// Moves the bodies and fills the report. Throws Error(singular-matrix | not-converged | diverged
  /// | inverted-in-run), after which the run is as before the step. @param time_step s.
  void solve(double time_step);

 private:
  void linearise(const mechanics::LinearisationRequest& request);
  void condense(mechanics::LinearisationRequest& request);
  void move_soundly();
  void require_outside();
  void look_back(mechanics::LinearisationRequest request);
  void require_solution();

  run::Run& run_;
  double moved_ = 0.0;  // m, largest move of the step
};

}  // namespace sinew::step
