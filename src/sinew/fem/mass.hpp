/// @file
/// Masses of a finite-element body.
#pragma once

#include <span>
#include <vector>

#include "sinew/fem/fem_model.hpp"

namespace sinew::fem {

/// (elements,) kg of each element: rho V, scaled to the settings' total mass if that is given
/// (spread by volume when every density is 0).
/// @param settings,region_of densities and totals, and the region of each element.
/// @param volumes (elements,) m^3.
/// Throws Error(out-of-range) for a negative or non-finite density or total.
std::vector<double> element_masses(const FemModelSettings& settings,
                                   std::span<const std::int32_t> region_of,
                                   std::span<const double> volumes);

/// (n,) kg at each mesh node: the integral of rho N_a (a quarter of each tetrahedron around it),
/// for quadratic tetrahedra the diagonal of their mass matrix scaled to their mass (Hinton, Rock,
/// Zienkiewicz, Earthq. Eng. Struct. Dyn. 4, 1976), or the even share. Throws
/// Error(conflicting-keys) for even masses without a total mass, or with a consistent matrix.
VectorX lumped_masses(const mesh::Mesh& mesh, const FemModelSettings& settings,
                      std::span<const double> masses);

/// (n,) kg at each mesh node: the integral of rho N_a whatever its sign.
VectorX load_masses(const mesh::Mesh& mesh, const FemModelSettings& settings,
                    std::span<const double> masses);

/// (blocks,) kg: the consistent mass matrix, integral of rho N_i N_j; for linear tetrahedra
/// m/20 (1 + delta_ij) (Zienkiewicz, Taylor, Zhu, "The Finite Element Method", 6th ed., 2005,
/// volume 1, section 16.2 and appendix on integration over tetrahedra).
std::vector<double> consistent_mass_blocks(const mesh::Mesh& mesh,
                                           std::span<const NodeId> free_index,
                                           const linalg::BlockPattern& pattern,
                                           std::span<const double> masses);

/// (blocks,) kg: a diagonal mass matrix in the pattern's blocks. @param pattern over free nodes.
/// @param diagonal (free,) kg.
std::vector<double> diagonal_mass_blocks(const linalg::BlockPattern& pattern,
                                         std::span<const double> diagonal);

/// M += m N^T N over free nodes. Throws Error(bad-argument) where two of its nodes are not of one
/// element.
/// @param point of mass m and weights N. @param free_index mesh node -> free or -1.
/// @param pattern over free nodes. @param blocks (blocks,) kg, added to.
void add_point_mass(const PointMass& point, std::span<const NodeId> free_index,
                    const linalg::BlockPattern& pattern, std::vector<double>& blocks);

/// Entries of the mass matrix in the columns of fixed nodes that elements use, ascending.
/// @param mesh of n nodes. @param free_index mesh node -> free or -1.
/// @param masses (elements,) kg for the consistent matrix; empty: the lumped one.
/// @param lumped (n,) kg. @param points masses that come on top of either.
std::vector<SupportMass> support_masses(const mesh::Mesh& mesh, std::span<const NodeId> free_index,
                                        std::span<const double> masses, const VectorX& lumped,
                                        const std::vector<PointMass>& points);

}  // namespace sinew::fem
