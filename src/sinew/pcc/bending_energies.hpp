/// @file
/// Energies of a bending actuator as functions of its angle: exact by quadrature, or by Taylor
/// polynomials about the straight pose with bounds of their remainders.
///
/// The layer bends towards x. Its point at u = s/L is
/// p(u) = L int_0^u (sin v theta, cos v theta) dv in (x, axial), and a point of the section at
/// height h above it is p + h n, n = (-cos u theta, sin u theta).
///
/// Strain. Fibres keep lambda_2 = 1 and the silicone is incompressible, so with
/// lambda = 1 + theta h/L
///   V_s = G Phi,  Phi = L int_wall (lambda - 1/lambda)^2 / 2 dA.
/// Since (lambda - 1/lambda)^2 = 4 e^2 - 4 e^3 + 5 e^4 - 6 e^5 + ... in e = theta h/L, Phi is
/// 2 theta^2/L int h^2 dA for small angles, and E I of the beam is 4 G int h^2 dA.
///
/// Inertia. Interchanging the order of integration removes the division by theta from
/// int |dp/dtheta|^2 du = L^2 (1/(3 theta^2) + 2 (1 + cos theta)/theta^4 - 4 sin theta/theta^5)
///   = L^2 int_0^1 k(t) cos(t theta) dt,   k = 2 int_t^1 v (v - t) (1 - v) dv.
/// For a mass m with first and second moments S, J of height,
///   I = m L^2 int k cos(t theta) dt + 2 L S int k_1 sin(t theta) dt + J/3,
///   k_1 = int_t^1 u (u - t) du.
/// Gravity. The centre of the layer is L int (1 - t) (sin t theta, cos t theta) dt, and a height h
/// above it adds h int (-cos t theta, sin t theta) dt.
/// No formula divides by theta, so the straight pose needs no special case.
#pragma once

#include <array>
#include <utility>

#include "sinew/pcc/bending_parameters.hpp"

namespace sinew::pcc {

/// Value of a function of the angle, with its first two derivatives.
struct Derivatives {
  double value = 0.0, first = 0.0, second = 0.0;
};

/// The terms of the equation of motion at one angle.
struct BendingTerms {
  Derivatives strain;   ///< V_s/G, m^3
  Derivatives gravity;  ///< V_g, J, of weight minus buoyancy, relative to the height of the base
  Derivatives inertia;  ///< I, kg m^2: the kinetic energy is I theta'^2 / 2
};

/// Bounds of the remainders of a Taylor model over a range of angles.
struct TaylorBound {
  double strain = 0.0;         ///< of V_s/G, m^3
  double gravity = 0.0;        ///< of V_g, J
  double inertia = 0.0;        ///< of I, kg m^2
  double strain_slope = 0.0;   ///< of d(V_s/G)/dtheta, m^3
  double gravity_slope = 0.0;  ///< of dV_g/dtheta, N m
};

/// Evaluates the energies of an actuator. Immutable; evaluation does not allocate.
class BendingEnergies {
 public:
  /// @param parameters as accepted by check(); `order` selects polynomials or quadrature.
  explicit BendingEnergies(const BendingParameters& parameters);

  /// The terms at an angle. @param theta rad, within lowest_angle() and highest_angle().
  BendingTerms at(double theta) const { return reduced_ ? polynomials(theta) : exact(theta); }
  /// The terms by quadrature, whatever the order of the model. @param theta rad.
  BendingTerms exact(double theta) const;
  /// Remainder bounds of the polynomials; zeros for an exact model.
  /// @param lowest,highest rad, lowest <= highest.
  TaylorBound bound(double lowest, double highest) const;

  /// Lower limit of the model, rad. Backward bending compresses the far side; the limit is 0.9
  /// times the angle at which its stretch reaches 0.
  double lowest_angle() const { return lowest_; }
  double highest_angle() const { return highest_; }  ///< a full turn, rad

 private:
  static constexpr int kAlong = 16;  // exact to rounding within a full turn
  static constexpr int kAcross = 24;
  using Polynomial = std::array<double, kMaxOrder + 1>;

  // sum_i cosine[i] cos(t_i theta) + sine[i] sin(t_i theta)
  struct Waves {
    std::array<double, kAlong> cosine{}, sine{};
  };

  BendingTerms polynomials(double theta) const;
  void prepare_across(const BendingParameters& p);
  void prepare_along(const BendingParameters& p);
  void expand(int order);
  double wall_moment(int power) const;
  double coefficient(const Waves& waves, int power) const;
  std::pair<double, double> wave_bound(const Waves& waves, int order, double angle) const;
  std::pair<double, double> strain_bound(double angle) const;

  double length_, far_side_;  // far_side_: height of the section, m
  double lowest_, highest_;
  bool reduced_ = false;
  int order_ = 0;
  std::array<double, kAlong> at_{};  // t_i
  Waves inertia_waves_, gravity_waves_;
  double inertia_constant_ = 0.0;
  std::array<double, 2 * kAcross> height_{}, area_{};  // of the wall's points, m, m^2
  Polynomial strain_{}, gravity_{}, inertia_{};
};

}  // namespace sinew::pcc
