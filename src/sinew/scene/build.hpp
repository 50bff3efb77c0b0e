/// @file
/// Builds a simulation model from a scene description: reads meshes, selects regions, plans models.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sinew/control/target_controller.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/description.hpp"

namespace sinew::scene {

/// A controller, ready to be attached to a simulation of the scene's model.
struct SceneController {
  std::string name;
  control::ControllerSettings settings;
};

/// A scene that is ready to run. Any number of simulations may share `model`.
struct Robot {
  SceneDescription description;
  std::shared_ptr<const model::Model> model;
  std::vector<SceneController> controllers;
  std::vector<Notice> notices;  ///< remarks and warnings, in the order of the scene
  int threads() const { return description.solver.threads; }

  /// The default controller: the first in the scene, or null if there is none.
  const SceneController* first_controller() const;
  /// The controller of this name. Throws Error(unknown-name) at `asked`.
  /// @param name,asked the name, and the location that error messages refer to.
  const SceneController& controller(const std::string& name,
                                    const Location& asked = {.item = "controller"}) const;
};

/// Builds the model and the controllers of a scene. Throws the errors of mesh reading, FemModel and
/// ModelBuilder, each with its location in the scene.
Robot build(SceneDescription description);

/// Reads and builds a scene file.
/// @param path of the scene file.
/// @param overrides assignments "path=value", applied before the scene is read (see
/// apply_override()).
Robot load(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// Reads or generates the mesh of a description, in m, and checks it. Throws what mesh::read_mesh()
/// and the shapes throw.
/// @param description,element the file or shape, and the elements that a shape is meshed with.
mesh::Mesh make_mesh(const MeshDescription& description, Element element = Element::any);

/// Reads a surface from a file, in m. Of a volume mesh, this is the boundary surface. Throws what
/// mesh::read_surface() and mesh::read_mesh() throw. @param description of a file.
mesh::Surface make_surface(const MeshDescription& description);

}  // namespace sinew::scene
