/// @file
/// From positions to what each hyperelastic element contributes, eight at a time; the equations are
/// in solid_elements.hpp.
#pragma once

#include "sinew/fem/element_kernel.hpp"
#include "sinew/fem/solid_elements.hpp"

namespace sinew::fem {

/// What a group's points have behind them, from ElementHistory; nulls without.
struct PointHistory {
  const LaneRow* carried = nullptr;  ///< (batch, point, 6): what earlier strain adds to the stress
  double factor = 1.0;               ///< of the law's isochoric part beside it
  const LaneRow* peak = nullptr;     ///< (batch, point): largest energy so far, Pa
};

/// Where a group's batches write. Record arrays are 64-byte aligned.
struct SolidOutput {
  double* forces;  ///< four doubles a node of an element
  double* blocks;  ///< kSolidBlock doubles a pair of nodes; not touched for Tangent::none
  double* energy;  ///< one a batch of this group, J
  const double* patch_ratio = nullptr;  ///< Jm of all patches of the body; read
  double* spread = nullptr;             ///< 16 doubles a slot of a patch; see sum_rows()
  PointHistory history = {};            ///< of this group
  /// (n, 4) m, where the body was before its last motion, or null. The tangent then has the
  /// pressure p0 + kappa d(Jm), linearised from there, in its part p d(cof F)/dF: Newton's method
  /// on displacements and pressures (u, p), with p condensed out of each iteration. An iteration
  /// that turns an element by theta leaves kappa theta^2/2 in its true pressure, which the next
  /// takes away, but which would make the tangent useless where kappa is large (Magisano,
  /// Leonetti, Garcea, Comput. Methods Appl. Mech. Engng 313 (2017) 986, for all stresses).
  const double* start = nullptr;
};

/// Evaluates batches begin .. end-1 of a group.
/// @param group,begin,end which batches.
/// @param points (n, 4) m, positions padded to four.
/// @param tangent exact: the derivative; corotated: its projection onto the positive semi-definite
///   matrices, point by point; rates: see there. @param output where everything is written.
/// The smallest det F at a point of integration is returned, with the slot among all of the body;
/// positions that are not finite give minus infinity.
SmallestRatio evaluate_solids(const SolidGroup& group, int begin, int end, const double* points,
                              Tangent tangent, const SolidOutput& output);

/// The smallest det F alone.
SmallestRatio measure_solids(const SolidGroup& group, int begin, int end, const double* points);

/// det F of batches begin .. end-1 of linear tetrahedra.
/// @param group,begin,end which. @param points as for evaluate_solids(). @param ratios (slots,).
void volume_ratios(const SolidGroup& group, int begin, int end, const double* points,
                   double* ratios);

/// Deformation and stress of eight elements at one point of integration.
struct SolidState {
  LaneRow weight;             ///< m^3
  LaneRow deformation[3][3];  ///< F
  LaneRow piola[3][3];        ///< P, Pa, with the element's pressure
  LaneRow energy;             ///< of the law (of slow motion, softened), volumetric part too; J/m^3
  LaneRow gradient[10][3];    ///< g_a of each node, 1/m
};

/// States of a batch, one a point of integration. @param group,batch which.
/// @param points as for evaluate_solids(). @param patch_ratio Jm of the group's patches
///   (patch_ratios()), null without. @param history of the group: ElementHistory::present().
/// @param result (points,).
void state_batch(const SolidGroup& group, int batch, const double* points,
                 const double* patch_ratio, const PointHistory& history,
                 std::span<SolidState> result);

/// S~ of a batch's points, that which relaxes, and the energy of first loading
/// (element_history.hpp).
/// @param group,batch which. @param points as for evaluate_solids(). @param history of the group.
/// @param stress (6 points,) Pa: xx, yy, zz, xy, xz, yz of each. @param energy (points,) Pa.
void relaxing_stress(const SolidGroup& group, int batch, const double* points,
                     const PointHistory& history, LaneRow* stress, LaneRow* energy);

}  // namespace sinew::fem
