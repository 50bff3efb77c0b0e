#include "sinew/material/principal.hpp"

#include <cmath>
#include <cstddef>

namespace sinew::material {

namespace {

using detail::diagonalise;

/// One Jacobi rotation that zeroes c[p][q]; v collects the rotations.
SINEW_INLINE void rotate(Lanes (&c)[3][3], Lanes3x3& v, int p, int q) {
  const int r = 3 - p - q;
  const Lanes off = c[p][q];
  const Lanes half = 0.5 * (c[q][q] - c[p][p]);
  const Lanes root = square_root(half * half + off * off);
  const Lanes sum = absolute(half) + root;
  // tangent of the smaller angle; no rotation if both are zero
  Lanes t = off / (sum > 0.0 ? sum : lanes(1.0));
  t = half < 0.0 ? -t : t;
  const Lanes cosine = 1.0 / square_root(1.0 + t * t);
  const Lanes sine = t * cosine;
  c[p][p] -= t * off;
  c[q][q] += t * off;
  c[p][q] = c[q][p] = lanes(0.0);
  const Lanes rp = c[r][p], rq = c[r][q];
  c[r][p] = c[p][r] = cosine * rp - sine * rq;
  c[r][q] = c[q][r] = sine * rp + cosine * rq;
  for (int k = 0; k < 3; ++k) {
    const Lanes vp = v[k][p], vq = v[k][q];
    v[k][p] = cosine * vp - sine * vq;
    v[k][q] = sine * vp + cosine * vq;
  }
}

/// x^a in every lane, x > 0.
/// @param x,log_x,a the base, its logarithm, the exponent.
SINEW_INLINE Lanes power(const Lanes& x, const Lanes& log_x, double a) {
  if (a == 2.0) return x * x;
  if (a == -2.0) return 1.0 / (x * x);
  alignas(64) double part[kLanes];
  store(part, a * log_x);
  for (double& y : part) y = std::exp(y);
  return load(part);
}

/// s = sum_i b_i^a, with t_i = b_i^a and T their sum. Its derivatives with respect to e_i = ln l_i
/// are
/// a (t_i - T/3) and a^2 (delta_ij t_i - (t_i + t_j)/3 + T/9).
struct LanesPowerSum {
  Lanes t[3], total;
  double exponent;

  /// Adds f(s): f' s_i, and f' s_ij + f'' s_i s_j.
  /// @param to,value,slope,curvature the response added to, and f with its derivatives.
  SINEW_INLINE void add_to(LanesLogResponse& to, const Lanes& value, const Lanes& slope,
                           const Lanes& curvature) const {
    Lanes first[3];
    const Lanes third = total / 3.0;
    for (int i = 0; i < 3; ++i) first[i] = exponent * (t[i] - third);
    const Lanes scale = exponent * exponent * slope;
    to.energy += value;
    for (int i = 0; i < 3; ++i) {
      to.first[i] += slope * first[i];
      for (int j = 0; j <= i; ++j) {
        Lanes second = (total / 9.0 - (t[i] + t[j]) / 3.0);
        if (i == j) second += t[i];
        to.second[i][j] += scale * second + curvature * first[i] * first[j];
      }
    }
  }
};

SINEW_INLINE void add_saint_venant(const Hyperelastic& law, const Lanes (&stretch)[3],
                                   LanesLogResponse& to) {
  const double mu = law.saint_venant_shear, lambda = law.bulk_modulus - 2.0 / 3.0 * mu;
  Lanes square[3], strain[3];
  Lanes trace = lanes(0.0), squares = lanes(0.0);
  for (int i = 0; i < 3; ++i) {
    square[i] = stretch[i] * stretch[i];
    strain[i] = 0.5 * (square[i] - 1.0);
    trace += strain[i];
    squares += strain[i] * strain[i];
  }
  to.energy += 0.5 * lambda * trace * trace + mu * squares;
  for (int i = 0; i < 3; ++i) {
    const Lanes stress = lambda * trace + 2.0 * mu * strain[i];
    to.first[i] += square[i] * stress;
    for (int j = 0; j <= i; ++j) {
      Lanes own = lambda * square[j];
      if (i == j) own += 2.0 * stress + 2.0 * mu * square[i];
      to.second[i][j] += square[i] * own;
    }
  }
}

/// Clamps the eigenvalues of a symmetric 3x3 matrix at zero.
SINEW_INLINE void project(Lanes (&m)[3][3]) {
  Lanes3x3 v;
  Lanes c[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c[i][j] = i >= j ? m[i][j] : m[j][i];
  }
  diagonalise(c, v);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      m[i][j] = lanes(0.0);
      for (int k = 0; k < 3; ++k) m[i][j] += maximum(c[k][k], lanes(0.0)) * v[i][k] * v[j][k];
    }
  }
}

}  // namespace

