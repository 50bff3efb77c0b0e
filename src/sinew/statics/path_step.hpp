/// @file
/// One step of given length along a path of equilibria.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/statics/path_change.hpp"
#include "sinew/statics/path_predictor.hpp"
#include "sinew/statics/path_settings.hpp"
#include "sinew/world/held_motions.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

/// Follows the equilibria r(q, s) = b(q, s) + H^T lambda(s) = 0. A step predicts along the tangent
/// of the path (PathPredictor), and corrects in a plane normal to it (Riks, Int. J. Solids Struct.
/// 15 (1979) 529; Ramm 1981; Crisfield 1991, sec. 9.3): with m_r = A^-1 r and m_p = A^-1 dr/ds,
///   dq = m_r + ds m_p,   ds = -(D . m_r)/(D . m_p),
/// where D is the motion since the step began. A, the exact tangent, may be indefinite on the path.
/// The prediction ends where the load fraction has changed by nearly 10 % of the full load, for a
/// stiff structure passes its critical load within a small motion. A step is accepted only if the
/// correction moved it by at most half of the prediction (the error of a prediction along a smooth
/// path decreases with the square of the step, the distance to another branch does not), and if the
/// load changed by at most 10 % and is not more than 10 % beyond the full one.
///
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
  /// Run and settings must outlive it. @param run is moved. @param tolerance of the residual,
  /// relative to the loads, and of gaps, relative to the size.
  /// @param set_load applies the loads and efforts at a load fraction.
  PathStep(run::Run& run, double tolerance, std::function<void(double)> set_load)
      : run_(run), tolerance_(tolerance), set_load_(std::move(set_load)) {}

  /// Begins at another load fraction than zero, in the present equilibrium.
  void begin_at(double load_fraction) { change_.to.load_fraction = load_fraction_ = load_fraction; }
  /// Makes a step from the last point, or the start.
  /// @param length m, largest motion in any coordinate.
  /// @return the number of iterations; 0 if it failed, with the run restored.
  int take(double length);
  /// Returns to the point before the last step, which succeeded.
  void undo();
  /// From the point before the last step to the present one.
  const PathChange& change() const { return change_; }
  /// The present point of the path.
  PathPoint point() const {
    return {change_.to.load_fraction, change_.to.negative_pivots, change_.event()};
  }
  /// m, largest motion in any coordinate that the last step predicted: at most the length that was
  /// asked for, and less where the load bounds it.
  double length() const { return length_; }

 private:
  int try_length(double length);
  bool predict(const VectorX& here, const VectorX& ahead, double length);
  bool correct(const VectorX& here, const VectorX& ahead);
  PathBounds bounds(double length) const;
  void imbalance_at(double load_fraction, VectorX& imbalance);
  double gap() const;
  std::vector<law::ContactBlock> pressed() const;
  std::vector<law::HeldRow> joints(std::span<const law::ContactBlock> touching) const;
  std::vector<law::HeldRow> joints_and_sticking() const;
  void move(const VectorX& motion, double load_fraction);
  void push(std::span<const law::HeldRow> held, const VectorX& efforts);
  bool is_still() const;
  bool is_sound();
  bool is_path_point();
  bool stays_on_path() const;
  bool see(const VectorX& here, const VectorX& ahead, PathPlace& place);
  int count(const world::HeldMotions& motions, std::span<const law::ContactBlock> touching);

  run::Run& run_;
  double tolerance_;
  std::function<void(double)> set_load_;
  double load_fraction_ = 0.0;  // present position
  PathChange change_;           // of the last step; `to` is the present point
  PathPlace earlier_;           // the point before change_.from
  VectorX predicted_;           // motion
  double length_ = 0.0;
  std::vector<law::ContactBlock> touching_;  // of the problem
  VectorX moved_;                            // motion since the step began
  VectorX origin_;                           // start of D, relative to that of the step
  VectorX direction_, direction_before_;     // D of the last step, and of the one before
};

}  // namespace sinew::statics
