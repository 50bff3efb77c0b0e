/// @file
/// From a scene's probes to those of a model; internal to this folder.
#pragma once

#include <functional>
#include <string>

#include "sinew/mesh/selection.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::scene {

/// A body of the model.
struct BuiltBody {
  int number = 0;
  const mesh::Mesh* mesh = nullptr;
};
/// By its name.
using BodyOf = std::function<BuiltBody(const std::string&)>;

/// The region as the mesh's selections know it.
mesh::Region region_of(const FixedRegion& region);

/// @param builder that has the bodies. @param probe to be added. @param body_of finds bodies.
void add_probe(sim::ModelBuilder& builder, const ProbeDescription& probe, const BodyOf& body_of);

}  // namespace sinew::scene
