/// @file
/// The exact tangent of a robot, restricted to the motions that held rows permit.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/step_problem.hpp"

namespace sinew::world {

class World;

/// A motion, and the efforts of the held rows that enforce it.
struct HeldAnswer {
  VectorX motion;   ///< (all bodies' size(),) m
  VectorX efforts;  ///< (held,) N
};

/// The restriction of A to the motions that held rows H with compliance C permit is A + H^T C^-1 H;
/// for C = 0, it is A on the null space of H. Its inverse is T = A^-1 - Y S^-1 Y^T with Y = A^-1
/// H^T, S = W + C; law::negative_directions() counts its negative eigenvalues.
///
/// Of loads without a potential (pressure on an open surface), only the symmetric part of the
/// tangent counts.
class HeldMotions {
 public:
  /// @param world linearised with the exact tangent, with rows formed, and condensed; must stay so.
  /// @param held rows of its problem. Throws Error(not-in-this-version) if the solver of a body
  /// does not count negative eigenvalues.
  HeldMotions(World& world, std::vector<law::HeldRow> held);

  std::span<const law::HeldRow> rows() const { return held_; }
  /// Negative eigenvalues of the restricted tangent.
  int negative_pivots() const { return negative_; }

  /// (held,) m: deviations from zero of held rows without compliance.
  VectorX gaps() const;
  /// (k, k) m/N: W = H T H^T of other rows. @param rows (k,) of the problem.
  MatrixX compliance(const std::vector<int>& rows);
  /// The motion T right. @param right (all bodies' size(),) N.
  /// @param motion (all bodies' size(),) m.
  void solve(const VectorX& right, VectorX& motion);
  /// The motion that also closes gaps, H motion + C efforts = -gap.
  /// @param right (all bodies' size(),) N. @param gap (held,) m. @param answer overwritten.
  void solve(const VectorX& right, const VectorX& gap, HeldAnswer& answer);

 private:
  int count();
  int invert();
  void move_rows();

  World& world_;
  std::vector<law::HeldRow> held_;
  MatrixX inverse_;  // pseudo-inverse of S, (held, held); computed when first needed
  MatrixX moved_;    // Y, (size, held); likewise
  int negative_ = 0;
};

}  // namespace sinew::world
