#include "sinew/estimate/observability.hpp"

#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace sinew::estimate {

Observability observability(const MatrixX& sensitivity, const VectorX& variance,
                            const VectorX& prior) {
  const MatrixX scaled =
      variance.cwiseSqrt().cwiseInverse().asDiagonal() * sensitivity * prior.asDiagonal();
  const Eigen::JacobiSVD<MatrixX> svd(scaled, Eigen::ComputeFullV);
  Observability result{VectorX::Zero(prior.size()), svd.matrixV()};
  result.singular_values.head(svd.singularValues().size()) = svd.singularValues();
  return result;
}

// Eigenvalues ascend, so s descends.
Observability observability(const MatrixX& covariance, const VectorX& prior) {
  const auto scale = prior.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixX> own(scale * covariance * scale);
  const Eigen::ArrayXd part = own.eigenvalues().array().max(std::numeric_limits<double>::min());
  return {(part.inverse() - 1.0).max(0.0).sqrt().matrix(), own.eigenvectors()};
}

}  // namespace sinew::estimate
