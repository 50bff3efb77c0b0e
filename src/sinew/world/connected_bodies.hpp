/// @file
/// Bodies that forces connect.
#pragma once

#include <span>

namespace sinew::mechanics {
class StepSystem;
}

namespace sinew::model {
class Model;
}

namespace sinew::world {

/// Marks the bodies that rows with an effort connect to marked ones, directly or through others.
/// Bodies that cannot move, such as a table, connect nothing.
/// @param model with the rows. @param systems of its bodies. @param effort (rows,) N.
/// @param marks (bodies,) 1: marked; in and out.
void mark_connected_bodies(const model::Model& model,
                           std::span<mechanics::StepSystem* const> systems,
                           std::span<const double> effort, std::span<char> marks);

}  // namespace sinew::world
