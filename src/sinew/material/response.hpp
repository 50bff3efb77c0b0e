/// @file
/// Stress and energy of the linear and corotational laws at a deformation gradient F = dx/dX, eight
/// elements at a time, and the derivative of the stress.
///
/// With F = R S (polar_decomposition.hpp):
///   corotational  psi = mu |F - R|^2 + lambda/2 (tr S - 3)^2
///                 P   = 2 mu (F - R) + lambda (tr S - 3) R
///   linear        psi = mu |e|^2 + lambda/2 (tr e)^2,   e = (F + F^T)/2 - I
///                 P   = 2 mu e + lambda tr(e) I
/// P = dpsi/dF is the first Piola-Kirchhoff stress; dR does not contribute, because F : dR = S :
/// R^T dR = 0 (symmetric times skew).
///
/// Tangents of the corotational law. With R held fixed, the tangent is the corotated small-strain
/// stiffness
///   dP = mu (dF + R dF^T R) + lambda (R : dF) R.
/// For the exact tangent, R^T dR = [w]x with (tr(S) I - S) w = axial(R^T dF - dF^T R), so that
///   dP = 2 mu dF + lambda (R : dF) R + (lambda (tr S - 3) - 2 mu) dR.
/// For dF = u b^T seen by a test gradient v a^T, with r_a = R a, r_b = R b and
/// G = tr(S) I - R S R^T, the identity [G a]x = det(G) G^-1 [a]x G^-1 turns the last term into
/// products of vectors without an inverse:
///   v . dP a = v . { 2 mu (a.b) I + lambda r_a r_b^T
///                    + kappa ((r_a . G r_b) G - (G r_b)(G r_a)^T) } u,
///   kappa = (lambda (tr S - 3) - 2 mu) / det G.
/// The linear law is the special case R = S = I (G = 2 I), for which both tangents agree.
///
/// Projected tangent. dR has three orthonormal modes, the twists T_k about the axes n_k of R S R^T:
///   dR = sum_k 2/g_k (T_k : dF) T_k,   g_k the eigenvalues of G.
/// Since R : T_k = 0, dP/dF has the eigenvalues 2 mu + 2 s/g_k for T_k, with s = lambda (tr S - 3)
/// - 2 mu, and is positive on the complement. They are negative if g_k < -s/mu (g_k > 0; Smith, de
/// Goes, Kim 2019, section 5.1), in a compressed element. Raising g_k to max(g_k, -s/mu) sets them
/// to zero, which projects dP/dF onto the positive semidefinite matrices. The result is never less
/// than dP/dF.
///
/// Sources: law and P: Sifakis & Barbic, "FEM simulation of 3D deformable solids", SIGGRAPH 2012
/// course, part I, sections 3.2 and 3.4; corotated stiffness: Muller & Gross, "Interactive virtual
/// materials", Graphics Interface 2004, section 3; derivative of the rotation: McAdams et al.,
/// "Efficient elasticity for character skinning", ACM Trans. Graph. 30(4), 2011, section 3, and
/// Smith, de Goes, Kim, "Analytic eigensystems for isotropic distortion energies", ACM Trans.
/// Graph. 38(1), 2019, section 5.1.
#pragma once

#include "sinew/material/elastic_constants.hpp"
#include "sinew/material/lanes.hpp"
#include "sinew/material/polar_decomposition.hpp"
#include "sinew/material/principal.hpp"

