/// @file
/// Contacts with Coulomb friction solved by themselves: problems as the FCLIB collection has them.
#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"
#include "sinew/qp/cone_solver.hpp"

namespace sinew::qp {

struct ConeSolution {
  VectorX x;  ///< (3n,) efforts
  ConeStatus status = ConeStatus::solved;
  /// |r - P_K(r - v)|/|q|, norms over all contacts, of the symmetric part of W: the error of
  /// published benchmarks (Acary, Bremond & Huber 2018, ch. 10).
  double residual = 0.0;
  int iterations = 0;      ///< sweeps and Newton steps of the part of the problem that took most
  double asymmetry = 0.0;  ///< largest entry of W - W^T over the largest of W
  std::vector<ContactState> states;  ///< (n,)
};

/// u = W r + q with Signorini's and Coulomb's laws at every contact. Files of other simulators are
/// symmetric to some digits only: (W + W^T)/2 is used, and the asymmetry reported. Throws
/// Error(wrong-shape | out-of-range | not-finite).
/// @param w (3n, 3n), positive semidefinite; per contact the normal first, then two tangents.
/// @param q (3n,). @param friction (n,), >= 0. @param tolerance of `residual`, > 0.
/// @param start (3n,) efforts near the solution; empty: zero.
ConeSolution solve_cones(const Eigen::SparseMatrix<double>& w, const VectorX& q,
                         std::span<const double> friction, double tolerance = 1e-8,
                         std::span<const double> start = {});
ConeSolution solve_cones(const Eigen::Ref<const MatrixX>& w, const VectorX& q,
                         std::span<const double> friction, double tolerance = 1e-8,
                         std::span<const double> start = {});

}  // namespace sinew::qp
