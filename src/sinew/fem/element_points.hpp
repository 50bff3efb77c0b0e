/// @file
/// Deformation and stress at the integration points of all elements, of every kind and law, eight
/// elements at a time: the source of all output fields.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "sinew/material/lanes.hpp"

namespace sinew::fem {

class HasMaterial;

/// Eight elements at one point of integration each. Lanes that fill up a batch have element -1.
struct PointBatch {
  std::span<const std::int32_t> element;  ///< (8,) as ElementList numbers them, or -1
  std::span<const std::int32_t> node;     ///< (8 nodes,) [a][lane]: mesh node of local node a
  std::size_t nodes = 4;                  ///< of an element
  material::Lanes weight;                 ///< share of the volume at rest, m^3
  material::Lanes3x3 deformation;         ///< F = dx/dX
  material::Lanes3x3 piola;               ///< first Piola stress P, Pa
  material::Lanes3x3 cauchy;        ///< sigma = P F^T / det F, Pa; of linear elements P itself
  material::Lanes energy;           ///< strain energy by volume at rest, J/m^3
  material::Lanes gradient[10][3];  ///< dN_a/dX of each node, 1/m
};

/// Every point of integration of a body at its present state, batch by batch.
/// @param body whose elements. @param visit called for each; what it is given lives until it
///   returns.
void visit_points(const HasMaterial& body, const std::function<void(const PointBatch&)>& visit);

}  // namespace sinew::fem