namespace sinew::material {

/// Lame constants in every lane, Pa.
struct LaneModuli {
  Lanes mu, lambda;
};

/// Response of a law at F.
struct Response {
  Lanes3x3 stress;    ///< P, Pa
  Lanes energy;       ///< psi, J/m^3
  Lanes3x3 rotation;  ///< R (I for the linear law)
  Lanes trace;        ///< tr S (3 for the linear law)
  Lanes pair_sums;    ///< det G (8 for the linear law)
  Lanes determinant;  ///< det F
};

/// Additional quantities of the exact tangent: G and kappa as defined at the top of this file.
struct ExactTangent {
  LanesSymmetric g;  ///< G = tr(S) I - R S R^T, dimensionless
  Lanes kappa;       ///< (lambda (tr S - 3) - 2 mu) / det G, Pa
};

/// Lower bound of det G (8 at rest). It keeps the tangent finite where the two smallest stretches
/// cancel and the rotation has no derivative.
inline constexpr double kSmallestPairSums = 1e-9;
/// Lower bound of each eigenvalue of G in the projected tangent, for stretched elements, where
/// -s/mu is negative.
inline constexpr double kSmallestPairSum = 1e-3;

template <Law law>
SINEW_INLINE Response respond(const Lanes3x3& f, const LaneModuli& moduli);

template <>
SINEW_INLINE Response respond<Law::corotational>(const Lanes3x3& f, const LaneModuli& moduli) {
  const PolarDecomposition polar = polar_decomposition(f);
  Response result;
  const Lanes growth = polar.trace - 3.0;
  const Lanes pressure = moduli.lambda * growth;
  Lanes distance = lanes(0.0);  // |F - R|^2, free of cancellation
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const Lanes difference = f[r][c] - polar.rotation[r][c];
      distance += difference * difference;
      result.stress[r][c] = 2.0 * moduli.mu * difference + pressure * polar.rotation[r][c];
    }
  }
  result.energy = moduli.mu * distance + 0.5 * pressure * growth;
  result.rotation = polar.rotation;
  result.trace = polar.trace;
  result.pair_sums = polar.pair_sums;
  result.determinant = polar.determinant;
  return result;
}

template <>
SINEW_INLINE Response respond<Law::linear>(const Lanes3x3& f, const LaneModuli& moduli) {
  Response result;
  const Lanes growth = f[0][0] + f[1][1] + f[2][2] - 3.0;
  const Lanes pressure = moduli.lambda * growth;
  Lanes square = lanes(0.0);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const Lanes strain = 0.5 * (f[r][c] + f[c][r]) - (r == c ? 1.0 : 0.0);
      square += strain * strain;
      result.stress[r][c] = 2.0 * moduli.mu * strain + (r == c ? pressure : lanes(0.0));
      result.rotation[r][c] = lanes(r == c ? 1.0 : 0.0);
    }
  }
  result.energy = moduli.mu * square + 0.5 * pressure * growth;
  result.trace = lanes(3.0);
  result.pair_sums = lanes(8.0);
  result.determinant = determinant(f, cofactor(f));
  return result;
}

/// G and kappa of the exact tangent.
template <Law law>
SINEW_INLINE ExactTangent exact_tangent(const Lanes3x3& f, const LaneModuli& moduli,
                                        const Response& at) {
  const Lanes stiffening = moduli.lambda * (at.trace - 3.0) - 2.0 * moduli.mu;
  const Lanes kappa = stiffening / maximum(at.pair_sums, lanes(kSmallestPairSums));
  if constexpr (law == Law::linear) {
    const Lanes zero = lanes(0.0), two = lanes(2.0);
    return {{two, two, two, zero, zero, zero}, kappa};
  }
  const auto left_stretch = [&](int a, int b) {  // R S R^T = F R^T
    return f[a][0] * at.rotation[b][0] + f[a][1] * at.rotation[b][1] + f[a][2] * at.rotation[b][2];
  };
  return {
      {at.trace - left_stretch(0, 0), at.trace - left_stretch(1, 1), at.trace - left_stretch(2, 2),
       -left_stretch(0, 1), -left_stretch(0, 2), -left_stretch(1, 2)},
      kappa};
}

/// G and kappa of the projected tangent: the eigenvalues of G are raised as described above.
template <Law law>
SINEW_INLINE ExactTangent projected_tangent(const Lanes3x3& f, const LaneModuli& moduli,
                                            const Response& at) {
  ExactTangent tangent = exact_tangent<law>(f, moduli, at);
  if constexpr (law == Law::linear) return tangent;
  const Lanes stiffening = moduli.lambda * (at.trace - 3.0) - 2.0 * moduli.mu;
  const Lanes least = maximum(-stiffening / moduli.mu, lanes(kSmallestPairSum));
  LanesSymmetric& g = tangent.g;
  Lanes c[3][3] = {{g.xx, g.xy, g.xz}, {g.xy, g.yy, g.yz}, {g.xz, g.yz, g.zz}};
  Lanes3x3 axes;
  detail::diagonalise(c, axes);
  Lanes values[3], product = lanes(1.0);
  for (int k = 0; k < 3; ++k) {
    values[k] = maximum(c[k][k], least);
    product *= values[k];
  }
  const auto entry = [&](int r, int s) {
    return values[0] * axes[r][0] * axes[s][0] + values[1] * axes[r][1] * axes[s][1] +
           values[2] * axes[r][2] * axes[s][2];
  };
  g = {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
  tangent.kappa = stiffening / product;
  return tangent;
}

}  // namespace sinew::material
