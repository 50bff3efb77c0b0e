/// @file
/// How a body's mass stands in its matrix.
#pragma once

namespace sinew::fem {

enum class MassMatrix {
  lumped,      ///< diagonal: integral of rho N_i, a quarter of a tetrahedron's mass at each node
  consistent,  ///< integral of rho N_i N_j: m/20 (1 + delta_ij) a tetrahedron
};

}  // namespace sinew::fem
