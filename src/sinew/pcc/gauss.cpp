#include "sinew/pcc/gauss.hpp"

#include <cmath>
#include <cstddef>

#include "sinew/linalg/dense_factor.hpp"

namespace sinew::pcc {

// Points are the eigenvalues of the Jacobi matrix of Legendre's polynomials; weights follow from
// the first components of its eigenvectors (Golub & Welsch, Math. Comp. 23, 1969).
std::vector<GaussPoint> gauss_points(int count) {
  MatrixX jacobi = MatrixX::Zero(count, count);
  for (int k = 1; k < count; ++k) {
    jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  }
  const linalg::SymmetricSpectrum spectrum(jacobi);
  std::vector<GaussPoint> result;
  for (int k = 0; k < count; ++k) {
    const double first = spectrum.vectors()(0, k);
    result.push_back({0.5 * (1.0 + spectrum.values()[k]), first * first});
  }
  return result;
}

}  // namespace sinew::pcc
