/// @file
/// Assembly by gathering: sums element records into blocks and nodal forces.
#pragma once

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/gather_lists.hpp"

namespace sinew::fem {

/// Writes the blocks of column visits begin .. end-1: stiffness K + mass M.
/// @param lists,pattern,begin,end the gather lists, the pattern of the matrix and the range of
///   visits.
/// @param records,solids,patch_rows,weights element records for the tangent in `weights`, blocks of
///   hyperelastic elements and rows of patches (nullptr if there are none), and the weights.
/// @param node_mass (free,) kg, lumped; nullptr if `block_mass` is given.
/// @param block_mass (blocks,) kg, consistent; nullptr if `node_mass` is given.
/// @param matrix layout of linalg::BlockPattern.
void gather_blocks(const GatherLists& lists, const linalg::BlockPattern& pattern, int begin,
                   int end, const double* records, const double* solids, const double* patch_rows,
                   const AssemblyWeights& weights, const double* node_mass,
                   const double* block_mass, double* matrix);

/// Writes the internal forces of the nodes of visits begin .. end-1.
/// @param lists,begin,end the gather lists and the range of visits.
/// @param records the force records, in vectors of four doubles (GatherLists::force_parts).
/// @param forces (3 free,) N.
void gather_forces(const GatherLists& lists, int begin, int end, const double* records,
                   double* forces);

}  // namespace sinew::fem
