/// @file
/// Constants of an isotropic elastic material, and the choice of its law.
#pragma once

#include <string>

namespace sinew::material {

/// Linear material laws; the equations are in response.hpp.
enum class Law {
  linear,        ///< small strain; valid only for small rotations and stretches
  corotational,  ///< small strain in the frame of the rotation R of F = R S; any rotation
};

/// Isotropic elastic constants.
struct ElasticConstants {
  double young_modulus = 0.0;  ///< E, Pa, > 0
  double poisson_ratio = 0.0;  ///< nu, -1 < nu < 0.5

  /// Second Lame constant (shear modulus) mu = E / (2 (1 + nu)), Pa.
  double shear_modulus() const { return young_modulus / (2.0 * (1.0 + poisson_ratio)); }
  /// First Lame constant lambda = E nu / ((1 + nu) (1 - 2 nu)), Pa. Negative if nu < 0.
  double first_lame() const {
    return young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
  }
  /// Throws Error(invalid-material) unless E > 0 is finite and -1 < nu < 0.5.
  /// @param what name of the material in the message, such as "bodies.trunk.material".
  void validate(const std::string& what) const;
};

}  // namespace sinew::material
