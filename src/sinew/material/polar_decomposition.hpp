/// @file
/// Polar decomposition F = R S with R a proper rotation and S symmetric, eight matrices at a time.
///
/// Let s1 >= s2 >= |s3| be the singular values of F, where s3 has the sign of det F. For the
/// rotation R nearest to F, S has the eigenvalues s1, s2, s3 and the trace x = s1 + s2 + s3. From
/// the invariants
///   i1 = tr F^T F = x^2 - 2 e2,   i2 = (i1^2 - tr (F^T F)^2)/2 = e2^2 - 2 x J,   J = det F,
/// eliminating e2 = s1 s2 + s2 s3 + s3 s1 gives
///   p(x) = (x^2 - i1)^2 - 8 J x - 4 i2 = 0.
/// Its four roots are s1+s2+s3, s1-s2-s3, -s1+s2-s3, -s1-s2+s3: all are real, and x is the largest.
/// sqrt(3 i1) >= x (Cauchy-Schwarz), and p is convex above x, so Newton's method from there
/// descends to x without overshooting, also for inverted F. Since R = dx/dF, differentiating p = 0
/// gives R in closed form:
///   R = ((x^2 + i1) F - 2 F F^T F + 2 x cof F) / (2 d),
///   2 d = x (x^2 - i1) - 2 J = 2 (s1+s2)(s2+s3)(s3+s1).
/// R is undefined for d = 0 (the two smallest stretches cancel), and near it the rounding error
/// grows as 1/d^2. There, a singular value decomposition is used, one matrix at a time.
///
/// Sources: the quartic and R = dx/dF: Lin, Chitalu, Komura, "Isotropic ARAP energy using
/// Cauchy-Green invariants", ACM Trans. Graph. 41(6), 2022, sections 3-4; sign convention of
/// inverted elements: Irving, Teran, Fedkiw, "Invertible finite elements for robust simulation of
/// large deformation", SCA 2004, section 4; McAdams et al., "Computing the singular value
/// decomposition of 3x3 matrices", 2011.
#pragma once

#include "sinew/material/lanes.hpp"

namespace sinew::material {

/// Result of polar_decomposition().
struct PolarDecomposition {
  Lanes3x3 rotation;  ///< R, proper
  Lanes trace;        ///< tr S
  Lanes pair_sums;    ///< d = (s1+s2)(s2+s3)(s3+s1) = det(tr(S) I - S); >= 0
  Lanes determinant;  ///< det F
};

namespace detail {

/// The singular value decomposition is used if 2 d < kFallback (3 i1)^(3/2). The sum of the two
/// smallest stretches is then below about 1 % of the largest.
inline constexpr double kFallback = 4e-3;

/// Recomputes lane `lane` by singular value decomposition. If R is not unique, it is the one from
/// Jacobi rotations: a proper rotation, and the same for the same F.
void polar_by_svd(const Lanes3x3& f, int lane, PolarDecomposition& result);

/// Largest root of p. The iteration ends when the relative step is below 1e-8 in every lane; the
/// error is then of the order of its square. Lanes that converge slowly use the fallback.
SINEW_INLINE Lanes trace_of_stretch(const Lanes& i1, const Lanes& i2, const Lanes& determinant) {
  constexpr int kIterations = 16;
  Lanes x = square_root(3.0 * i1);
  for (int k = 0; k < kIterations; ++k) {
    const Lanes gap = x * x - i1;
    const Lanes value = gap * gap - 8.0 * determinant * x - 4.0 * i2;
    const Lanes slope = 4.0 * (gap * x - 2.0 * determinant);
    const Lanes step = value / slope;
    x -= step;
    if (!any(absolute(step) > 1e-8 * x)) break;
  }
  return x;
}

}  // namespace detail

/// Polar decomposition of eight matrices.
/// @param f F in every lane. A NaN affects only its own lane; F = 0 gives R = I.
SINEW_INLINE PolarDecomposition polar_decomposition(const Lanes3x3& f) {
  PolarDecomposition result;
  const Lanes3x3 cof = cofactor(f);
  const Lanes det = determinant(f, cof);
  const LanesSymmetric c = gram(f);
  const Lanes i1 = c.xx + c.yy + c.zz;
  // tr cof(C) = |cof F|^2, which avoids the cancellation in i1^2 - tr C^2
  Lanes i2 = lanes(0.0);
  for (const auto& row : cof.m) i2 += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
  const Lanes x = detail::trace_of_stretch(i1, i2, det);
  const Lanes twice_d = x * (x * x - i1) - 2.0 * det;
  const Lanes scale = 1.0 / twice_d;
  const Lanes3x3 fc = multiply(f, c);
  const Lanes weight_f = (x * x + i1) * scale, weight_fc = -2.0 * scale,
              weight_cof = 2.0 * x * scale;
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) {
      result.rotation[r][k] = weight_f * f[r][k] + weight_fc * fc[r][k] + weight_cof * cof[r][k];
    }
  }
  result.trace = x;
  result.pair_sums = 0.5 * twice_d;
  result.determinant = det;
  const Lanes size = 3.0 * i1;
  // negated, so that NaN (F = 0 gives 0/0) is doubtful, too
  const LaneMask doubtful =
      ~(twice_d >= detail::kFallback * size * square_root(size)) | (i1 < 1e-60);
  if (any(doubtful)) [[unlikely]] {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (doubtful[lane] != 0) detail::polar_by_svd(f, lane, result);
    }
  }
  return result;
}

}  // namespace sinew::material
