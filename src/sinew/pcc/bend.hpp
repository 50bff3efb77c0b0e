/// @file
/// Kinematics of one bent segment in its own frame: transforms of points of its arc and all
/// derivatives that dynamics need, by Stumpff's functions of s = theta^2. With
/// A = (1 - cos theta)/theta = theta c_2 and B = sin(theta)/theta = c_1,
///   A' = c_1 - c_2,        A'' = theta (2 c_3 - c_2 - 2 c_4),
///   B' = theta (c_3 - c_2),  B'' = 2 c_2 - 2 c_3 - c_1.
#pragma once

#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/spatial_vector.hpp"
#include "sinew/pcc/stumpff.hpp"

namespace sinew::pcc {

/// Position of a point of the arc relative to the start of the bend, with derivatives with respect
/// to the segment's coordinates.
template <typename T>
struct BendPoint {
  Vec3<T> position;
  std::array<Vec3<T>, 3> gradient;  ///< of the position
  Vec3<T> bias;  ///< second derivative of the position in time at constant coordinate rates
};

/// Rotation of the section at a point of the arc, with derivatives.
template <typename T>
struct BendSection {
  Rotation<T> rotation;
  std::array<Vec3<T>, 3> spin;  ///< angular velocity per coordinate rate; zero for the extension
  Vec3<T> spin_bias;            ///< angular acceleration at constant coordinate rates
};

/// The bend of a segment at given coordinates and, if kMoves, rates. Otherwise biases are not set.
template <typename T, bool kMoves>
class Bend {
 public:
  /// @param segment must outlive this. @param q its coordinates. @param rate its rates; nullptr
  /// unless kMoves.
  Bend(const Segment& segment, const T* q, const T* rate) : segment_(segment), q_(q), rate_(rate) {
    squared_ = q[0] * q[0];
    if (segment.bending == Bending::spatial) squared_ += q[1] * q[1];
  }

  /// Evaluates a point of the arc. @param fraction of the arc. @param scale of the position.
  /// @param point result. @param section result, unless nullptr.
  void at(double fraction, double scale, BendPoint<T>& point, BendSection<T>* section) const {
    const T s = fraction * fraction * squared_;
    if (segment_.bending == Bending::planar) {
      planar(stumpff < kMoves ? 5 : 4 > (s), fraction, scale, point, section);
    } else {
      spatial(stumpff < kMoves ? 7 : 5 > (s), fraction, scale, point, section);
    }
  }

 private:
  template <std::size_t K>
  void planar(const std::array<T, K>& c, double fraction, double scale, BendPoint<T>& point,
              BendSection<T>* section) const {
    const double length = scale * fraction * segment_.length;
    const T angle = fraction * q_[0];
    const T zero(0.0);
    point.position = {length * (angle * c[2]), zero, length * c[1]};
    const double slope = fraction * length;
    point.gradient[0] = {slope * (c[1] - c[2]), zero, slope * (angle * (c[3] - c[2]))};
    if constexpr (kMoves) {
      const T rate = fraction * rate_[0];
      const T squared_rate = length * (rate * rate);
      point.bias = {squared_rate * (angle * (2.0 * c[3] - c[2] - 2.0 * c[4])), zero,
                    squared_rate * (2.0 * c[2] - 2.0 * c[3] - c[1])};
    }
    if (section == nullptr) return;
    const T sine = angle * c[1];
    const T one(1.0);
    section->rotation = {{c[0], zero, -sine}, {zero, one, zero}, {sine, zero, c[0]}};
    section->spin[0] = {zero, T(fraction), zero};
    if constexpr (kMoves) section->spin_bias = {zero, zero, zero};
  }

  template <std::size_t K>
  void spatial(const std::array<T, K>& c, double fraction, double scale, BendPoint<T>& point,
               BendSection<T>* section) const {
    const bool extensible = segment_.extensible;
    const double share = scale * fraction;
    T length = share * segment_.length;
    if (extensible) length += share * q_[2];
    const T u = fraction * q_[0], v = fraction * q_[1];
    // dc_k/ds.
    const auto slope = [&](std::size_t k) {
      return 0.5 * (static_cast<double>(k) * c[k + 2] - c[k + 1]);
    };
    const T c1_s = slope(1), c2_s = slope(2);
    const Vec3<T> along(u * c[2], v * c[2], c[1]);
    point.position = length * along;
    const T stretch = (2.0 * fraction) * length;
    const T plain = fraction * (length * c[2]);
    const Vec3<T> common = stretch * Vec3<T>(u * c2_s, v * c2_s, c1_s);
    point.gradient[0] = u * common;
    point.gradient[0].x += plain;
    point.gradient[1] = v * common;
    point.gradient[1].y += plain;
    if (extensible) point.gradient[2] = share * along;
    const T zero(0.0), one(1.0);
    const Vec3<T> w(-v, u, zero);
    if (section != nullptr) {
      const auto turned = [&](const Vec3<T>& x, const T& a, const T& b) {
        const Vec3<T> first = cross(w, x);
        return x + a * first + b * cross(w, first);
      };
      section->rotation = {turned({one, zero, zero}, c[1], c[2]),
                           turned({zero, one, zero}, c[1], c[2]),
                           turned({zero, zero, one}, c[1], c[2])};
      // Left Jacobian of the rotation vector w (e.g. Sola et al. 2018, eq. 145): I + c_2 w^ + c_3
      // w^2.
      section->spin[0] = turned({zero, T(fraction), zero}, c[2], c[3]);
      section->spin[1] = turned({T(-fraction), zero, zero}, c[2], c[3]);
      section->spin[2] = {zero, zero, zero};
    }
    if constexpr (kMoves) {
      // Time derivatives: s' = 2 (u u' + v v'), s'' = 2 (u'^2 + v'^2).
      const T du = fraction * rate_[0], dv = fraction * rate_[1];
      const T ds = 2.0 * (u * du + v * dv);
      const T dds = 2.0 * (du * du + dv * dv);
      const T c1_ss = 0.5 * (slope(3) - slope(2));
      const T c2_ss = 0.5 * (2.0 * slope(4) - slope(3));
      const T c2_t = c2_s * ds;
      const T c2_tt = c2_ss * (ds * ds) + c2_s * dds;
      const T c1_tt = c1_ss * (ds * ds) + c1_s * dds;
      point.bias =
          length * Vec3<T>(2.0 * (du * c2_t) + u * c2_tt, 2.0 * (dv * c2_t) + v * c2_tt, c1_tt);
      if (extensible) {
        const Vec3<T> along_t(du * c[2] + u * c2_t, dv * c[2] + v * c2_t, c1_s * ds);
        point.bias += ((2.0 * share) * rate_[2]) * along_t;
      }
      if (section == nullptr) return;
      const Vec3<T> dw(-dv, du, zero);
      const Vec3<T> swept = cross(w, dw);
      section->spin_bias =
          c2_t * swept + (slope(3) * ds) * cross(w, swept) + c[3] * cross(dw, swept);
    }
  }

  const Segment& segment_;
  const T* q_;
  const T* rate_;
  T squared_;
};

}  // namespace sinew::pcc
