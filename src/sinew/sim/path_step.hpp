/// @file
/// One step of given length along a path of equilibria.
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

/// Follows the equilibria r(q, s) = b(q, s) + H^T lambda(s) = 0. A step predicts along the tangent
/// of the path (PathPredictor), and corrects in a plane normal to it (Riks, Int. J. Solids Struct.
/// 15 (1979) 529; Ramm 1981; Crisfield 1991, sec. 9.3): with m_r = A^-1 r and m_p = A^-1 dr/ds,
///   dq = m_r + ds m_p,   ds = -(D . m_r)/(D . m_p),
/// where D is the motion since the step began. A, the exact tangent, may be indefinite on the path.
/// Joints hold rows: m_r and m_p are then motions that the joints permit, with the efforts of the
/// joints (HeldMotions).
///
/// Frictionless contacts: the path is smooth as long as the set of touching points does not change,
/// and these hold their normal rows like joints. A prediction that passes corners determines which
/// points touch after the last one, and D is the motion along the edge on which it ends. A step is
/// accepted if these points have compressive forces and all others are outside; otherwise the
/// prediction was too long, and a shorter one, whose error decreases with the square of its length,
/// is tried. Friction is a law of the increments of a step (PathContacts).
///
/// A curved surface is replaced in every iteration by the tangent plane nearest to each point. The
/// derivative of the force lambda n(x) on a point is lambda times the second derivative of the gap,
/// lambda/R along a principal tangent. It enters as a held row with stiffness -lambda/R, that is,
/// compliance -R/lambda.
class PathStep {
 public:
  /// All must outlive it. @param run is moved. @param settings step lengths and tolerance.
  /// @param loads that grow.
  PathStep(Run& run, const PathSettings& settings, PathLoads& loads)
      : run_(run), settings_(settings), loads_(loads) {}

  /// Makes a step from the last point, or the start.
  /// @param length m, largest motion in any coordinate.
  /// @return the number of iterations; 0 if it failed, with the run restored.
  int take(double length);
  /// The present point of the path.
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
  double load_fraction_ = 0.0;                // present position
  std::vector<step::ContactBlock> touching_;  // of the problem
  VectorX moved_;                             // motion since the step began
  VectorX origin_;                            // start of D, relative to that of the step
  VectorX direction_;                         // D of the last step
  int negative_pivots_ = 0;                   // at the last linearisation that was solved
};

}  // namespace sinew::sim
