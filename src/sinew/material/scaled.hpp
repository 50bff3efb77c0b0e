/// @file
/// A law of the same shape and another stiffness.
#pragma once

#include "sinew/material/hyperelastic.hpp"

namespace sinew::material {

/// The law with all moduli multiplied: stresses and energies at a given strain, of the isochoric
/// and of the volumetric part, are `factor` times as large. Poisson's ratio, exponents, relaxation
/// and the share of softening stay.
/// @param law to scale. @param factor > 0.
Hyperelastic scaled(Hyperelastic law, double factor);

}  // namespace sinew::material