namespace detail {

void diagonalise(Lanes (&c)[3][3], Lanes3x3& v) {
  constexpr int kSweeps = 6;
  constexpr double kSmall = 1e-30;  // relative, of the squares of the off-diagonal entries
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) v[r][k] = lanes(r == k ? 1.0 : 0.0);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const Lanes off = c[0][1] * c[0][1] + c[0][2] * c[0][2] + c[1][2] * c[1][2];
    const Lanes on = c[0][0] * c[0][0] + c[1][1] * c[1][1] + c[2][2] * c[2][2];
    if (!any(off > kSmall * on)) break;
    rotate(c, v, 0, 1);
    rotate(c, v, 0, 2);
    rotate(c, v, 1, 2);
  }
}

}  // namespace detail

Principal principal(const Lanes3x3& f) {
  Principal result;
  const LanesSymmetric g = gram(f);
  Lanes c[3][3] = {{g.xx, g.xy, g.xz}, {g.xy, g.yy, g.yz}, {g.xz, g.yz, g.zz}};
  detail::diagonalise(c, result.axes);
  for (int i = 0; i < 3; ++i) {
    // An eigenvalue below the rounding of the largest one: a flattened element.
    result.stretch[i] = square_root(maximum(c[i][i], lanes(1e-24)));
  }
  result.determinant = determinant(f, cofactor(f));
  return result;
}

LanesLogResponse respond(const Hyperelastic& law, const Principal& at) {
  LanesLogResponse result;
  result.energy = lanes(0.0);
  for (int i = 0; i < 3; ++i) {
    result.first[i] = lanes(0.0);
    for (int j = 0; j < 3; ++j) result.second[i][j] = lanes(0.0);
  }
  if (law.saint_venant_shear > 0.0) {
    add_saint_venant(law, at.stretch, result);
    return result;
  }
  const Lanes zero = lanes(0.0);
  const Lanes scale = detail::inverse_cube_root(at.stretch[0] * at.stretch[1] * at.stretch[2]);
  Lanes logs[3] = {zero, zero, zero}, isochoric[3];
  bool needs_logs = false;  // not for exponents 2 and -2
  for (const PowerTerm& term : law.powers) needs_logs |= std::abs(term.exponent) != 2.0;
  for (int i = 0; i < 3; ++i) {
    isochoric[i] = scale * at.stretch[i];
    if (needs_logs) logs[i] = detail::logarithm(isochoric[i]);
  }
  const auto sum_of = [&](double exponent) {
    LanesPowerSum sum;
    sum.exponent = exponent;
    for (int i = 0; i < 3; ++i) sum.t[i] = power(isochoric[i], logs[i], exponent);
    sum.total = sum.t[0] + sum.t[1] + sum.t[2];
    return sum;
  };
  for (const PowerTerm& term : law.powers) {
    const LanesPowerSum sum = sum_of(term.exponent);
    sum.add_to(result, term.coefficient * (sum.total - 3.0), lanes(term.coefficient), zero);
  }
  if (!law.polynomial.empty()) {
    const LanesPowerSum sum = sum_of(2.0);
    const Lanes x = sum.total - 3.0;
    Lanes value = zero, slope = zero, curvature = zero;  // Horner's method with derivatives
    for (std::size_t k = law.polynomial.size(); k > 0; --k) {
      curvature = curvature * x + 2.0 * slope;
      slope = slope * x + value;
      value = value * x + law.polynomial[k - 1];
    }
    sum.add_to(result, x * value, value + x * slope, 2.0 * slope + x * curvature);
  }
  return result;
}

