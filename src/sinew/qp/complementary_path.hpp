/// @file
/// The solutions of a linear complementarity problem whose offset grows with a parameter, as a path
/// of straight edges. Knows no physics.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// The (t, z) that solve
///   y = matrix z + y_0 + t slope,   0 <= y _|_ z >= 0
/// form paths and loops without branches as long as no two entries become zero at once (Eaves, SIAM
/// Rev. 18 (1976) 1; Cottle, Pang & Stone, The Linear Complementarity Problem, 1992, sec. 4.5). On
/// an edge z_i of the entries that are held, and y_i of the others, are functions of t, and the
/// rest is zero. The edge ends where one of them, entry i, becomes zero, and its partner enters.
///
/// Where t goes on from there: let m be the Schur complement of (i, i) by the held entries without
/// i, and a their dy_i/dt where i is free; then dz_i/dt = -a/m where it is held. With s = +1 or -1
/// for the direction of t, y_i fell to zero on the one edge, s a < 0, and z_i has to rise on the
/// other, -s' a/m > 0: s' = s for m > 0, and s' = -s for m < 0. From held to free the same sentence
/// is read backwards. So t turns back in exactly those corners where the matrix is negative in the
/// direction that is let go or held, whatever else it is; for a positive semidefinite one it never
/// does.
class ComplementaryPath {
 public:
  /// @param matrix (n, n). @param slope (n,). @param held (n,). @param value (n,) >= 0, z of held
  ///   entries and y of the others at t = 0. @param blur > 0: every y is lifted by a part of it, z
  ///   likewise, no two by the same: a tie is broken so, and always alike.
  ComplementaryPath(MatrixX matrix, VectorX slope, const std::vector<char>& held, VectorX value,
                    double blur);

  /// Of t; at first +1.
  double direction() const { return direction_; }
  void reverse() { direction_ = -direction_; }
  bool is_held(Eigen::Index entry) const { return held_[static_cast<std::size_t>(entry)] != 0; }
  double value(Eigen::Index entry) const { return value_[entry]; }
  /// (n,) dz/d|t| along the edge.
  VectorX rates() const;

  /// Looks for the end of the edge: |t| to there; infinite on the last edge of a path.
  double look_ahead();
  /// Goes on along the edge. @param by of |t|, not beyond its end.
  void advance(double by);
  /// From the end of the edge that was looked for onto the next. False where none leads on: the
  /// entry that became zero cannot be moved.
  bool turn();

 private:
  void exchange(Eigen::Index entry);
  void lift(double blur);
  bool moves(Eigen::Index entry) const;

  MatrixX matrix_;  // y and z of the free and held entries over those that are zero
  VectorX slope_, value_, scale_;
  std::vector<char> held_;
  Eigen::Index next_ = -1;  // the entry that ends the edge
  double direction_ = 1.0;
};

}  // namespace sinew::qp
