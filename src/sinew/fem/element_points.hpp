/// @file
/// Deformation and stress at the quadrature points of all elements, eight elements at a time. All
/// output fields are derived from them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "sinew/material/lanes.hpp"

namespace sinew::fem {

class HasMaterial;

/// One quadrature point of eight elements. Padding lanes have element -1.
struct PointBatch {
  std::span<const std::int32_t> element;  ///< (8,) numbers in ElementList, or -1
  std::span<const std::int32_t> node;     ///< (8 nodes,) [a][lane]: mesh node of local node a
  std::size_t nodes = 4;                  ///< nodes per element
  material::Lanes weight;                 ///< quadrature weight: volume at rest, m^3
  material::Lanes3x3 deformation;         ///< F = dx/dX
  material::Lanes3x3 piola;               ///< first Piola-Kirchhoff stress P, Pa
  material::Lanes3x3 cauchy;              ///< sigma = P F^T / det F, Pa; P for Law::linear
  material::Lanes energy;                 ///< strain energy per volume at rest, J/m^3
  material::Lanes gradient[10][3];        ///< dN_a/dX of each node, 1/m
};

/// Visits all quadrature points of a body in its current state, batch by batch.
/// @param body whose elements to visit. @param visit called for each batch; its argument is valid
///   until it returns.
void visit_points(const HasMaterial& body, const std::function<void(const PointBatch&)>& visit);

}  // namespace sinew::fem
