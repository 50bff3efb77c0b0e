/// @file
/// Hyperelastic laws at a deformation gradient, eight points at a time: one way for all isotropic
/// energies.
///
/// With C = F^T F = sum l_i^2 N_i N_i^T, n_i = F N_i / l_i, and t_i, t_ij the derivatives of psi by
/// e_i = ln l_i (hyperelastic.hpp),
///   psi_i = t_i / l_i,   psi_ij = (t_ij - delta_ij t_i) / (l_i l_j),
///   P = sum psi_i n_i N_i^T,
///   dP/dF = sum_ij psi_ij (n_i N_i)(n_j N_j)
///         + sum_{i<j} x_ij/2 (n_i N_j + n_j N_i)(n_i N_j + n_j N_i)
///         + sum_{i<j} y_ij/2 (n_i N_j - n_j N_i)(n_i N_j - n_j N_i),
///   x_ij = (psi_i - psi_j)/(l_i - l_j),   y_ij = (psi_i + psi_j)/(l_i + l_j),
/// products of tensors dyadic; the last two lines are eigenpairs of dP/dF, the first is a 3x3
/// matrix. Where stretches meet, x_ij tends to the mean of psi_ii - psi_ij and psi_jj - psi_ij.
/// Clamping x, y and the 3x3 matrix's eigenvalues at zero projects onto the positive semi-definite
/// matrices.
///
/// What is long is a function of its own, by reference: inlined into every kernel it would be most
/// of the library's time of compilation, and a call is nothing beside eight points.
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

/// F's singular values and right singular vectors; det F > 0 is assumed (see determinant).
struct Principal {
  Lanes stretch[3];   ///< l_i, in no order
  Lanes3x3 axes;      ///< N_i in column i
  Lanes determinant;  ///< det F; where it is not positive the rest has no meaning
};

namespace detail {

/// Eigenvalues on the diagonal of c, eigenvectors in the columns of v. Sweeps converge
/// quadratically: four bring any 3x3 matrix to rounding, most need three.
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

/// @param f of one point. @return see there.
Principal principal(const Lanes3x3& f);

/// psi, t_i and t_ij of hyperelastic.hpp in every lane.
struct LanesLogResponse {
  Lanes energy;
  Lanes first[3];
  Lanes second[3][3];
};

/// The isochoric part (all of Saint Venant-Kirchhoff) at given stretches; only j <= i of `second`.
LanesLogResponse respond(const Hyperelastic& law, const Principal& at);

/// A law so many times as stiff. @param response changed. @param factor how many.
SINEW_INLINE void scale(LanesLogResponse& response, double factor) {
  response.energy *= factor;
  for (int i = 0; i < 3; ++i) {
    response.first[i] *= factor;
    for (int j = 0; j <= i; ++j) response.second[i][j] *= factor;
  }
}

/// Softens a law W that was strained up to W_m before: with x = (W_m - W)/w, w = m + beta W_m,
///   phi = W + w/r (x erf x + (exp(-x^2) - 1)/sqrt(pi)),
///   eta = dphi/dW = 1 - erf(x)/r,   deta/dW = 2/(sqrt(pi) r w) exp(-x^2),
/// and phi = W on first loading, W >= W_m. The slope of eta jumps there: a step that begins at the
/// largest strain so far begins with first loading, whatever rounding makes of W. @param
/// effect,peak its numbers, and W_m.
/// @param response changed.
void soften(const MullinsEffect& effect, const Lanes& peak, LanesLogResponse& response);

/// Adds U(J) = kappa/2 (J - 1)^2 of the point's own J.
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

/// What is made of dP/dF.
enum class Projection {
  none,
  positive,  ///< projected onto the positive semi-definite matrices
  /// That, and blind to spins dF = W F, W skew: in the plane of two principal stretches,
  ///   (dF_ij, dF_ji) . (l_i, l_j)/sqrt(l_i^2 + l_j^2) alone counts,
  /// which is the rate of the right Cauchy-Green strain there but for a factor. What a rate of
  /// strain is resisted with: turns of strained and stressed material cost nothing.
  rates,
};

/// dP/dF.
/// @param f,at,response of one point. @param projection see there. @param result replaced.
void tangent(const Lanes3x3& f, const Principal& at, const LanesLogResponse& response,
             Projection projection, Lanes9x9& result);

}  // namespace sinew::material
