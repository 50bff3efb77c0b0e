/// @file
/// From what a scene says to what runs: meshes are read, regions chosen, models planned.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"
#include "sinew/inverse/inverse_settings.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::scene {

/// A controller, ready to be attached to a simulation of the scene's model.
struct SceneController {
  std::string name;
  inverse::InverseSettings settings;
};

/// A scene made ready. Any number of simulations may share `model`.
struct Robot {
  SceneDescription description;
  std::shared_ptr<const sim::Model> model;
  std::vector<SceneController> controllers;
  std::vector<Notice> notices;  ///< what a user should know of it, in the order of the scene
  int threads() const { return description.solver.threads; }

  /// The one that steers unless another is chosen: the scene's first; null when it has none.
  const SceneController* first_controller() const;
  /// One of the scene's. Throws Error(unknown-name) at `asked`. @param name,asked which, and who
  /// asks.
  const SceneController& controller(const std::string& name,
                                    const Location& asked = {.item = "controller"}) const;
};

/// Builds everything a description names. Throws Error with the place in the scene of what is
/// wrong: what mesh reading, FemModel and ModelBuilder throw.
Robot build(SceneDescription description);

/// Reads and builds a scene file.
/// @param path the scene.
/// @param overrides "path=value" each, applied before reading (see apply_override()).
Robot load(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// The mesh that a description names, file or shape; in m, checked.
/// @param description,element the shape, and what it is to be made of. Throws what
///   mesh::read_mesh() and the shapes do.
mesh::Mesh make_mesh(const MeshDescription& description, Element element = Element::any);

/// The surface in a file that a description names, or that of its volume elements; in m. Throws
/// what mesh::read_surface() and mesh::read_mesh() do. @param description of a file.
mesh::Surface make_surface(const MeshDescription& description);

}  // namespace sinew::scene
