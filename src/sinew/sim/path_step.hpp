/// @file
/// One step along a path of equilibria, of a given length.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/held_motions.hpp"
#include "sinew/sim/path_settings.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

class PathLoads;
struct Run;

/// The equation is r(q, s) = b(q, s) + H^T lambda(s) = 0. A step predicts along the tangent of the
/// path (PathPredictor), and corrects in a plane normal to it (Riks, Int. J. Solids Struct. 15
/// (1979) 529; Ramm 1981; Crisfield 1991, sec. 9.3): with m_r = A^-1 r and m_p = A^-1 dr/ds,
///   dq = m_r + ds m_p,   ds = -(D . m_r)/(D . m_p),
/// D the motion since the step began. A, the exact tangent, may be indefinite on the way. Joints
/// hold rows: m_r and m_p are then motions that they leave, and bring their efforts (HeldMotions).
///
/// Contacts without friction: the path is smooth as long as the same points touch, and these hold
/// their normal rows as joints do. A prediction that goes past corners says which points touch
/// behind the last one, and D is the motion along the edge that it ends on. A step ends where these
/// points are pressed and all others are outside; where they are not, the prediction was too long,
/// and a shorter one, which errs by the square of its length, is tried. Friction is a law of the
/// increments of a step (PathContacts).
///
/// A curved surface is, in every iteration, the tangent plane at each point's nearest. Of the force
/// lambda n(x) on a point the derivative is lambda times the gap's second derivative, lambda/R
/// along a principal tangent: a row with stiffness -lambda/R, that is with compliance -R/lambda,
/// among those that hold the robot.
class PathStep {
 public:
  /// All outlive it. @param run is moved. @param settings see there. @param loads that grow.
  PathStep(Run& run, const PathSettings& settings, PathLoads& loads)
      : run_(run), settings_(settings), loads_(loads) {}

  /// From the last point, or the start. @param length m, of the largest motion. @return iterations;
  /// 0: it failed, and nothing has moved.
  int take(double length);
  /// Where it stands.
  PathPoint point() const { return {load_fraction_, negative_pivots_}; }

 private:
  int try_length(double length);
  bool predict(const VectorX& here, const VectorX& ahead, double length);
  bool correct(const VectorX& here, const VectorX& ahead);
  void imbalance_at(double load_fraction, VectorX& imbalance);
  double gap() const;
  std::vector<step::ContactBlock> pressed() const;
  std::vector<step::HeldRow> joints(std::span<const step::ContactBlock> touching) const;
  std::vector<step::HeldRow> joints_and_sticking() const;
  void move(const VectorX& motion, double load_fraction);
  void push(std::span<const step::HeldRow> held, const VectorX& efforts);
  bool is_sound(double length);
  bool is_path_point();
  void count();

  Run& run_;
  const PathSettings& settings_;
  PathLoads& loads_;
  double load_fraction_ = 0.0;                // of the way
  std::vector<step::ContactBlock> touching_;  // of the problem
  VectorX moved_;                             // since the step began
  VectorX origin_;                            // of D, likewise
  VectorX direction_;                         // of the last step
  int negative_pivots_ = 0;                   // at the last linearisation that was solved
};

}  // namespace sinew::sim
