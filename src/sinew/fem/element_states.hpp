/// @file
/// Deformation and stress of every element, and the forces that hold the fixed nodes: for people
/// and files, not for steps.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::fem {

class HasMaterial;

/// Elements in the order of ElementList: tetrahedra, then hexahedra. Means over an element's points
/// of integration, by their volume at rest.
struct ElementStates {
  std::vector<double> volume;        ///< at rest, m^3
  std::vector<Matrix3> deformation;  ///< F = dx/dX
  std::vector<Matrix3> piola;        ///< first Piola stress P, Pa: force by area at rest
  std::vector<Matrix3> cauchy;       ///< sigma = P F^T / det F, Pa; of linear elements P itself
  Points forces;                     ///< (n, 3) N: the elements' forces on their nodes, -dU/dx
};

/// At the body's present state.
ElementStates element_states(const HasMaterial& body);

/// (n, 3) N: what the supports put on fixed and held nodes, so that these stay in equilibrium with
/// the elements, gravity, external forces and rows; zero elsewhere. Inertia of motion is not in it:
/// fixed nodes have none.
/// @param body,states as element_states() gave them.
/// @param effort (rows,) of the world's rows, as of the last step.
/// @param directions of the world's rows (mechanics::RowValues::direction).
/// @param rows of the world. @param index the body's position in it.
Points reactions(const HasMaterial& body, const ElementStates& states,
                 std::span<const double> effort, std::span<const Vector3> directions,
                 const mechanics::RowPattern& rows, int index);

}  // namespace sinew::fem
