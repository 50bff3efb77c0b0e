/// @file
/// The two halves of a step of the midpoint rule.
#pragma once

#include <vector>

namespace sinew::step {
struct ContactBlock;
}

namespace sinew::sim {

struct Run;
class Substep;

/// Makes a step of the midpoint rule: solves the first half and repeats its motion. Bodies and
/// surfaces with a prescribed motion are placed where they are at the end. Forces of joints and
/// closed points act in the directions at the midpoint, but their constraints hold at the end of
/// the step: the first half is solved repeatedly, each time with the constraints offset by half of
/// the violation at the end, until it vanishes. For quadratic constraints, these forces do no work,
/// so neither the constraints nor the energy drift (Gonzalez, Mechanical systems subject to
/// holonomic constraints, Physica D 132 (1999) 165).
///
/// If a point slides on a surface that turns, its gap is g = n.(x_1 - x_2) at the surface points
/// that touch at that time. Its gradient is n, since x_1 - x_2 is parallel to n. A closed point
/// therefore gets the surface points and the normal at the midpoint, which are found after a first
/// solution, and its gap at the end is measured between the surfaces. With the surface points and
/// the normal at the start, the gap would be wrong by v w h^2 for a slip velocity v and an angular
/// velocity w, and the point would strike again with the velocity v w h.
class Midpoint {
 public:
  /// @param run must outlive it.
  explicit Midpoint(Run& run);
  /// Solves the first half. @param substep begun for this half. @param half s, its length.
  void solve(Substep& substep, double half);
  /// Makes the second half. Call after solve(), and Substep::end_as_midpoint() afterwards.
  /// @param substep,half as in solve().
  void carry_on(Substep& substep, double half);
  /// J: magnitude of the work of the normal forces of turned points in the last carry_on(). Their
  /// gaps did not change, so this work is spurious, an error of third order.
  double false_work() const { return false_work_; }
  /// J: what rounding may contribute to this work, since gaps are held up to a tolerance.
  double false_work_rounding() const { return false_work_rounding_; }
  /// Whether any point turned in the last solve().
  bool has_turned() const;
  /// After carry_on(): if points turned at the midpoint, gives closed points the normals at the
  /// end, along which their velocities are held. Friction turns with the normals.
  void turn_to_end();

 private:
  void place(double time);
  bool turn_points();
  double correct();
  double opening(const step::ContactBlock& block, double by_row) const;
  void measure_false_work();
  void release();

  Run& run_;
  std::vector<double> widened_;  // (rows,) m, added to the gaps of closed points
  std::vector<char> turned_;     // (rows,) normal rows of points that turn() updated
  double false_work_ = 0.0, false_work_rounding_ = 0.0;  // J
};

}  // namespace sinew::sim
