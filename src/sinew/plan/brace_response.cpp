#include "sinew/plan/brace_response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "sinew/constraint/surface.hpp"

namespace sinew::plan {

namespace {

using Complex = std::complex<double>;
using ComplexMatrix = Eigen::MatrixXcd;

// Enough that the peak of a mode with a damping of 5 % of the critical is met within 2 %.
constexpr int kFrequencies = 64;
constexpr int kDirections = 64;

/// Basis of the motions that a held point leaves.
MatrixX free_motions(const HeldEquilibrium& of) {
  const Eigen::Index n = of.stiffness.rows();
  if (of.held.cols() == 0) return MatrixX::Identity(n, n);
  const Eigen::JacobiSVD<MatrixX> svd(of.held, Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  const Eigen::Index rank = (values.array() > 1e-9 * std::max(values[0], 1e-3)).count();
  return svd.matrixV().rightCols(n - rank);
}

double largest_singular_value(const ComplexMatrix& matrix) {
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<ComplexMatrix>(
                                     matrix * matrix.adjoint(), Eigen::EigenvaluesOnly)
                                     .eigenvalues()
                                     .maxCoeff()));
}

/// max over u of |(u - mu n)^T G|.
double gain_of(const ComplexMatrix& contact, const Vector3& normal, double friction) {
  const Matrix3 frame = constraint::tangent_frame(normal);
  double gain = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kDirections;
    const Vector3 across =
        std::cos(angle) * frame.col(1) + std::sin(angle) * frame.col(2) - friction * normal;
    gain = std::max(gain, (across.transpose().cast<Complex>() * contact).norm());
  }
  return gain;
}

}  // namespace

TipResponse tip_response(const HeldEquilibrium& of, double frequency, const Vector3& normal,
                         double friction) {
  const MatrixX free = free_motions(of);
  const bool holds = of.held.cols() > 0;
  TipResponse result;
  result.stable = true;
  if (free.cols() > 0) {
    const MatrixX moved = of.tip * free;
    result.mobility = static_cast<int>(
        (Eigen::JacobiSVD<MatrixX>(moved).singularValues().array() > 1e-6).count());
    MatrixX reduced = free.transpose() * of.stiffness * free;
    reduced = 0.5 * (reduced + reduced.transpose().eval());
    result.stable =
        Eigen::SelfAdjointEigenSolver<MatrixX>(reduced, Eigen::EigenvaluesOnly).eigenvalues()[0] >
        0.0;
  }
  if (!result.stable) return result;
  const ComplexMatrix tip = of.tip.cast<Complex>();
  const MatrixX inverse =
      holds ? MatrixX(of.held.transpose()).completeOrthogonalDecomposition().pseudoInverse()
            : MatrixX();
  for (int k = 0; k <= kFrequencies; ++k) {
    const double omega = 2.0 * std::numbers::pi * frequency * k / kFrequencies;
    const ComplexMatrix dynamic = (of.stiffness - omega * omega * of.mass).cast<Complex>() +
                                  Complex(0.0, omega) * of.damping.cast<Complex>();
    ComplexMatrix answer = ComplexMatrix::Zero(of.stiffness.rows(), 3);
    if (free.cols() > 0) {
      const ComplexMatrix reduced = free.transpose() * dynamic * free;
      answer = free * reduced.partialPivLu().solve(free.transpose() * tip.transpose());
    }
    const double compliance = largest_singular_value(tip * answer);
    if (k == 0) result.compliance = compliance;
    result.peak_compliance = std::max(result.peak_compliance, compliance);
    if (holds) {
      const ComplexMatrix contact = inverse * (dynamic * answer - tip.transpose());
      result.friction_gain = std::max(result.friction_gain, gain_of(contact, normal, friction));
    }
  }
  return result;
}

}  // namespace sinew::plan
