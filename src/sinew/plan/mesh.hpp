/// @file
/// Refinement of the mesh of knots of a transcription.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// Refines a mesh: divides intervals with large defects into up to four equal parts, and returns
/// the fractions of the new intervals. The defect of a method of order p scales with the power p +
/// 1 of the interval. Kinks of the torque and fast modes reduce the order to p = 3, so one of N
/// intervals with defect d is divided into ceil((N d/left)^(1/4)) parts, for the defects to add up
/// to `left` (Betts, Practical Methods for Optimal Control, 2010, sec. 4.7, also divides by the
/// order). If no interval needs division, all are halved.
/// @param fractions (intervals,) of the duration. @param defects (intervals,) >= 0, see
/// interval_defects(). @param left > 0, admissible sum of the defects.
VectorX refined(const VectorX& fractions, const VectorX& defects, double left = 0.1);

/// Time derivatives (times, columns) of sampled values, by differences of the neighbours on both
/// sides.
/// @param times (times,) s, increasing. @param values (times, columns).
MatrixX slopes(const VectorX& times, const MatrixX& values);

}  // namespace sinew::plan
