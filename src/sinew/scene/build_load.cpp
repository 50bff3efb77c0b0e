#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include "sinew/builder/load_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

mesh::Region region_of(const FixedRegion& fixed) {
  switch (fixed.kind) {
    case FixedRegion::Kind::box:
      return mesh::BoxRegion{fixed.lower, fixed.upper};
    case FixedRegion::Kind::sphere:
      return mesh::SphereRegion{fixed.point, fixed.radius};
    case FixedRegion::Kind::plane:
      return mesh::PlaneRegion{fixed.point, fixed.normal, -fixed.within, fixed.within};
    case FixedRegion::Kind::set:
      return mesh::NamedRegion{fixed.set};
  }
  return mesh::NamedRegion{fixed.set};
}

std::vector<mesh::Face> faces_of(const SurfaceDescription& surface, const mesh::Mesh& mesh) {
  const std::string& what = surface.place.item;
  try {
    switch (surface.kind) {
      case SurfaceDescription::Kind::inside:
        return mesh::enclosing_surface(mesh, surface.point, what);
      case SurfaceDescription::Kind::patch:
        return mesh::grow_patch(mesh, surface.point, surface.angle, what);
      case SurfaceDescription::Kind::region:
        return mesh::select_faces(mesh, region_of(surface.region), what);
      case SurfaceDescription::Kind::file:
        throw Error(ErrorKind::conflicting_keys, surface.place,
                    "faces of the body's own mesh are asked for, not a surface in a file",
                    "name them by a point inside, a patch or a region");
    }
  } catch (const Error& error) {
    throw error.at(surface.place);
  }
  return {};
}

namespace {

// The connected surface with the outermost node. It excludes the surfaces of internal voids.
std::vector<mesh::Face> outer_surface(const mesh::Mesh& mesh, const std::string& what) {
  const std::vector<NodeId> outer = mesh::outer_nodes(mesh);
  const NodeId outermost = *std::ranges::max_element(
      outer, [&](NodeId a, NodeId b) { return mesh.nodes(a, 0) < mesh.nodes(b, 0); });
  return mesh::grow_patch(mesh, mesh.nodes.row(outermost).transpose(), std::numbers::pi, what);
}

std::vector<mesh::Face> faces_of(const LoadDescription& load, const mesh::Mesh& mesh) {
  return load.surface ? faces_of(*load.surface, mesh) : outer_surface(mesh, load.name);
}

// Whether some faces of a mesh contain all of others, in any order of their nodes.
bool contain(const std::vector<mesh::Face>& faces, const std::vector<mesh::Face>& others) {
  const auto key = [](const mesh::Face& face) {
    std::array<NodeId, 4> nodes = face.node;
    std::ranges::sort(nodes);
    return nodes;
  };
  std::set<std::array<NodeId, 4>> keys;
  for (const mesh::Face& face : faces) keys.insert(key(face));
  return std::ranges::all_of(others, [&](const auto& face) { return keys.contains(key(face)); });
}

}  // namespace

double water_head(const SceneDescription& scene, const std::string& body,
                  const mechanics::BodyModel& model, const std::vector<mesh::Face>& faces) {
  const auto* bears = mechanics::as<const mechanics::BearsLoads>(model);
  if (bears == nullptr) return 0.0;
  const mesh::Mesh& mesh = bears->load_mesh();
  const Vector3& gravity = bears->gravity();
  double head = 0.0;
  for (const LoadDescription& load : scene.loads) {
    if (load.type != LoadDescription::Type::water || load.body != body || !load.water.level)
      continue;
    if (!contain(faces_of(load, mesh), faces)) continue;
    double least = std::numeric_limits<double>::infinity();  // m^2/s^2, gravity times depth
    for (const mesh::Face& face : faces) {
      for (const NodeId node : face.nodes()) {
        least = std::min(least, *load.water.level * gravity.norm() +
                                    mesh.nodes.row(node).transpose().dot(gravity));
      }
    }
    head += load.water.density * std::max(0.0, least) * std::max(0.0, load.factor.lowest());
  }
  return head;
}

void add_load(builder::ModelBuilder& builder, const LoadDescription& load, const BodyOf& body_of) {
  const auto [body, model] = body_of(load.body);
  const auto* bears = mechanics::as<const mechanics::BearsLoads>(*model);
  builder::LoadSettings settings;
  settings.name = load.name;
  settings.place = load.place;
  settings.body = body;
  settings.outside = load.outside;
  settings.factor = load.factor;
  const auto faces = [&]() -> std::vector<mesh::Face> {
    if (bears == nullptr) return {};  // the builder refuses the body
    return faces_of(load, bears->load_mesh());
  };
  switch (load.type) {
    case LoadDescription::Type::force:
      settings.load = builder::PointLoadSettings{load.point, load.vector};
      break;
    case LoadDescription::Type::line:
      settings.load = builder::LineLoadSettings{load.points.points, load.vector};
      break;
    case LoadDescription::Type::traction:
      settings.load = builder::SurfaceLoadSettings{faces(), load.vector};
      break;
    case LoadDescription::Type::acceleration:
      settings.load = builder::BodyLoadSettings{load.vector};
      break;
    case LoadDescription::Type::pressure:
      settings.load = builder::PressureLoadSettings{faces()};
      break;
    case LoadDescription::Type::water: {
      builder::WaterSettings water = load.water;
      water.faces = faces();
      settings.load = std::move(water);
      break;
    }
  }
  builder.add_load(settings);
}

}  // namespace sinew::scene
