// Bodies of type fem: finite elements.
#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace {

// A region of one material for the whole body.
fem::MaterialRegion whole(const BodyDescription& body, const MaterialDescription& material) {
  fem::MaterialRegion region;
  if (material.is_hyperelastic()) {
    region.hyperelastic = material.energy;
  } else {
    region.constants = {material.young_modulus, material.poisson_ratio};
    region.law = material.model == MaterialModel::linear ? material::Law::linear
                                                         : material::Law::corotational;
  }
  region.patches = body.element == Element::tet4_patch;
  return region;
}

double density_of(const BodyDescription& body) {
  return body.density.value_or(body.mass ? 0.0 : body.material.density);
}

double density_of(const PartDescription& part, const BodyDescription& body) {
  if (part.density && body.mass) {
    throw Error(ErrorKind::conflicting_keys, part.place,
                "the part has a density, and the body a mass, which spreads over its volume",
                "give the body a density in place of `mass`");
  }
  if (part.density) return *part.density;
  return body.mass || !(part.material.density > 0.0) ? density_of(body) : part.material.density;
}

// The elements with all nodes in the region of the part.
std::vector<NodeId> elements_of(const PartDescription& part, const mesh::Mesh& mesh) {
  std::vector<char> picked(static_cast<std::size_t>(mesh.node_count()), 0);
  const auto nodes = at_place(part.place, [&] {
    return mesh::select_nodes(mesh, region_of(part.region), part.region.place.item);
  });
  for (const NodeId node : nodes) picked[static_cast<std::size_t>(node)] = 1;
  const fem::ElementList list(mesh);
  std::vector<NodeId> elements;
  for (int e = 0; e < list.count(); ++e) {
    const auto is_picked = [&](NodeId node) { return picked[static_cast<std::size_t>(node)] != 0; };
    if (std::ranges::all_of(list.nodes(e), is_picked)) elements.push_back(e);
  }
  if (!elements.empty()) return elements;
  throw Error(ErrorKind::empty_region, part.place,
              fmt::format("the region has {} nodes, and no element with all of its nodes there",
                          nodes.size()),
              "widen it to the bounds of the elements, or refine the mesh");
}

// The regions: elements in no part, with the material of the body, then the parts.
std::vector<fem::MaterialRegion> regions_of(const BodyDescription& body, const mesh::Mesh& mesh) {
  fem::MaterialRegion rest = whole(body, body.material);
  rest.density = density_of(body);
  if (body.parts.empty()) return {rest};
  std::vector<fem::MaterialRegion> regions;
  std::vector<const PartDescription*> owner(
      static_cast<std::size_t>(fem::ElementList(mesh).count()), nullptr);
  for (const PartDescription& part : body.parts) {
    fem::MaterialRegion& region = regions.emplace_back(whole(body, part.material));
    region.name = part.name;
    region.density = density_of(part, body);
    region.elements = elements_of(part, mesh);
    for (const NodeId e : region.elements) {
      const PartDescription*& own = owner[static_cast<std::size_t>(e)];
      if (own != nullptr) {
        throw Error(ErrorKind::conflicting_keys, part.place,
                    fmt::format("elements of '{}' are in '{}' already", part.name, own->name),
                    "let regions not overlap by an element");
      }
      own = &part;
    }
  }
  for (std::size_t e = 0; e < owner.size(); ++e) {
    if (owner[e] == nullptr) rest.elements.push_back(static_cast<NodeId>(e));
  }
  if (!rest.elements.empty()) regions.insert(regions.begin(), std::move(rest));
  return regions;
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

linalg::FactorisationSettings factorisation_settings(const SolverDescription& solver) {
  linalg::FactorisationSettings settings;
  settings.backend = solver.backend;
  settings.ordering = solver.ordering;
  settings.threads = solver.threads;
  return settings;
}

fem::FemBodySettings fem_settings(const SceneDescription& scene, const BodyDescription& body,
                                  const SharedMesh* shared) {
  fem::FemBodySettings settings;
  settings.name = body.name;
  if (shared != nullptr) {
    settings.mesh = shared->mesh;
    settings.embedder = shared->embedder;
  } else {
    settings.mesh = std::make_shared<const mesh::Mesh>(make_body_mesh(body));
    check_element(body, *settings.mesh);
  }
  settings.gravity = scene.gravity;
  settings.factorisation = factorisation_settings(scene.solver);
  settings.damping = {body.mass_damping, body.stiffness_damping};
  for (const MassDescription& mass : scene.masses) {
    if (mass.body != body.name) continue;
    settings.masses.push_back({mass.name, mass.place, mass.point, mass.mass, mass.outside});
  }
  if (const auto& start = body.velocity) {
    settings.initial_velocity = {start->linear, start->angular};
  }
  settings.elements.regions = regions_of(body, *settings.mesh);
  settings.elements.total_mass = body.mass;
  settings.elements.equal_nodal_masses = body.mass_distribution == MassDistribution::even;
  settings.elements.mass = body.mass_matrix;
  for (const FixedRegion& fixed : body.fixed) fix(fixed, *settings.mesh, settings.elements);
  for (const MembraneDescription& layer : scene.membranes) {
    if (layer.body != body.name) continue;
    settings.elements.membranes.push_back(
        {layer.name, faces_of(layer.surface, *settings.mesh), layer.thickness, layer.constants});
  }
  return settings;
}

std::unique_ptr<mechanics::BodyModel> make_fem(const BodySite& site) {
  return std::make_unique<fem::FemBodyModel>(fem_settings(site.scene, site.body, site.shared));
}

}  // namespace

const BodyKind& fem_kind() {
  static const BodyKind kind{.word = "fem",
                             .description = "Finite elements.",
                             .noun = "a body of finite elements",
                             .table = forms::fem_table,
                             .read = read_fem_body,
                             .make = make_fem,
                             .has_elements = true};
  return kind;
}

}  // namespace sinew::scene
