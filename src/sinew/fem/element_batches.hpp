/// @file
/// Constants of linear and corotational tetrahedra, eight to a batch, one array a quantity (SoA).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/fem/fem_model.hpp"
#include "sinew/material/lanes.hpp"

namespace sinew::fem {

/// Eight doubles on a cache line of their own: how Lanes lie in memory.
struct alignas(64) LaneRow {
  double value[material::kLanes];
};

/// A batch's constants. Shape gradients g_a = grad N_a (1/m) of nodes 1..3; g_0 = -(g_1+g_2+g_3).
struct BatchConstants {
  LaneRow gradient[3][3];  ///< [a - 1][component]
  LaneRow volume;          ///< V, m^3; 0 in lanes that only fill up a batch
  LaneRow root;            ///< sqrt(V mu)
  LaneRow mu, lambda;      ///< Pa
};

/// Slot s = 8 batch + lane. Within a law, elements are in spatial order so that neighbours lie
/// close together; no batch mixes laws. Lanes that fill up a batch repeat its last
/// element with V = 0 and nothing gathers from them.
struct ElementBatches {
  std::vector<BatchConstants> constants;
  std::vector<std::int32_t> nodes;        ///< [batch][a][lane]: mesh node of local node a
  std::vector<std::int32_t> tetrahedron;  ///< slot -> position in mesh.tetrahedra; -1: filling
  std::vector<std::int32_t> region;       ///< slot -> position in the settings' regions
  int linear_batches = 0;                 ///< the first ones follow Law::linear, the others not
  int batches() const { return static_cast<int>(constants.size()); }
};

/// Sorts the tetrahedra whose region is not hyperelastic into batches and computes their constants.
/// @param mesh,regions what is batched.
/// @param region_of region of each tetrahedron of the mesh.
/// @param rank spatial rank of each node.
/// Throws Error(zero-volume, inverted-element) naming the tetrahedron.
ElementBatches make_element_batches(const mesh::Mesh& mesh, std::span<const MaterialRegion> regions,
                                    std::span<const std::int32_t> region_of,
                                    std::span<const std::int32_t> rank);

}  // namespace sinew::fem
