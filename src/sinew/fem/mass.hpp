/// @file
/// Masses of a finite-element body.
#pragma once

#include <span>
#include <vector>

#include "sinew/fem/fem_model.hpp"

namespace sinew::fem {

/// (elements,) kg: mass of each element, rho V, scaled to the total mass in the settings if there
/// is one (distributed by volume if all densities are 0).
/// @param settings,region_of densities and total mass, and the region of each element.
/// @param volumes (elements,) m^3.
/// Throws Error(out-of-range) for a negative or non-finite density or total.
std::vector<double> element_masses(const FemModelSettings& settings,
                                   std::span<const std::int32_t> region_of,
                                   std::span<const double> volumes);

/// (n,) kg: lumped mass of each mesh node, the integral of rho N_a (a quarter of each adjacent
/// linear tetrahedron). For quadratic tetrahedra, the diagonal of their mass matrix scaled to their
/// mass (Hinton, Rock, Zienkiewicz, Earthq. Eng. Struct. Dyn. 4, 1976). With equal_nodal_masses,
/// the same mass at every used node. Throws Error(conflicting-keys) for equal masses without a
/// total mass, or with a consistent matrix.
VectorX lumped_masses(const mesh::Mesh& mesh, const FemModelSettings& settings,
                      std::span<const double> masses);

/// (n,) kg: the integral of rho N_a for each mesh node, of either sign.
VectorX load_masses(const mesh::Mesh& mesh, const FemModelSettings& settings,
                    std::span<const double> masses);

/// (blocks,) kg: the consistent mass matrix, integral of rho N_i N_j; for linear tetrahedra
/// m/20 (1 + delta_ij) (Zienkiewicz, Taylor, Zhu, "The Finite Element Method", 6th ed., 2005,
/// volume 1, section 16.2 and appendix on integration over tetrahedra).
std::vector<double> consistent_mass_blocks(const mesh::Mesh& mesh,
                                           std::span<const NodeId> free_index,
                                           const linalg::BlockPattern& pattern,
                                           std::span<const double> masses);

/// (blocks,) kg: a diagonal mass matrix in the blocks of a pattern. @param pattern over free nodes.
/// @param diagonal (free,) kg.
std::vector<double> diagonal_mass_blocks(const linalg::BlockPattern& pattern,
                                         std::span<const double> diagonal);

/// Adds a point mass, M += m N^T N, over free nodes. Throws Error(bad-argument) if two of its nodes
/// do not share an element.
/// @param point of mass m and weights N. @param free_index mesh node -> free or -1.
/// @param pattern over free nodes. @param blocks (blocks,) kg, added to.
void add_point_mass(const PointMass& point, std::span<const NodeId> free_index,
                    const linalg::BlockPattern& pattern, std::vector<double>& blocks);

/// Entries of the mass matrix in the columns of fixed nodes that elements use, ascending.
/// @param mesh of n nodes. @param free_index mesh node -> free or -1.
/// @param masses (elements,) kg for the consistent matrix; empty: the lumped one.
/// @param lumped (n,) kg. @param points point masses, added to either matrix.
std::vector<SupportMass> support_masses(const mesh::Mesh& mesh, std::span<const NodeId> free_index,
                                        std::span<const double> masses, const VectorX& lumped,
                                        const std::vector<PointMass>& points);

}  // namespace sinew::fem
