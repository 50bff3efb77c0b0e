/// @file
/// Patches of linear tetrahedra that share one dilatation and therefore do not lock volumetrically.
///
/// The dilatation of a patch p is the mean over its members, weighted by volume at rest:
///   Jm_p = sum_e V_e J_e / V_p,   V_p = sum_e V_e,
///   U = sum_e V_e psi_iso(F_e) + sum_p V_p kappa/2 (Jm_p - 1)^2
///     + sum_e V_e kappa'/2 (J_e - Jm_p)^2,   kappa' = own_bulk_modulus(),
/// Forces and stiffness are those of an element with the quadrature points e (solid_elements.hpp):
/// p_e = kappa (Jm_p - 1) + kappa' (J_e - Jm_p), and
///   K += (kappa - kappa')/V_p b_p b_p^T,   b_p,i = sum of V_e cof F_e g_i over the members at i,
/// is the only part that couples nodes of different members. It derives from an energy, so it is
/// symmetric.
///
/// The patches are those of de Souza Neto, Andrade Pires, Owen (Int. J. Numer. Meth. Engng 62,
/// 2005), whose F-bar form is not symmetric. This energy form is the mean dilatation method
/// (Nagtegaal, Parks, Rice, CMAME 4, 1974) applied to patches. Nodal averages (Bonet, Burton,
/// Commun. Numer. Meth. Engng 14, 1998) couple twice as many nodes (docs/materials.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::fem {

struct SolidGroup;

/// Target number of members. It gives about one patch for every two nodes of a mesh.
inline constexpr int kPatchSize = 8;

/// Patches of one group of linear tetrahedra. The members of a patch have consecutive slots.
struct ElementPatches {
  std::vector<std::int32_t> first_slot;  ///< (patches + 1,)
  std::vector<std::int32_t> of_slot;     ///< patch of each slot; padding: the last patch
  std::vector<double> volume;            ///< (patches,) V_p, m^3
  std::vector<std::int32_t> first_row;   ///< (patches + 1,) a patch has one row per node
  std::vector<NodeId> row_node;          ///< (rows,) mesh node
  std::vector<std::int32_t> first_part;  ///< (rows + 1,)
  std::vector<std::uint32_t> part;       ///< 4 slot + local node: the terms of a row
  /// Totals over the groups of the body before this one.
  std::int64_t slots_before = 0, patches_before = 0, rows_before = 0;

  bool empty() const { return volume.empty(); }
  int count() const { return static_cast<int>(volume.size()); }
  int rows() const { return static_cast<int>(row_node.size()); }
};

/// Groups elements into patches of about kPatchSize members connected by faces, grown so that each
/// patch has few nodes.
/// @param mesh of linear tetrahedra. @param elements those to be grouped, in spatial order;
///   reordered so that the members of a patch are consecutive.
/// @return (patches + 1,) where each patch begins in the new order.
std::vector<std::int32_t> group_elements(const mesh::Mesh& mesh,
                                         std::vector<std::int32_t>& elements);

/// Fills `group.patches`, except for the totals before it.
/// @param group with its slots and volumes. @param first_slot from group_elements().
void make_patches(SolidGroup& group, std::vector<std::int32_t> first_slot);

/// Modulus kappa' of an element's own dilatation relative to the shared mean, Pa; see
/// solid_elements.hpp. @param group any.
double own_bulk_modulus(const SolidGroup& group);

/// Jm_p of patches begin .. end-1.
/// @param group,begin,end which patches. @param ratios (slots,) J_e. @param result (patches,).
void average_ratios(const SolidGroup& group, int begin, int end, std::span<const double> ratios,
                    std::span<double> result);

/// Rows h_i = sqrt((kappa - kappa')/V_p) b_p,i of patches begin .. end-1, for K += h_i h_j^T.
/// @param group,begin,end which patches.
/// @param spread (slots, 4, 4) V_e cof F_e g_a, vectors padded to four; 32-byte aligned.
/// @param result (rows, 4), padding 0; 32-byte aligned.
void sum_rows(const SolidGroup& group, int begin, int end, const double* spread, double* result);

/// Jm_p of all patches, for output outside of steps; empty without patches.
/// @param group any. @param points (n, 4) m, positions padded to four.
std::vector<double> patch_ratios(const SolidGroup& group, const double* points);

}  // namespace sinew::fem
