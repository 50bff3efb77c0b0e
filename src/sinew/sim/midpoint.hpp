/// @file
/// A step of the midpoint rule, in halves.
#pragma once

#include <vector>

namespace sinew::step {
struct ContactBlock;
}

namespace sinew::sim {

struct Run;
class Substep;

/// Repeats the motion of the first half; what moves by itself goes to where it is at the end.
/// Forces of joints and closed points act in the directions that they have in the middle, but what
/// they hold is held at the end of the step: the first half is solved again, with the motions held
/// there off by half of what the end lacks, until it lacks nothing. Of constraints that are
/// quadratic such forces do no work, and motion and energy do not drift (Gonzalez, Mechanical
/// systems subject to holonomic constraints, Physica D 132 (1999) 165).
/// A point slides on a surface that turns: its gap is g = n.(x_1 - x_2) at the places that touch at
/// the time, whose gradient is n there, as x_1 - x_2 lies along n. So a closed point gets the
/// places and the normal of the middle, found again after a first solution, and the gap at the end
/// is measured between the surfaces. With the places and the normal of the start it would be off by
/// v w h^2 for a slip v and a turn w, and the point would be struck again by v w h.
class Midpoint {
 public:
  /// @param run must outlive it.
  explicit Midpoint(Run& run);
  /// The first half. @param substep that has begun it. @param half s, its length.
  void solve(Substep& substep, double half);
  /// The second one, after solve(). @param substep,half the same.
  void carry_on(Substep& substep, double half);
  /// J, then: what the normal forces of points that turned did, |f.motion|. Their gaps are what
  /// they were, so that it is an error, of third order.
  double false_work() const { return false_work_; }
  /// Points that turned have the normals of the end, along which velocities are held.
  void turn_to_end();

 private:
  void place(double time);
  bool has_turned() const;
  bool turn_points();
  double correct();
  double opening(const step::ContactBlock& block, double by_row) const;
  double work_of_turned() const;
  void release();

  Run& run_;
  std::vector<double> widened_;  // (rows,) m, gaps of closed points
  std::vector<char> turned_;     // (rows,) their normals
  double false_work_ = 0.0;      // J
};

}  // namespace sinew::sim
