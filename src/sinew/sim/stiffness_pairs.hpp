/// @file
/// What a model under construction makes of its constraints' second derivatives.
#pragma once

namespace sinew::sim {

struct ModelData;

/// Rows for the stiffness pairs between two bodies: no body has room for what couples it to
/// another.
void add_couplings(ModelData& data);

/// Which constraints have a geometric stiffness, and whether that which joins A in every step
/// extends the pattern of a body. After BodyModel::finish().
void list_geometric_stiffness(ModelData& data);

}  // namespace sinew::sim
