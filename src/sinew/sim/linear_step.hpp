/// @file
/// One linear solution of a step's equation, as real-time codes make it.
#pragma once

namespace sinew::mechanics {
struct LinearisationRequest;
}

namespace sinew::sim {

struct Run;

/// Solves a step by one linearisation, and looks at what that left. In dynamics it is about where
/// the velocities lead: a turn by an angle t is then followed to t^2, and not stretched.
class LinearStep {
 public:
  /// @param run outlives it; its step has begun when solve() is called.
  explicit LinearStep(Run& run) : run_(run) {}
  /// Moves the bodies and reports. Throws Error(singular-matrix | not-converged | diverged |
  /// inverted-in-run), the run then being as before the step. @param time_step s.
  void solve(double time_step);

 private:
  void linearise(const mechanics::LinearisationRequest& request);
  void condense(mechanics::LinearisationRequest& request);
  void move_soundly();
  void require_outside();
  void look_back(mechanics::LinearisationRequest request);

  Run& run_;
};

}  // namespace sinew::sim
