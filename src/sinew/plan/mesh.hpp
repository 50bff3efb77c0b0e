/// @file
/// Meshes of knots: where a transcription needs more of them.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// Cuts intervals into up to four equal parts where the transcription's error is. Defects of a
/// method of order p fall with the power p + 1 of the interval; kinks of the torque and fast modes
/// leave p = 3 to count on, so that an interval with defect d of N becomes ceil((N d/left)^(1/4))
/// parts for all of them to leave `left` (Betts, Practical Methods for Optimal Control, 2010, sec.
/// 4.7, cuts by the order so too). Where none would be cut all are halved.
/// @param fractions (intervals,) of the duration. @param defects (intervals,) >= 0, of what
/// matters.
/// @param left > 0, what the defects may add up to.
/// Returns the new intervals' fractions.
VectorX refined(const VectorX& fractions, const VectorX& defects, double left = 0.1);

/// d/dt of values at times, by the line through the neighbours on both sides. (times, columns).
/// @param times (times,) s, increasing. @param values (times, columns).
MatrixX slopes(const VectorX& times, const MatrixX& values);

}  // namespace sinew::plan
