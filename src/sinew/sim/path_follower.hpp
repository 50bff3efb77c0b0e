/// @file
/// Equilibria along a load that grows, through limit points and back, by the length of the path
/// rather than by the load.
#pragma once

#include <functional>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/path_settings.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

struct Run;

/// The equation is r(q, s) = b(q, s) + H^T lambda(s) = 0. A step predicts along the tangent of the
/// path, (A^-1 dr/ds, 1), and corrects in the plane normal to it (Riks, Int. J. Solids Struct. 15
/// (1979) 529; Ramm 1981; Crisfield 1991, sec. 9.3): with m_r = A^-1 r and m_p = A^-1 dr/ds,
///   dq = m_r + ds m_p,   ds = -(D . m_r)/(D . m_p),
/// D the motion since the step began. A, the exact tangent, may be indefinite on the way. Joints
/// hold rows: m_r and m_p are then motions that they leave, and bring their efforts (HeldMotions).
class PathFollower {
 public:
  /// @param run is moved. @param settings see there.
  PathFollower(Run& run, const PathSettings& settings) : run_(run), settings_(settings) {}
  /// See Simulation::follow_path(). @param visit called at every point, if there is something to
  /// call.
  std::vector<PathPoint> follow(const std::function<void()>& visit);

 private:
  void check() const;
  void plan();
  void set_share(double share);
  void imbalance_at(double share, VectorX& imbalance);
  double gap() const;
  bool solve(const VectorX& here, const VectorX& ahead);
  bool advance(bool first, double length);
  bool is_sound(double length);
  int step(double length);
  int step_or_give_up(double length);
  void rest();

  struct Stretch {
    double from = 0.0, to = 0.0;
  };

  Run& run_;
  const PathSettings& settings_;
  std::vector<Stretch> loads_, efforts_;  // of the model's loads and actuators
  double share_ = 0.0;                    // of the way
  std::vector<step::HeldRow> held_;       // by joints
  // Motions and efforts of held rows: of r, and of dr/ds.
  struct Answer {
    VectorX motion, efforts;
  };
  Answer by_rest_, by_load_;
  VectorX moved_;            // since the step began
  VectorX direction_;        // of the last step
  int negative_pivots_ = 0;  // at the last linearisation that was solved
};

}  // namespace sinew::sim
