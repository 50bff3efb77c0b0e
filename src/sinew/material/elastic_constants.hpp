/// @file
/// The two constants of an isotropic elastic material, and which law turns stretch into stress.
#pragma once

#include <string>

namespace sinew::material {

/// Law of stretch (see corotational.hpp and linear.hpp for the equations).
enum class Law {
  linear,        ///< small strain; right only while rotations and stretches are small
  corotational,  ///< small strain in the frame of the rotation of F = R S; any rotation
};

/// Isotropic elastic constants.
struct ElasticConstants {
  double young_modulus = 0.0;  ///< E, Pa, > 0
  double poisson_ratio = 0.0;  ///< nu, -1 < nu < 0.5

  /// Second Lame constant (shear modulus) mu = E / (2 (1 + nu)), Pa.
  double shear_modulus() const { return young_modulus / (2.0 * (1.0 + poisson_ratio)); }
  /// First Lame constant lambda = E nu / ((1 + nu) (1 - 2 nu)), Pa. Negative when nu < 0.
  double first_lame() const {
    return young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
  }
  /// Throws Error(invalid-material) unless E > 0 is finite and -1 < nu < 0.5.
  /// @param what names the material in the message ("bodies.trunk.material").
  void validate(const std::string& what) const;
};

}  // namespace sinew::material
