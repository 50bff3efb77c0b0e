/// @file
/// What rows do to bodies, and bodies to rows, one row at a time.
#pragma once

#include <cstddef>
#include <span>

#include "sinew/core/types.hpp"

namespace sinew::sim {

class World;

/// Rate of a row's motion, H v, m/s.
/// @param world its rows formed. @param row of the model, neither of a contact between surfaces.
double row_velocity(const World& world, int row);

/// (3,) m/s: the rates of a contact point's rows, beside a surface that moves by itself: of centres
/// of roundness along the normal, which stay over where a body rolls.
/// @param world its delta measured. @param contact of the model. @param point below its size().
Vector3 contact_velocity(const World& world, int contact, std::size_t point);

/// (all bodies' size(), k) columns of H^T.
/// @param world its rows formed. @param rows (k,) of the problem.
MatrixX row_forces(World& world, std::span<const int> rows);

}  // namespace sinew::sim
