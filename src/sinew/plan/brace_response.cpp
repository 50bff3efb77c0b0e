#include "sinew/plan/brace_response.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/collision/principal_frame.hpp"
#include "sinew/linalg/dense.hpp"

namespace sinew::plan {

namespace {

// Finds the peak of a mode with a damping ratio of 5 % to within 2 %.
constexpr int kFrequencies = 64;
constexpr int kDirections = 64;

/// Basis of the motions in which the held point is fixed.
MatrixX free_motions(const HeldEquilibrium& of) {
  const Eigen::Index n = of.stiffness.rows();
  if (of.held.cols() == 0) return MatrixX::Identity(n, n);
  const linalg::Svd svd = linalg::svd(of.held, linalg::SingularVectors::full_v);
  const Eigen::Index rank = (svd.values.array() > 1e-9 * std::max(svd.values[0], 1e-3)).count();
  return svd.v.rightCols(n - rank);
}

/// The real form [R -S; S R] of R + i S, which acts on [real; imaginary] parts. It has each
/// singular value of the complex matrix twice.
MatrixX real_form(const MatrixX& real, const MatrixX& imaginary) {
  MatrixX result(2 * real.rows(), 2 * real.cols());
  result << real, -imaginary, imaginary, real;
  return result;
}

/// The maximum over u of |(u - mu n)^T G|. @param real,imaginary parts of G, (3, 3).
double gain_of(const Matrix3& real, const Matrix3& imaginary, const Vector3& normal,
               double friction) {
  const Matrix3 frame = collision::tangent_frame(normal);
  double gain = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kDirections;
    const Vector3 across =
        std::cos(angle) * frame.col(1) + std::sin(angle) * frame.col(2) - friction * normal;
    gain = std::max(gain, std::hypot((real.transpose() * across).norm(),
                                     (imaginary.transpose() * across).norm()));
  }
  return gain;
}

MatrixX reduced(const MatrixX& matrix, const MatrixX& basis) {
  return basis.transpose() * matrix * basis;
}

}  // namespace

TipResponse tip_response(const HeldEquilibrium& of, double frequency, const Vector3& normal,
                         double friction) {
  const MatrixX free = free_motions(of);
  const Eigen::Index n = of.stiffness.rows(), motions = free.cols();
  const bool holds = of.held.cols() > 0;
  const MatrixX stiffness = reduced(of.stiffness, free), mass = reduced(of.mass, free),
                damping = reduced(of.damping, free), moved = of.tip * free;
  TipResponse result;
  result.stable = true;
  if (motions > 0) {
    result.mobility = static_cast<int>((linalg::singular_values(moved).array() > 1e-6).count());
    result.stable =
        linalg::symmetric_eigenvalues(0.5 * (stiffness + stiffness.transpose()))[0] > 0.0;
  }
  if (!result.stable) return result;
  const MatrixX inverse = holds ? linalg::pseudo_inverse(of.held.transpose()) : MatrixX();
  MatrixX load = MatrixX::Zero(2 * motions, 3);
  load.topRows(motions) = moved.transpose();
  for (int k = 0; k <= kFrequencies; ++k) {
    const double omega = 2.0 * std::numbers::pi * frequency * k / kFrequencies;
    MatrixX real = MatrixX::Zero(n, 3), imaginary = MatrixX::Zero(n, 3);  // of dq per force
    if (motions > 0) {
      const MatrixX answer =
          linalg::solve(real_form(stiffness - omega * omega * mass, omega * damping), load);
      real = free * answer.topRows(motions);
      imaginary = free * answer.bottomRows(motions);
    }
    const double compliance =
        linalg::singular_values(real_form(of.tip * real, of.tip * imaginary))[0];
    if (k == 0) result.compliance = compliance;
    result.peak_compliance = std::max(result.peak_compliance, compliance);
    if (!holds) continue;
    const MatrixX in_phase = of.stiffness - omega * omega * of.mass, across = omega * of.damping;
    result.friction_gain = std::max(
        result.friction_gain,
        gain_of(inverse * (in_phase * real - across * imaginary - MatrixX(of.tip.transpose())),
                inverse * (in_phase * imaginary + across * real), normal, friction));
  }
  return result;
}

}  // namespace sinew::plan
