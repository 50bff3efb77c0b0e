/// @file
/// The exact tangent of a robot on the motions that held rows leave.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

class World;

/// A motion, and the efforts of the held rows that it takes.
struct HeldAnswer {
  VectorX motion;   ///< (all bodies' size(),) m
  VectorX efforts;  ///< (held,) N
};

/// A restricted to the motions that held rows H leave is A + H^T C^-1 H, and for C = 0 A on the
/// null space of H. Its inverse there is T = A^-1 - Y S^-1 Y^T, Y = A^-1 H^T, S = W + C; its
/// negative eigenvalues are counted by step::negative_directions().
///
/// Loads without a potential (pressure on an open surface) count by the symmetric part of their
/// tangent.
class HeldMotions {
 public:
  /// @param world linearised with the exact tangent, rows formed, and condensed. It must stay so.
  /// @param held rows of its problem.
  HeldMotions(World& world, std::vector<step::HeldRow> held);

  std::span<const step::HeldRow> rows() const { return held_; }
  /// Negative eigenvalues of the restricted tangent.
  int negative_pivots() const { return negative_; }

  /// (held,) m: how far held rows without compliance are from zero.
  VectorX gaps() const;
  /// (k, k) m/N: W = H T H^T of other rows. @param rows (k,) of the problem.
  MatrixX compliance(const std::vector<int>& rows);
  /// The motion T right. @param right,motion (all bodies' size(),) N and m.
  void solve(const VectorX& right, VectorX& motion);
  /// The motion that also closes gaps, H motion + C efforts = -gap. @param right (all bodies'
  /// size(),) N. @param gap (held,) m. @param answer overwritten.
  void solve(const VectorX& right, const VectorX& gap, HeldAnswer& answer);

 private:
  int count();
  int invert();
  void move_rows();

  World& world_;
  std::vector<step::HeldRow> held_;
  MatrixX inverse_;  // pseudo-inverse of S, (held, held); formed when it is first needed
  MatrixX moved_;    // Y, (size, held); likewise
  int negative_ = 0;
};

}  // namespace sinew::sim
