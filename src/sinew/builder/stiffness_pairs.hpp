/// @file
/// Geometric stiffness of the constraints of a model under construction.
#pragma once

namespace sinew::model {
struct ModelData;
}

namespace sinew::builder {

/// Adds rows for the stiffness pairs between two bodies, which fit into the matrix of neither.
void add_couplings(model::ModelData& data);

/// Lists the constraints with a geometric stiffness, and determines whether the geometric stiffness
/// used in time steps extends the pattern of a body. Call after BodyModel::finish().
void list_geometric_stiffness(model::ModelData& data);

}  // namespace sinew::builder
