/// @file
/// Force of a tether on a finite-element body, and its stiffness.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew::fem {

class Assembly;
class FemModel;

/// Checks a tether. Throws the errors of mechanics::TakesForces::set_tether().
void check_tether(const mechanics::Tether& tether, const FemModel& elements);

/// Point at which the tether holds the body, (3,) m.
/// @param tether checked. @param positions (n, 3) m, of all nodes.
Vector3 tether_point(const mechanics::Tether& tether, const Points& positions);

/// Adds the force of the tether. @param tether,positions see tether_point(). @param elements of the
/// body.
/// @param right (3 free,) N, added to.
/// @return the norm of the force, N.
double pull(const mechanics::Tether& tether, const Points& positions, const FemModel& elements,
            VectorX& right);

/// Adds the stiffness of the tether: A += stiffness w_a w_b I in the blocks of its nodes.
void stiffen(const mechanics::Tether& tether, const FemModel& elements, Assembly& assembly);

}  // namespace sinew::fem
