/// @file
/// Solves a block system with CHOLMOD, for comparison. CHOLMOD has GPL modules, so only tests and
/// benchmarks may use it, but not the library.
#pragma once

#include <vector>

#include <suitesparse/cholmod.h>

#include "mesh_matrices.hpp"

namespace sinew::linalg::testing {

/// A CHOLMOD factorisation of a block system.
class CholmodSolver {
 public:
  CholmodSolver(const BlockSystem& system, bool supernodal) {
    cholmod_start(&common_);
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_AMD;
    common_.postorder = 1;
    common_.supernodal = supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    const auto size = static_cast<std::size_t>(system.size());
    const std::size_t entries = 9 * static_cast<std::size_t>(system.pattern.blocks()) - size;
    matrix_ = cholmod_allocate_sparse(size, size, entries, 1, 1, -1, CHOLMOD_REAL, &common_);
    fill(system);
    factor_ = cholmod_analyze(matrix_, &common_);
  }
  ~CholmodSolver() {
    cholmod_free_sparse(&matrix_, &common_);
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  bool factorise() {
    return cholmod_factorize(matrix_, factor_, &common_) != 0 && common_.status == CHOLMOD_OK;
  }

  /// Computes A^-1 right, column by column.
  MatrixX solve(const MatrixX& right) {
    const auto rows = static_cast<std::size_t>(right.rows());
    cholmod_dense b{};
    b.nrow = rows;
    b.ncol = static_cast<std::size_t>(right.cols());
    b.nzmax = rows * b.ncol;
    b.d = rows;
    b.x = const_cast<double*>(right.data());
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor_, &b, &common_);
    const MatrixX result =
        Eigen::Map<const MatrixX>(static_cast<const double*>(x->x), right.rows(), right.cols());
    cholmod_free_dense(&x, &common_);
    return result;
  }

 private:
  void fill(const BlockSystem& system) {
    auto* const start = static_cast<int*>(matrix_->p);
    auto* const row = static_cast<int*>(matrix_->i);
    auto* const value = static_cast<double*>(matrix_->x);
    int count = 0;
    const BlockPattern& pattern = system.pattern;
    for (int j = 0; j < pattern.nodes; ++j) {
      for (int c = 0; c < 3; ++c) {
        start[3 * j + c] = count;
        for (int b = pattern.column_start[static_cast<std::size_t>(j)];
             b < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++b) {
          const int i = pattern.row[static_cast<std::size_t>(b)];
          for (int r = i == j ? c : 0; r < 3; ++r) {
            row[count] = 3 * i + r;
            value[count++] = system.matrix[static_cast<std::size_t>(kBlockStride * b + 4 * c + r)];
          }
        }
      }
    }
    start[system.size()] = count;
  }

  cholmod_common common_{};
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace sinew::linalg::testing
