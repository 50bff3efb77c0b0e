/// @file
/// Parts of build() that have files of their own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/description.hpp"
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

/// The faces of the mesh that a surface names, whatever but a file. Throws Error at its place.
std::vector<mesh::Face> faces_of(const SurfaceDescription& surface, const mesh::Mesh& mesh);

/// @param builder that has the bodies. @param load to be added. @param body_of finds bodies.
void add_load(sim::ModelBuilder& builder, const LoadDescription& load, const BodyOf& body_of);

/// @param builder that has the bodies. @param contact to be added. @param body_of finds bodies.
void add_contact(sim::ModelBuilder& builder, const ContactDescription& contact,
                 const BodyOf& body_of);

/// @param builder that has the bodies. @param probe to be added. @param body_of finds bodies.
void add_probe(sim::ModelBuilder& builder, const ProbeDescription& probe, const BodyOf& body_of);

}  // namespace sinew::scene
