/// @file
/// The two halves of a step of the midpoint rule.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/step/impact.hpp"

namespace sinew::law {
struct ContactBlock;
}

namespace sinew::run {
struct Run;
}

namespace sinew::step {

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
///
/// A commanded motion c(t) of bodies with few coordinates is a constraint that depends on time:
/// the first half ends at the mean of the motion at the start and c at the end, corrected as for
/// joints. Its velocity 2 d/h - v_start differs from c' at the end by -h^2 c'''/6, and would do so
/// with alternating sign from step to step; Impact::hold() therefore gives it c'. The impulse that
/// this takes is part of the mean effort of the step, M (v_end - v_start)/h. A deformable body
/// would keep vibrations of its mesh, which the midpoint rule does not damp.
class Midpoint {
 public:
  /// @param run must outlive it.
  explicit Midpoint(run::Run& run);
  /// Looks at the commanded motions of a part. Call when the step's problem has the commands of its
  /// end, and its rows are those of its start. @param begin,length s, of the part.
  /// @return whether each of them is a smooth function of time in the part, is held by rows of
  /// bodies with few coordinates, and moves with the commanded velocity at the start.
  bool take_commands(double begin, double length);
  bool has_commands() const { return !commanded_.empty(); }
  /// Commands the motions of the middle. Call when the problem has the commands of the middle.
  void aim_at_middle();
  /// Whether the commanded motions are held at the end of the first half, as they were before.
  bool keeps_commands() const;
  /// The velocities at the end of the part of the commanded motions that are held there.
  std::span<const HeldRate> held_rates();
  /// Solves the first half. @param substep begun for this half. @param half s, its length.
  void solve(Substep& substep, double half);
  /// Makes the second half. Call after solve(), and Substep::end_as_midpoint() afterwards.
  /// @param substep,half as in solve(). @return false if held motions are not met at the end of the
  /// step; the state is then of no use.
  bool carry_on(Substep& substep, double half);
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
  // A commanded motion that passes through the present one.
  struct Commanded {
    std::size_t actuator = 0;
    double goal = 0.0;  // m or rad, at the end of the part
    double rate = 0.0;  // of c there
  };
  bool is_held(std::size_t actuator) const;
  bool has_few_coordinates(int row) const;
  bool take_command(std::size_t actuator, double begin, double length);
  void place(double time);
  bool turn_points();
  double correct();
  double opening(const law::ContactBlock& block, double by_row) const;
  void measure_false_work();
  void release();

  run::Run& run_;
  std::vector<double> widened_;  // (rows,) m, added to the gaps of closed points
  std::vector<char> turned_;     // (rows,) normal rows of points that turn() updated
  std::vector<Commanded> commanded_;
  std::vector<HeldRate> held_rates_;
  double false_work_ = 0.0, false_work_rounding_ = 0.0;  // J
};

}  // namespace sinew::step
