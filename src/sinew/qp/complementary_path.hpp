/// @file
/// The solutions of a linear complementarity problem whose offset is linear in a parameter, as a
/// piecewise linear path. Independent of physics.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// The piecewise linear path of the solutions (t, z) of
///   y = matrix z + y_0 + t slope,   0 <= y _|_ z >= 0.
/// The solutions form paths and loops without branches as long as no two entries become zero at
/// once (Eaves, SIAM Rev. 18 (1976) 1; Cottle, Pang & Stone, The Linear Complementarity Problem,
/// 1992, sec. 4.5). On an edge, z_i of the held entries and y_i of the free ones are linear
/// functions of t, and the others are zero. The edge ends where one of these functions, that of
/// entry i, becomes zero; entry i then changes from held to free or back.
///
/// The direction of t on the next edge follows from m, the Schur complement of (i, i) with respect
/// to the other held entries. Let a be dy_i/dt where i is free; then dz_i/dt = -a/m where it is
/// held. Let s = +1 or -1 be the direction of t. On the one edge y_i falls to zero, s a < 0; on the
/// other z_i must rise, -s' a/m > 0. Hence s' = s for m > 0 and s' = -s for m < 0. From held to
/// free, the same argument applies backwards. So t reverses exactly at those corners at which the
/// matrix is negative in the direction that is released or held. For a positive semidefinite matrix
/// it never does.
class ComplementaryPath {
 public:
  /// @param matrix (n, n). @param slope (n,). @param held (n,) which entries are held at t = 0.
  /// @param value (n,) >= 0, z of the held entries and y of the others at t = 0.
  /// @param blur > 0. Breaks ties, deterministically: every y is raised by a multiple of it, every
  ///   z likewise, and the multiples of two entries differ.
  ComplementaryPath(MatrixX matrix, VectorX slope, const std::vector<char>& held, VectorX value,
                    double blur);

  /// Direction of t; +1 at the start.
  double direction() const { return direction_; }
  void reverse() { direction_ = -direction_; }
  bool is_held(Eigen::Index entry) const { return held_[static_cast<std::size_t>(entry)] != 0; }
  double value(Eigen::Index entry) const { return value_[entry]; }
  /// (n,) dz/d|t| along the edge.
  VectorX rates() const;

  /// Finds the end of the edge. Returns the increment of |t| up to it; infinity on the last edge of
  /// a path.
  double look_ahead();
  /// Moves along the edge. @param by increment of |t|, not beyond the end.
  void advance(double by);
  /// Moves onto the next edge at the end found by look_ahead(). Returns false if there is none: the
  /// entry that became zero cannot be exchanged, because its pivot is rounding.
  bool turn();

 private:
  void exchange(Eigen::Index entry);
  void lift(double blur);
  bool moves(Eigen::Index entry) const;

  MatrixX matrix_;  // of the free y and held z, with respect to the entries at zero
  VectorX slope_, value_, scale_;
  std::vector<char> held_;
  Eigen::Index next_ = -1;  // the entry that ends the edge
  double direction_ = 1.0;
};

}  // namespace sinew::qp
