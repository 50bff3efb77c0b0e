/// @file
/// Kernels of hyperelastic elements: from positions to element records, eight elements at a time.
/// The equations are in solid_elements.hpp.
#pragma once

#include "sinew/fem/element_kernel.hpp"
#include "sinew/fem/solid_elements.hpp"

namespace sinew::fem {

/// Strain history at the points of a group, from ElementHistory; null pointers if there is none.
struct PointHistory {
  const LaneRow* carried = nullptr;  ///< (batch, point, 6): H, the stress due to earlier strain
  double factor = 1.0;               ///< of the isochoric stress of the law, added to H
  const LaneRow* peak = nullptr;     ///< (batch, point): largest energy so far, Pa
};

/// Output arrays of a group, and inputs besides positions. Record arrays are 64-byte aligned.
struct SolidOutput {
  double* forces;  ///< four doubles per node of each element
  double* blocks;  ///< kSolidBlock doubles per pair of nodes; unused for Tangent::none
  double* energy;  ///< one per batch of this group, J
  const double* patch_ratio = nullptr;  ///< Jm of all patches of the body; input
  double* spread = nullptr;             ///< 16 doubles per slot in a patch; see sum_rows()
  PointHistory history = {};            ///< of this group
  /// (n, 4) m, positions before the last motion of the body, or null. If given, the term p d(cof
  /// F)/dF of the tangent uses the pressure p0 + kappa d(Jm), linearised there. This is Newton's
  /// method on displacements and pressures (u, p) with p condensed in each iteration. An iteration
  /// that turns an element by theta leaves an error kappa theta^2/2 in its true pressure. The next
  /// iteration removes it, but for large kappa it would make the tangent useless (Magisano,
  /// Leonetti, Garcea, Comput. Methods Appl. Mech. Engng 313 (2017) 986, for all stresses).
  const double* start = nullptr;
};

/// Evaluates batches begin .. end-1 of a group.
/// @param group,begin,end which batches.
/// @param points (n, 4) m, positions padded to four.
/// @param tangent exact: the derivative; corotated, projected: its projection onto the positive
///   semidefinite matrices, point by point; rates: see Tangent. @param output arrays to write.
/// @return the smallest det F at a quadrature point, with its slot among all slots of the body;
///   minus infinity if a position is not finite.
SmallestRatio evaluate_solids(const SolidGroup& group, int begin, int end, const double* points,
                              Tangent tangent, const SolidOutput& output);

/// Computes only the smallest det F.
SmallestRatio measure_solids(const SolidGroup& group, int begin, int end, const double* points);

/// Computes only the largest stretch (largest_stretch()), whose negative is the smallest value of
/// the result.
SmallestRatio measure_solid_stretch(const SolidGroup& group, int begin, int end,
                                    const double* points);

/// det F of batches begin .. end-1 of linear tetrahedra.
/// @param group,begin,end which. @param points as for evaluate_solids(). @param ratios (slots,).
void volume_ratios(const SolidGroup& group, int begin, int end, const double* points,
                   double* ratios);

/// Deformation and stress of eight elements at one quadrature point.
struct SolidState {
  LaneRow weight;             ///< m^3
  LaneRow deformation[3][3];  ///< F
  LaneRow piola[3][3];        ///< P, Pa, with the pressure of the element
  LaneRow energy;             ///< J/m^3, long-term, softened, with the volumetric part
  LaneRow gradient[10][3];    ///< g_a of each node, 1/m
};

/// States of a batch, one per quadrature point. @param group,batch which.
/// @param points as for evaluate_solids(). @param patch_ratio Jm of the patches of the group
///   (patch_ratios()); null without patches. @param history of the group:
///   ElementHistory::present().
/// @param result (points,).
void state_batch(const SolidGroup& group, int batch, const double* points,
                 const double* patch_ratio, const PointHistory& history,
                 std::span<SolidState> result);

/// Relaxing stress S~ at the points of a batch, and the energy of first loading
/// (element_history.hpp).
/// @param group,batch which. @param points as for evaluate_solids(). @param history of the group.
/// @param stress (6 points,) Pa: xx, yy, zz, xy, xz, yz of each. @param energy (points,) Pa.
void relaxing_stress(const SolidGroup& group, int batch, const double* points,
                     const PointHistory& history, LaneRow* stress, LaneRow* energy);

}  // namespace sinew::fem
