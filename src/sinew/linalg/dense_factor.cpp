#include "sinew/linalg/dense_factor.hpp"

namespace sinew::linalg {

void LuFactor::compute(const MatrixX& a) { lu_.compute(a); }

void LuFactor::solve(const Eigen::Ref<const VectorX>& b, Eigen::Ref<VectorX> x) const {
  x = lu_.solve(b);
}

void LuFactor::solve_transposed(const Eigen::Ref<const VectorX>& b, Eigen::Ref<VectorX> x) const {
  x = lu_.transpose().solve(b);
}

void LuFactor::solve_columns(const Eigen::Ref<const MatrixX>& b, Eigen::Ref<MatrixX> x) const {
  // Eigen takes the address of the first entry, which must exist.
  if (b.size() == 0) {
    x = b;
  } else {
    x = lu_.solve(b);
  }
}

bool LuFactor::is_singular() const {
  constexpr double kRounding = 1e-12;
  return !(lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > kRounding);
}

bool CholeskyFactor::compute(const MatrixX& a) {
  llt_.compute(a);
  return llt_.info() == Eigen::Success;
}

void CholeskyFactor::solve(const Eigen::Ref<const VectorX>& b, Eigen::Ref<VectorX> x) const {
  x = b;
  llt_.solveInPlace(x);
}

void CholeskyFactor::solve_columns(const Eigen::Ref<const MatrixX>& b,
                                   Eigen::Ref<MatrixX> x) const {
  x = b;
  if (x.size() > 0) llt_.solveInPlace(x);
}

void SymmetricPivots::compute(const MatrixX& a) {
  ldlt_.compute(a);
  negative_ = 0;
  vanishes_ = false;
  if ((ldlt_.vectorD().array() > 0.0).all()) return;
  spectrum_.compute(a);
  const VectorX& values = spectrum_.values();
  const double rounding = static_cast<double>(values.size()) * kEpsilon;
  negative_ = static_cast<int>((values.array() < 0.0).count());
  vanishes_ = !(values.cwiseAbs().minCoeff() > rounding * values.cwiseAbs().maxCoeff());
}

}  // namespace sinew::linalg
