#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::scene {

namespace {

// All of the body, of its material.
fem::Region whole(const BodyDescription& body) {
  fem::Region region;
  if (body.material.model == MaterialModel::hyperelastic) {
    region.hyperelastic = body.material.energy;
  } else {
    region.constants = {body.material.young_modulus, body.material.poisson_ratio};
    region.law = body.material.model == MaterialModel::linear ? material::Law::linear
                                                              : material::Law::corotational;
  }
  region.patches = body.element == Element::tet4_patch;
  region.density = body.density.value_or(body.mass ? 0.0 : body.material.density);
  return region;
}

void fix(const FixedRegion& fixed, const mesh::Mesh& mesh, fem::FemModelSettings& elements) {
  try {
    const auto nodes = mesh::select_nodes(mesh, region_of(fixed), fixed.place.item);
    if (std::ranges::all_of(fixed.axes, std::identity{})) {
      elements.fixed_nodes.insert(elements.fixed_nodes.end(), nodes.begin(), nodes.end());
      return;
    }
    for (const NodeId node : nodes) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (fixed.axes[axis]) elements.held_axes.push_back({node, static_cast<int>(axis)});
      }
    }
  } catch (const Error& error) {
    throw error.at(fixed.place);
  }
}

fem::FemBodySettings fem_settings(const SceneDescription& scene, const BodyDescription& body) {
  fem::FemBodySettings settings;
  settings.name = body.name;
  settings.mesh = std::make_shared<const mesh::Mesh>(make_body_mesh(body));
  check_element(body, *settings.mesh);
  settings.gravity = scene.gravity;
  settings.damping = {body.mass_damping, body.stiffness_damping};
  for (const MassDescription& mass : scene.masses) {
    if (mass.body != body.name) continue;
    settings.masses.push_back({mass.name, mass.place, mass.point, mass.mass, mass.outside});
  }
  if (const auto& start = body.initial_velocity) {
    settings.initial_velocity = {start->linear, start->angular};
  }
  settings.elements.regions.push_back(whole(body));
  settings.elements.total_mass = body.mass;
  settings.elements.even_mass = body.mass_distribution == MassDistribution::even;
  settings.elements.mass = body.mass_matrix == MassMatrix::consistent ? fem::MassMatrix::consistent
                                                                      : fem::MassMatrix::lumped;
  for (const FixedRegion& fixed : body.fixed) fix(fixed, *settings.mesh, settings.elements);
  for (const MembraneDescription& layer : scene.membranes) {
    if (layer.body != body.name) continue;
    settings.elements.membranes.push_back(
        {layer.name, faces_of(layer.surface, *settings.mesh), layer.thickness, layer.constants});
  }
  return settings;
}

void add_arm(sim::ModelBuilder& builder, const SceneDescription& scene,
             const BodyDescription& body) {
  pcc::ArmSettings settings = *body.arm;
  settings.gravity = scene.gravity;
  builder.add_arm(std::move(settings));
}

void add_rigid(sim::ModelBuilder& builder, const SceneDescription& scene,
               const BodyDescription& body) {
  rigid::RigidSettings settings = *body.rigid;
  settings.gravity = scene.gravity;
  if (!body.mesh.file.empty()) settings.shape = make_solid(make_surface(body.mesh), body.convex);
  builder.add_rigid_body(std::move(settings), body.place);
}

}  // namespace

rigid::Solid make_solid(mesh::Surface surface, bool convex) {
  rigid::Solid solid;
  solid.surface = std::make_shared<const mesh::Surface>(std::move(surface));
  if (convex) solid.hull = std::make_shared<const collision::Polyhedron>(solid.surface->nodes);
  return solid;
}

std::optional<Notice> add_body(sim::ModelBuilder& builder, const SceneDescription& scene,
                               const BodyDescription& body) {
  std::optional<Notice> notice;
  try {
    if (body.arm) {
      add_arm(builder, scene, body);
      return notice;
    }
    if (body.rigid) {
      add_rigid(builder, scene, body);
      return notice;
    }
    fem::FemBodySettings settings = fem_settings(scene, body);
    notice = locking_notice(body, *settings.mesh);
    const int number = builder.add_fem_body(std::move(settings), body.place);
    if (body.base) {
      builder.add_base_motion(
          {number, body.base->translation, body.base->angle, body.base->axis, body.base->centre},
          body.base->place);
    }
  } catch (const Error& error) {
    throw error.at(body.place);
  }
  return notice;
}

}  // namespace sinew::scene
