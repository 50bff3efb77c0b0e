/// @file
/// Products of single rows of H with velocities and efforts.
#pragma once

#include <cstddef>
#include <span>

#include "sinew/core/types.hpp"

namespace sinew::world {

class World;

/// Rate of a row's motion, H v, m/s.
/// @param world whose rows are formed. @param row of the model, not of a contact between surfaces.
double row_velocity(const World& world, int row);

/// (3,) m/s: rates of a contact point's rows, relative to a surface with prescribed motion. Normal
/// rates refer to the centre of curvature, which stays above the contact point when a body rolls.
/// @param world whose delta is measured. @param contact of the model.
/// @param point below its size().
Vector3 contact_velocity(const World& world, int contact, std::size_t point);

/// (all bodies' size(), k) columns of H^T.
/// @param world whose rows are formed. @param rows (k,) of the problem.
MatrixX row_forces(World& world, std::span<const int> rows);

}  // namespace sinew::world
