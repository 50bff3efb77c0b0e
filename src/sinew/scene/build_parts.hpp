/// @file
/// Parts of build() that several files share.
#pragma once

#include <vector>

#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::scene {

mesh::Region region_of(const FixedRegion& fixed);

/// The faces of the mesh that a surface names, whatever but a file. Throws Error at its place.
std::vector<mesh::Face> faces_of(const SurfaceDescription& surface, const mesh::Mesh& mesh);

void add_load(sim::ModelBuilder& builder, const LoadDescription& load, int body,
              const mesh::Mesh& mesh);

}  // namespace sinew::scene
