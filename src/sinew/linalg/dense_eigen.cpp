// The spectrum of a symmetric matrix: dense.hpp and dense_factor.hpp.
#include <Eigen/Eigenvalues>

#include "sinew/linalg/dense.hpp"
#include "sinew/linalg/dense_factor.hpp"

namespace sinew::linalg {

void SymmetricSpectrum::compute(const MatrixX& a) { solver_.compute(a); }

VectorX symmetric_eigenvalues(const MatrixX& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixX>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace sinew::linalg
