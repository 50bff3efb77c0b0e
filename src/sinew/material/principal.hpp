/// @file
/// Hyperelastic laws at a deformation gradient, eight points at a time, by principal stretches;
/// works for all isotropic energies.
///
/// With C = F^T F = sum l_i^2 N_i N_i^T, n_i = F N_i / l_i, and t_i, t_ij the derivatives of psi
/// with respect to e_i = ln l_i (hyperelastic.hpp),
///   psi_i = t_i / l_i,   psi_ij = (t_ij - delta_ij t_i) / (l_i l_j),
///   P = sum psi_i n_i N_i^T,
///   dP/dF = sum_ij psi_ij (n_i N_i)(n_j N_j)
///         + sum_{i<j} x_ij/2 (n_i N_j + n_j N_i)(n_i N_j + n_j N_i)
///         + sum_{i<j} y_ij/2 (n_i N_j - n_j N_i)(n_i N_j - n_j N_i),
///   x_ij = (psi_i - psi_j)/(l_i - l_j),   y_ij = (psi_i + psi_j)/(l_i + l_j),
/// where products of tensors are dyadic. The last two lines are eigenpairs of dP/dF; the first is a
/// 3x3 matrix. For equal stretches, x_ij is the mean of psi_ii - psi_ij and psi_jj - psi_ij.
/// Clamping x, y and the eigenvalues of the 3x3 matrix at zero projects onto the positive
/// semidefinite matrices.
///
/// Long functions are not inlined and take references: inlining them into every kernel would
/// dominate the compilation time of the library, and a call costs little compared with eight
/// points.
///
/// Sources: Ogden, "Non-linear elastic deformations", 1984, section 6.1.4; Simo & Taylor, CMAME 85,
/// 1991, section 2; eigenpairs and projection: Smith, de Goes, Kim, ACM Trans. Graph. 38(1), 2019,
/// sections 4 and 5; Stomakhin et al., SCA 2012, section 3.
#pragma once

#include <array>
#include <span>

#include "sinew/material/hyperelastic.hpp"
#include "sinew/material/lanes.hpp"

namespace sinew::material {

/// Singular values and right singular vectors of F. They are valid only for det F > 0.
struct Principal {
  Lanes stretch[3];   ///< l_i, in no particular order
  Lanes3x3 axes;      ///< N_i in column i
  Lanes determinant;  ///< det F
};

namespace detail {

/// Eigendecomposition by Jacobi rotations: eigenvalues on the diagonal of c, eigenvectors in the
/// columns of v. Sweeps converge quadratically: four reach rounding for any 3x3 matrix, most need
/// three.
void diagonalise(Lanes (&c)[3][3], Lanes3x3& v);

/// x^(-1/3).
SINEW_INLINE Lanes inverse_cube_root(const Lanes& x) {
  alignas(64) double part[kLanes];
  store(part, x);
  for (double& y : part) y = std::cbrt(y);
  return 1.0 / load(part);
}

SINEW_INLINE Lanes logarithm(const Lanes& x) {
  alignas(64) double part[kLanes];
  store(part, x);
  for (double& y : part) y = std::log(y);
  return load(part);
}

}  // namespace detail

/// Principal stretches and axes. @param f F of one point.
Principal principal(const Lanes3x3& f);

/// psi, t_i and t_ij of hyperelastic.hpp in every lane.
struct LanesLogResponse {
  Lanes energy;
  Lanes first[3];
  Lanes second[3][3];
};

/// Isochoric response (for Saint Venant-Kirchhoff, the whole response). Sets only j <= i of
/// `second`.
LanesLogResponse respond(const Hyperelastic& law, const Principal& at);

/// Multiplies a response by a factor. @param response changed. @param factor of stiffness.
SINEW_INLINE void scale(LanesLogResponse& response, double factor) {
  response.energy *= factor;
  for (int i = 0; i < 3; ++i) {
    response.first[i] *= factor;
    for (int j = 0; j <= i; ++j) response.second[i][j] *= factor;
  }
}

/// Applies softening to a law W that was loaded up to W_m before. With x = (W_m - W)/w, w = m +
/// beta W_m,
///   phi = W + w/r (x erf x + (exp(-x^2) - 1)/sqrt(pi)),
///   eta = dphi/dW = 1 - erf(x)/r,   deta/dW = 2/(sqrt(pi) r w) exp(-x^2),
/// and phi = W on first loading, W >= W_m. The slope of eta jumps at W_m. A step that begins at the
/// largest strain so far therefore begins with first loading, whatever the rounding of W.
/// @param effect,peak the coefficients, and W_m.
/// @param response changed.
void soften(const MullinsEffect& effect, const Lanes& peak, LanesLogResponse& response);

/// Adds U(J) = kappa/2 (J - 1)^2 for the J of the point itself.
SINEW_INLINE void add_volumetric(LanesLogResponse& to, const Lanes& ratio, double bulk_modulus) {
  const Lanes pressure = bulk_modulus * (ratio - 1.0), stiffness = bulk_modulus * ratio;
  to.energy += 0.5 * pressure * (ratio - 1.0);
  for (int i = 0; i < 3; ++i) {
    to.first[i] += pressure * ratio;
    for (int j = 0; j <= i; ++j) to.second[i][j] += (pressure + stiffness) * ratio;
  }
}

/// Second Piola-Kirchhoff stress S = sum t_i / l_i^2 N_i N_i^T.
SINEW_INLINE LanesSymmetric second_piola(const Principal& at, const LanesLogResponse& response) {
  LanesSymmetric s{};
  for (int i = 0; i < 3; ++i) {
    const Lanes scale = response.first[i] / (at.stretch[i] * at.stretch[i]);
    const Lanes x = at.axes[0][i], y = at.axes[1][i], z = at.axes[2][i];
    s.xx += scale * x * x;
    s.yy += scale * y * y;
    s.zz += scale * z * z;
    s.xy += scale * x * y;
    s.xz += scale * x * z;
    s.yz += scale * y * z;
  }
  return s;
}

/// P = F S.
SINEW_INLINE Lanes3x3 first_piola(const Lanes3x3& f, const Principal& at,
                                  const LanesLogResponse& response) {
  return multiply(f, second_piola(at, response));
}

/// A symmetric 9x9 matrix in every lane, rows and columns 3 r + c for entry (r, c) of P and F.
struct Lanes9x9 {
  Lanes m[9][9];
};

/// Projections of dP/dF.
enum class Projection {
  none,
  positive,  ///< onto the positive semidefinite matrices
  /// The same, and independent of spins dF = W F with W skew. In the plane of two principal
  /// stretches, only
  ///   (dF_ij, dF_ji) . (l_i, l_j)/sqrt(l_i^2 + l_j^2)
  /// counts, which is proportional to the rate of the right Cauchy-Green strain there. It is used
  /// for damping, which resists strain rates, but not rotations of strained or stressed material.
  rates,
};

/// Computes dP/dF.
/// @param f,at,response of one point. @param projection of the result. @param result replaced.
void tangent(const Lanes3x3& f, const Principal& at, const LanesLogResponse& response,
             Projection projection, Lanes9x9& result);

}  // namespace sinew::material
