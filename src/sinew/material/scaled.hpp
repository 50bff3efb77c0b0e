/// @file
/// A law scaled to another stiffness.
#pragma once

#include "sinew/material/hyperelastic.hpp"

namespace sinew::material {

/// Multiplies all moduli of a law: isochoric and volumetric stresses and energies at a given strain
/// become `factor` times as large. Poisson's ratio, exponents, relaxation and relative softening
/// stay the same.
/// @param law to scale. @param factor > 0.
Hyperelastic scaled(Hyperelastic law, double factor);

}  // namespace sinew::material
