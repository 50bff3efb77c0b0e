/// @file
/// Work of a moving base on the body that it carries.
///
/// With free nodes f and base nodes b, M and K over all nodes, relative velocities u = v - w, where
/// w is the rigid velocity field of the base, and the equations of the free nodes
///   M_ff a_f + M_fb a_b + f_f + (C u)_f = p_f + (H^T lambda)_f,
/// the strain and kinetic energies E of the body, M_bb included, change by
///   dE/dt = v_f.(p + H^T lambda)_f - u.C u + P,
///   P = v_b.(M a)_b + v_b.f_b - w_f.(C u)_f = v_b.(M a)_b - w_f.(f + C u)_f,
/// since internal forces do no work on the rigid motion w of all nodes, so v_b.f_b = -w_f.f_f. P is
/// the power of the base, with the weight of the base nodes subtracted where that is counted as
/// stored energy. Rows on base nodes are counted with the rows (mechanics::HasBase::carried()).
#pragma once

#include <span>

#include "sinew/fem/base_carry.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::fem {

/// Adds the part v_b.(M a)_b. Call it before FemState::end_step().
/// @param state of the body. @param weights of the step. @param end gets work and power.
void count_base_inertia(const FemState& state, const mechanics::StepWeights& weights,
                        mechanics::StepEnd& end);

/// Adds the part of internal forces and weights. Call it after FemState::end_step().
/// @param state of the body. @param carry the motion of its base in the step.
/// @param force (3 free,) N, f + C u at the end of the step. @param end gets work and power.
void count_base_force(const FemState& state, const BaseCarry& carry, std::span<const double> force,
                      mechanics::StepEnd& end);

}  // namespace sinew::fem
