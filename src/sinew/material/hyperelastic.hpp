/// @file
/// Isotropic hyperelastic energies in one canonical form, which includes all usual laws of rubber.
///
/// With principal stretches l_i, J = l_1 l_2 l_3 and isochoric stretches b_i = J^(-1/3) l_i,
///   psi = sum_p c_p (b_1^a_p + b_2^a_p + b_3^a_p - 3) + sum_k w_k (I - 3)^k + U(J),
///   I = b_1^2 + b_2^2 + b_3^2,   U = kappa/2 (J - 1)^2.
///
///   neo-Hookean    c = mu/2, a = 2
///   Mooney-Rivlin  C10 (I - 3) + C01 (II - 3): c = C10, a = 2 and c = C01, a = -2, since
///                  II = sum b_i^-2 with b_1 b_2 b_3 = 1
///   Yeoh           w_k = C_k0 (Rubber Chem. Technol. 66, 1993, eq. 4)
///   Ogden          sum mu_p/alpha_p (...): c = mu_p/alpha_p, a = alpha_p (Proc. R. Soc. A 326,
///                  1972, eq. 28); some codes use sum 2 mu_p/alpha_p^2 (...)
///   Arruda-Boyce   five terms of the series of the inverse Langevin function in I (J. Mech. Phys.
///                  Solids 41, 1993, eq. 27), rearranged to powers of I - 3
///
/// Saint Venant-Kirchhoff, psi = lambda/2 (tr E)^2 + mu E : E with the Green strain E, is not of
/// this form and is treated separately.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sinew::material {

/// A term c (b_1^a + b_2^a + b_3^a - 3) of the energy.
struct PowerTerm {
  double coefficient = 0.0;  ///< c, Pa
  double exponent = 2.0;     ///< a, not 0
};

/// Conventions for the moduli of an Ogden law.
enum class OgdenConvention {
  mu_over_alpha,             ///< sum mu/alpha (...), as in Ogden's paper
  two_mu_over_alpha_squared  ///< sum 2 mu/alpha^2 (...): the initial shear modulus is sum mu
};

/// Modulus and exponent of a term of an Ogden law, as published.
struct OgdenTerm {
  double modulus = 0.0;  ///< mu, Pa
  double alpha = 0.0;
};

/// One term of the Prony series of the isochoric stress, relative to the instantaneous modulus:
///   G(t)/G(0) = 1 - sum_k g_k (1 - exp(-t/tau_k)).
struct PronyTerm {
  double relative_modulus = 0.0;  ///< g, > 0; the sum of all terms is below 1
  double relaxation_time = 0.0;   ///< tau, s, > 0
};

/// Mullins effect, the softening of rubber by earlier stretch (Ogden & Roxburgh, Proc. R. Soc. A
/// 455, 1999). On unloading and reloading, the stress is eta times that of first loading,
///   eta = 1 - erf((W_m - W)/(m + beta W_m))/r,
/// where W is the energy of first loading at the current stretch, and W_m its maximum so far.
struct MullinsEffect {
  double r = 2.0;     ///< > 1
  double m = 0.0;     ///< Pa, >= 0
  double beta = 0.0;  ///< >= 0; m and beta not both 0
};

/// A hyperelastic law in the form at the top of this file, with optional viscoelasticity and
/// softening.
struct Hyperelastic {
  std::vector<PowerTerm> powers;
  std::vector<double> polynomial;  ///< w_1, w_2, ... Pa
  double bulk_modulus = 0.0;       ///< kappa, Pa; for Saint Venant-Kirchhoff at small strain
  /// If not 0: Saint Venant-Kirchhoff with this shear modulus, Pa, instead of the canonical form.
  double saint_venant_shear = 0.0;
  /// Linear viscoelasticity (fem/element_history.hpp). All other coefficients are long-term values.
  std::vector<PronyTerm> prony;
  std::optional<MullinsEffect> mullins;  ///< of the isochoric part

