#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/quantity.hpp"
#include "sinew/mesh/check.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/record/hdf5_file.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"

#include "commands.hpp"

namespace sinew::cli {

namespace {

double unit_of(const std::string& unit) {
  if (unit.empty()) return 1.0;
  return parse_unit(unit, dimension::kLength, {.file = {}, .item = "--unit"});
}

void scene_info(const std::string& file) {
  const scene::Robot robot = scene::load(file);
  const auto& model = *robot.model;
  fmt::print("scene {}: {} s a step, {}, {:g} s\n", robot.description.name, model.step().time_step,
             mechanics::integrator_name(model.step().integrator), robot.description.run_duration());
  for (std::size_t i = 0; i < model.bodies().size(); ++i) {
    const auto& body = dynamic_cast<const fem::FemBodyModel&>(*model.bodies()[i]);
    fmt::print("body {}: {} nodes ({} free), {} tetrahedra, {}, {:.4g} kg\n", body.name(),
               body.mesh().node_count(), body.elements().free_count(),
               body.mesh().tetrahedra.size(),
               mesh::format_length(
                   (body.mesh().nodes.colwise().maxCoeff() - body.mesh().nodes.colwise().minCoeff())
                       .norm()) +
                   " across",
               body.elements().total_mass());
  }
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const auto* cable = model.cable(static_cast<int>(i));
    fmt::print("{} {}{}\n", actuator_type_name(model.actuators()[i].type),
               model.actuators()[i].name,
               cable == nullptr ? "" : ": " + mesh::format_length(cable->rest_length()) + " long");
  }
  for (const auto& effector : model.effectors()) fmt::print("effector {}\n", effector.name);
  for (const auto& controller : robot.controllers) fmt::print("controller {}\n", controller.name);
}

void run_info(const std::string& file) {
  const auto summary = record::read_run_summary(file);
  fmt::print("run by sinew {}: {} frames, {:g} s to {:g} s\n", summary.version, summary.frames,
             summary.first_time, summary.last_time);
  fmt::print("bodies: {}\nactuators: {}\neffectors: {}\n", fmt::join(summary.bodies, ", "),
             fmt::join(summary.actuators, ", "), fmt::join(summary.effectors, ", "));
}

void surface_info(const std::string& file, const InfoOptions& options) {
  mesh::SurfaceOptions settings;
  settings.unit = unit_of(options.unit);
  settings.unit_given = true;
  const mesh::Surface surface = mesh::read_surface(file, settings);
  const Vector3 size = surface.nodes.colwise().maxCoeff() - surface.nodes.colwise().minCoeff();
  fmt::print("surface {}: {} vertices, {} triangles, {} x {} x {}\n", surface.name,
             surface.nodes.rows(), surface.triangles.size(), mesh::format_length(size.x()),
             mesh::format_length(size.y()), mesh::format_length(size.z()));
  try {
    mesh::require_closed(surface);
    fmt::print("closed, encloses {:.6g} m^3\n", mesh::enclosed_volume(surface));
  } catch (const Error& error) {
    fmt::print("open: {}\n", error.message());
  }
}

}  // namespace

int info(const InfoOptions& options) {
  const std::filesystem::path path(options.file);
  const std::string extension = path.extension().string();
  if (extension == ".yaml" || extension == ".yml") {
    scene_info(options.file);
  } else if (extension == ".h5") {
    run_info(options.file);
  } else if (extension == ".stl" || extension == ".obj" || extension == ".ply") {
    surface_info(options.file, options);
  } else {
    mesh::ReadOptions settings;
    settings.unit = unit_of(options.unit);
    settings.unit_given = !options.unit.empty();
    mesh::Mesh mesh = mesh::read_mesh_unchecked(path, settings);
    mesh.notes.reordered_elements = mesh::reorder_elements(mesh);
    mesh::CheckOptions check;
    check.unit_given = settings.unit_given;
    fmt::print("{}", mesh::format_report(mesh::describe(mesh, check)));
  }
  return 0;
}

}  // namespace sinew::cli
