/// @file
/// Kinds of mass matrix.
#pragma once

namespace sinew::fem {

/// How the mass of the elements enters the mass matrix.
enum class MassMatrix {
  lumped,      ///< diagonal: integral of rho N_i, a quarter of a tetrahedron's mass at each node
  consistent,  ///< integral of rho N_i N_j: m/20 (1 + delta_ij) for a tetrahedron
};

}  // namespace sinew::fem
