// Singular values and vectors of dense.hpp.
#include <Eigen/SVD>

#include "sinew/linalg/dense.hpp"

namespace sinew::linalg {

namespace {

using Solver = Eigen::JacobiSVD<MatrixX>;

unsigned int options(SingularVectors vectors) {
  switch (vectors) {
    case SingularVectors::thin_u:
      return Eigen::ComputeThinU;
    case SingularVectors::thin_v:
      return Eigen::ComputeThinV;
    case SingularVectors::full_u:
      return Eigen::ComputeFullU;
    case SingularVectors::full_v:
      return Eigen::ComputeFullV;
  }
  return 0;
}

}  // namespace

Svd svd(const MatrixX& a, SingularVectors vectors) {
  const Solver solver(a, options(vectors));
  Svd result{solver.singularValues(), {}, {}};
  if (solver.computeU()) result.u = solver.matrixU();
  if (solver.computeV()) result.v = solver.matrixV();
  return result;
}

VectorX singular_values(const MatrixX& a) { return Solver(a).singularValues(); }

}  // namespace sinew::linalg