  /// Whether the stress depends on earlier strains.
  bool has_memory() const { return !prony.empty() || mullins.has_value(); }
  /// 1 - sum g: the ratio of long-term to instantaneous stiffness; 1 without a Prony series.
  double long_term_share() const;
  /// mu_0 = 1/2 sum c a^2 + 2 w_1 (or that of Saint Venant-Kirchhoff), Pa.
  double shear_modulus() const;
  /// E_0 = 9 kappa mu_0 / (3 kappa + mu_0), Pa.
  double young_modulus() const;
  /// nu_0 = (3 kappa - 2 mu_0) / (6 kappa + 2 mu_0).
  double poisson_ratio() const;
  /// Throws Error(invalid-material) unless all numbers are finite, exponents are not zero, mu_0 >
  /// 0, kappa > 0, and the Prony series and the softening satisfy the bounds of PronyTerm and
  /// MullinsEffect.
  /// @param what name of the material in the message.
  void validate(const std::string& what) const;
};

/// kappa = 2 mu (1 + nu) / (3 (1 - 2 nu)). @param shear mu, Pa. @param poisson_ratio nu < 0.5.
double bulk_modulus_of(double shear, double poisson_ratio);

/// Converts instantaneous to long-term coefficients, by the Prony series of the law. kappa is kept,
/// except for Saint Venant-Kirchhoff, all of which relaxes. @param law with its series.
Hyperelastic relaxed(Hyperelastic law);

// Laws from their usual coefficients, in Pa. The caller sets kappa, except for Saint
// Venant-Kirchhoff.
Hyperelastic neo_hookean(double shear_modulus);
Hyperelastic mooney_rivlin(double c10, double c01);
/// @param coefficients C10, C20, C30; trailing ones may be omitted.
Hyperelastic yeoh(const std::vector<double>& coefficients);
/// @param terms,convention as published.
Hyperelastic ogden(const std::vector<OgdenTerm>& terms, OgdenConvention convention);
/// @param shear_modulus mu of the series. @param locking_stretch lambda_m > 1, at which chains are
///   straight.
Hyperelastic arruda_boyce(double shear_modulus, double locking_stretch);
Hyperelastic saint_venant_kirchhoff(double young_modulus, double poisson_ratio);

/// Converts terms between conventions; the energy stays the same.
std::vector<OgdenTerm> convert(const std::vector<OgdenTerm>& terms, OgdenConvention from,
                               OgdenConvention to);

/// Energy and its derivatives with respect to the logarithmic stretches e_i = ln l_i.
struct LogResponse {
  double energy = 0.0;                            ///< psi, J/m^3
  std::array<double, 3> first{};                  ///< dpsi/de_i = l_i dpsi/dl_i, Pa (Kirchhoff)
  std::array<std::array<double, 3>, 3> second{};  ///< d^2 psi/de_i de_j, Pa
};

/// Evaluates a law at stretches l_i > 0. @param law,stretches the law and l_i.
/// @param volumetric whether to include U.
LogResponse respond(const Hyperelastic& law, const std::array<double, 3>& stretches,
                    bool volumetric = true);

/// Homogeneous deformations of material tests.
enum class DeformationMode {
  uniaxial,     ///< l, l^-1/2, l^-1/2
  equibiaxial,  ///< l, l, l^-2
  planar,       ///< l, 1, 1/l (pure shear)
};

/// Principal stretches of an incompressible material. @param mode,stretch the test, and l > 0.
std::array<double, 3> incompressible_stretches(DeformationMode mode, double stretch);

/// Nominal stress along l (force per undeformed area) of the incompressible material, with free
/// faces unloaded, Pa.
/// @param law,mode,stretch the law, the test, and l > 0.
double nominal_stress(const Hyperelastic& law, DeformationMode mode, double stretch);

/// The range of stretches around 1 in which an incompressible material is stable by Drucker's
/// criterion, d(Kirchhoff stress) : d(log strain) > 0 for every isochoric motion (Abaqus theory
/// manual 4.6.1).
/// @param law,mode the law and the test. @param lowest,highest ends of the search.
std::pair<double, double> stable_range(const Hyperelastic& law, DeformationMode mode,
                                       double lowest = 0.1, double highest = 10.0);

}  // namespace sinew::material