void soften(const MullinsEffect& effect, const Lanes& peak, LanesLogResponse& response) {
  constexpr double kRootPi = 1.7724538509055160273;
  constexpr double kMinWidth = 1e-9;  // Pa, for unstrained material
  constexpr double kAtPeak = 1e-9;    // x below which eta is 1
  for (int lane = 0; lane < kLanes; ++lane) {
    const double w = response.energy[lane], most = peak[lane];
    const double width = std::fmax(effect.m + effect.beta * most, kMinWidth);
    if (!(most - w > kAtPeak * width)) continue;
    const double x = (most - w) / width, bell = std::exp(-x * x);
    const double eta = 1.0 - std::erf(x) / effect.r;
    const double slope = 2.0 / (kRootPi * effect.r * width) * bell;
    response.energy[lane] += width / effect.r * (x * std::erf(x) + (bell - 1.0) / kRootPi);
    double first[3];
    for (int i = 0; i < 3; ++i) first[i] = response.first[i][lane];
    for (int i = 0; i < 3; ++i) {
      response.first[i][lane] = eta * first[i];
      for (int j = 0; j <= i; ++j) {
        Lanes& second = response.second[i][j];
        second[lane] = eta * second[lane] + slope * first[i] * first[j];
      }
    }
  }
}

void tangent(const Lanes3x3& f, const Principal& at, const LanesLogResponse& response,
             Projection projection, Lanes9x9& result) {
  const bool positive = projection != Projection::none;
  constexpr double kMeeting = 1e-4;  // relative distance below which stretches count as equal
  const Lanes zero = lanes(0.0);
  const auto& l = at.stretch;
  Lanes psi[3], second[3][3];
  for (int i = 0; i < 3; ++i) psi[i] = response.first[i] / l[i];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      Lanes value = response.second[i][j];
      if (i == j) value -= response.first[i];
      second[i][j] = second[j][i] = value / (l[i] * l[j]);
    }
  }
  // For pairs (0,1), (0,2), (1,2): (x + y)/2, for dF_ij and for dF_ji, and (x - y)/2.
  Lanes same[3], reversed[3], crossed[3];
  constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int k = 0; k < 3; ++k) {
    const int i = kPairs[k][0], j = kPairs[k][1];
    const Lanes gap = l[i] - l[j], sum = l[i] + l[j];
    const LaneMask meeting = absolute(gap) < kMeeting * sum;
    const Lanes limit = 0.5 * (second[i][i] + second[j][j]) - second[i][j];
    Lanes x = meeting ? limit : (psi[i] - psi[j]) / (meeting ? lanes(1.0) : gap);
    Lanes y = (psi[i] + psi[j]) / sum;
    if (positive) {
      x = maximum(x, zero);
      y = maximum(y, zero);
    }
    same[k] = reversed[k] = 0.5 * (x + y);
    crossed[k] = 0.5 * (x - y);
    if (projection == Projection::rates) {
      const Lanes unit = 1.0 / (l[i] * l[i] + l[j] * l[j]);
      const Lanes along = (same[k] + 2.0 * crossed[k] * l[i] * l[j] * unit) * unit;
      same[k] = along * l[i] * l[i];
      reversed[k] = along * l[j] * l[j];
      crossed[k] = along * l[i] * l[j];
    }
  }
  if (positive) project(second);
  Lanes n[3][3];  // n[i][r]: component r of n_i
  for (int i = 0; i < 3; ++i) {
    const Lanes inverse = 1.0 / l[i];
    for (int r = 0; r < 3; ++r) {
      n[i][r] =
          inverse * (f[r][0] * at.axes[0][i] + f[r][1] * at.axes[1][i] + f[r][2] * at.axes[2][i]);
    }
  }
  Lanes e[3][3][9];  // n_i N_j
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) e[i][j][3 * r + c] = n[i][r] * at.axes[c][j];
      }
    }
  }
  Lanes with[9][9];  // factor of each of the nine dyads
  for (int a = 0; a < 9; ++a) {
    for (int i = 0; i < 3; ++i) {
      with[i][a] =
          second[i][0] * e[0][0][a] + second[i][1] * e[1][1][a] + second[i][2] * e[2][2][a];
      const int p = kPairs[i][0], q = kPairs[i][1];
      with[3 + i][a] = same[i] * e[p][q][a] + crossed[i] * e[q][p][a];
      with[6 + i][a] = reversed[i] * e[q][p][a] + crossed[i] * e[p][q][a];
    }
  }
  for (int a = 0; a < 9; ++a) {
    for (int b = 0; b <= a; ++b) {
      Lanes sum = zero;
      for (int i = 0; i < 3; ++i) {
        const int p = kPairs[i][0], q = kPairs[i][1];
        sum += e[i][i][a] * with[i][b] + e[p][q][a] * with[3 + i][b] + e[q][p][a] * with[6 + i][b];
      }
      result.m[a][b] = result.m[b][a] = sum;
    }
  }
}

}  // namespace sinew::material
