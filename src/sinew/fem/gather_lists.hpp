/// @file
/// Contributions to each 3x3 block of the matrix and to each nodal force. Assembly is a gather:
/// every result is written once, by one thread, with a fixed order of summation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/fem/element_batches.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/linalg/block_pattern.hpp"

namespace sinew::fem {

/// Contributions to one block from elements of equal lambda/mu, which factors out of their sum.
struct ContributionRun {
  std::int32_t end;  ///< end of its entries in `contributions`; they begin at the previous end
  double ratio;      ///< lambda / mu
};

/// The gather lists of a body. Columns of the matrix (free nodes) are visited in spatial order, and
/// the lists are in the order of visits, so that each is read once from front to back. Visit k is
/// to column column[k]; its block at position column_start[column[k]] + m of the pattern is block
/// visit block_visit[k] + m.
struct GatherLists {
  std::vector<std::int32_t> column, block_visit;
  /// 16 s + 4 a + b: element slot s couples local node a (row) with b (column).
  std::vector<std::uint32_t> contributions;
  std::vector<ContributionRun> runs;
  /// Runs of block visit q: run_start[q] .. run_start[q+1]-1; its contributions begin at
  /// contribution_start[q].
  std::vector<std::int32_t> run_start, contribution_start;
  /// (blocks,) by block visit: sum of V mu g_a . g_b over the contributions, N/m.
  std::vector<double> diagonal_stiffness;

  /// Hyperelastic parts of block visit q: solid_parts[solid_start[q] .. solid_start[q+1]-1] =
  /// 2 block + transposed. Both are empty without such elements.
  std::vector<std::int64_t> solid_start;
  std::vector<std::uint32_t> solid_parts;

  /// Products of rows of patches (element_patches.hpp) in block visit q:
  /// patch_pairs[patch_start[q] .. patch_start[q+1]-1], h_first h_second^T, with rows numbered over
  /// all groups of the body. Both are empty without patches.
  std::vector<std::int64_t> patch_start;
  std::vector<std::array<std::uint32_t, 2>> patch_pairs;

  /// Parts of the force on the node of visit k: force_parts[force_start[k] .. force_start[k+1]-1],
  /// as positions in the force records, in vectors of four doubles: 4 s + a for batches, followed
  /// by solid groups.
  std::vector<std::int32_t> force_start;
  std::vector<std::uint32_t> force_parts;
};

/// Lists the contributions to each block and to each nodal force.
/// @param elements,solids,regions,pattern the elements, their materials and the pattern of blocks.
/// @param free_index mesh node -> free number or -1.
/// @param rank spatial rank of each mesh node.
/// Throws Error(size-limit) beyond 2^28 element slots.
GatherLists make_gather_lists(const ElementBatches& elements, std::span<const SolidGroup> solids,
                              std::span<const MaterialRegion> regions,
                              std::span<const NodeId> free_index,
                              std::span<const std::int32_t> rank,
                              const linalg::BlockPattern& pattern);

}  // namespace sinew::fem
