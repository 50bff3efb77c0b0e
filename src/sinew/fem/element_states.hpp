/// @file
/// Deformation and stress of every element, and reactions at the fixed nodes, for output.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::fem {

class HasMaterial;

/// States of the elements in the order of ElementList: tetrahedra, then hexahedra. Tensors are
/// means over the quadrature points of an element, weighted by volume at rest.
struct ElementStates {
  std::vector<double> volume;        ///< at rest, m^3
  std::vector<Matrix3> deformation;  ///< F = dx/dX
  std::vector<Matrix3> piola;        ///< first Piola-Kirchhoff stress P, Pa
  std::vector<Matrix3> cauchy;       ///< sigma = P F^T / det F, Pa; P for Law::linear
  /// (n, 3) N: forces of the elements and membranes on all nodes, also the fixed ones, -dU/dx.
  Points forces;
};

/// Element states of a body in its current state.
ElementStates element_states(const HasMaterial& body);

/// (n, 3) N: the sum of the forces on every node: of elements, membranes, gravity, external forces,
/// loads and rows. At rest it is zero at free nodes up to the residual, and what supports must
/// balance at the others. Inertia, damping and a tether are not included. Evaluated from the state
/// alone, not from the equation of a step.
/// @param body,states the body and its element_states().
/// @param effort (rows,) over all rows of the world, from the last step.
/// @param values of the rows of the world, as of the last step.
/// @param rows of the world. @param index position of the body in the world.
Points nodal_balance(const HasMaterial& body, const ElementStates& states,
                     std::span<const double> effort, const mechanics::RowValues& values,
                     const mechanics::RowPattern& rows, int index);

/// (n, 3) N: the support forces on fixed nodes and held coordinates, which balance the others
/// (nodal_balance()); zero elsewhere. All parameters as there.
Points reactions(const HasMaterial& body, const ElementStates& states,
                 std::span<const double> effort, const mechanics::RowValues& values,
                 const mechanics::RowPattern& rows, int index);

}  // namespace sinew::fem
