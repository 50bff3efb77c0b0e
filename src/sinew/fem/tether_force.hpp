/// @file
/// A tether's force on a finite-element body, and its stiffness.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew::fem {

class Assembly;
class FemModel;

/// Throws what mechanics::TakesForces::set_tether() does.
void check_tether(const mechanics::Tether& tether, const FemModel& elements);

/// Where it holds the body, (3,) m. @param tether checked. @param positions (n, 3) m, of all nodes.
Vector3 tether_point(const mechanics::Tether& tether, const Points& positions);

/// Adds its force. @param tether,positions see tether_point(). @param elements of the body.
/// @param right (3 free,) N, added to.
/// @return the norm of the force, N.
double pull(const mechanics::Tether& tether, const Points& positions, const FemModel& elements,
            VectorX& right);

/// A += stiffness w_a w_b I at the blocks of its nodes.
void stiffen(const mechanics::Tether& tether, const FemModel& elements, Assembly& assembly);

}  // namespace sinew::fem
