/// @file
/// Stand-alone solution of contact problems with Coulomb friction, in the format of the FCLIB
/// collection.
#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"
#include "sinew/qp/cone_solver.hpp"

namespace sinew::qp {

/// Efforts and states of the contacts.
struct ConeSolution {
  VectorX x;  ///< (3n,) efforts
  ConeStatus status = ConeStatus::solved;
  /// r - P_K(r - v)|/|q|, norms over all contacts, for the symmetric part of W: the error measure
  /// of published benchmarks (Acary, Bremond & Huber 2018, ch. 10).
  double residual = 0.0;
  int iterations = 0;      ///< sweeps plus Newton steps, each of the part that took the most
  double asymmetry = 0.0;  ///< largest |entry| of W - W^T over that of W
  std::vector<ContactState> states;  ///< (n,)
};

/// Solves u = W r + q with Signorini's and Coulomb's laws at every contact. Files of other
/// simulators are symmetric to some digits only, so (W + W^T)/2 is used and the asymmetry is
/// reported. Throws Error: wrong-shape, out-of-range.
/// @param w (3n, 3n), positive semidefinite; per contact the normal first, then two tangents.
/// @param q (3n,). @param friction (n,), >= 0. @param tolerance of `residual`, > 0.
/// @param start (3n,) initial guess of the efforts; empty: zero.
ConeSolution solve_cones(const Eigen::SparseMatrix<double>& w, const VectorX& q,
                         std::span<const double> friction, double tolerance = 1e-8,
                         std::span<const double> start = {});
ConeSolution solve_cones(const Eigen::Ref<const MatrixX>& w, const VectorX& q,
                         std::span<const double> friction, double tolerance = 1e-8,
                         std::span<const double> start = {});

}  // namespace sinew::qp
