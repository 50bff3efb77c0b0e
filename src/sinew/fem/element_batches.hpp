/// @file
/// Constants of linear and corotational tetrahedra in batches of eight, one array per quantity
/// (SoA).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/fem/fem_model.hpp"
#include "sinew/material/lanes.hpp"

namespace sinew::fem {

/// Eight doubles on one cache line: the memory layout of Lanes.
struct alignas(64) LaneRow {
  double value[material::kLanes];
};

/// Constants of a batch. Shape gradients g_a = grad N_a (1/m) of nodes 1..3; g_0 = -(g_1+g_2+g_3).
struct BatchConstants {
  LaneRow gradient[3][3];  ///< [a - 1][component]
  LaneRow volume;          ///< V, m^3; 0 in padding lanes
  LaneRow root;            ///< sqrt(V mu)
  LaneRow mu, lambda;      ///< Pa
};

/// Batches of tetrahedra. Slot s = 8 batch + lane. The elements of each law are in spatial order,
/// so that neighbours are close in memory; no batch mixes laws. Padding lanes repeat the last
/// element of their batch with V = 0, and nothing is gathered from them.
struct ElementBatches {
  std::vector<BatchConstants> constants;
  std::vector<std::int32_t> nodes;        ///< [batch][a][lane]: mesh node of local node a
  std::vector<std::int32_t> tetrahedron;  ///< slot -> position in mesh.tetrahedra; -1: padding
  std::vector<std::int32_t> region;       ///< slot -> position in the settings' regions
  int linear_batches = 0;                 ///< number of batches with Law::linear, which come first
  int batches() const { return static_cast<int>(constants.size()); }
};

/// Sorts the tetrahedra whose region is not hyperelastic into batches and computes their constants.
/// @param mesh,regions the elements and their materials.
/// @param region_of region of each tetrahedron of the mesh. @param weights (elements,) by which
///   their volumes are multiplied; elements of weight 0 are left out.
/// @param rank spatial rank of each node.
/// Throws Error(zero-volume, inverted-element) with the number of the tetrahedron.
ElementBatches make_element_batches(const mesh::Mesh& mesh, std::span<const MaterialRegion> regions,
                                    std::span<const std::int32_t> region_of,
                                    std::span<const double> weights,
                                    std::span<const std::int32_t> rank);

}  // namespace sinew::fem
