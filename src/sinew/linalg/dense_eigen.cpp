// Spectra of symmetric matrices, of dense.hpp and dense_factor.hpp.
#include <Eigen/Eigenvalues>

#include "sinew/linalg/dense.hpp"
#include "sinew/linalg/dense_factor.hpp"

namespace sinew::linalg {

void SymmetricSpectrum::compute(const MatrixX& a) { solver_.compute(a); }

SpectralInverse spectral_inverse(const MatrixX& a) {
  constexpr double kRedundant = 1e-11;
  const SymmetricSpectrum spectrum(a);
  const double least = kRedundant * spectrum.values().cwiseAbs().maxCoeff();
  VectorX inverted = VectorX::Zero(a.rows());
  SpectralInverse result;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double value = spectrum.values()[i];
    if (std::abs(value) > least) inverted[i] = 1.0 / value;
    result.negative += value < -least ? 1 : 0;
  }
  result.inverse = spectrum.vectors() * inverted.asDiagonal() * spectrum.vectors().transpose();
  return result;
}

VectorX symmetric_eigenvalues(const MatrixX& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixX>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace sinew::linalg
