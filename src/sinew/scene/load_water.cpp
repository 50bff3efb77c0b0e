// Loads of type water.
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/load_fields.hpp"
#include "sinew/scene/load_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

Key coefficient_key(const char* name, const char* value, const char* description) {
  return {.name = name,
          .forms = {quantity(plain_number(), non_negative())},
          .example = value,
          .default_text = value,
          .description = description};
}

std::shared_ptr<const KeyTable> water_table() {
  return load_table(
      "water",
      "Surrounding water: buoyancy under the scene's gravity, drag on every face, and added mass.",
      {surface_key("The wet faces. Default: the whole outer surface of the body.", false),
       {.name = "density",
        .forms = {quantity(density(), non_negative())},
        .example = "1000 kg/m^3",
        .default_text = "1000 kg/m^3",
        .description = "Density of the water."},
       {.name = "level",
        .forms = {quantity(length())},
        .example = "100 mm",
        .description = "Height of the water's surface above the origin, against gravity. Default: "
                       "far above the body."},
       {.name = "velocity",
        .forms = {vector(speed())},
        .example = "0.1 0 0 m/s",
        .default_text = "0 0 0 m/s",
        .description = "Velocity of the water far from the body."},
       coefficient_key(
           "normal_drag", "0.9",
           "Drag coefficient of a face moving along its normal. Referred to the width, a "
           "cylinder in cross flow then has a drag coefficient of 4/3 of this value, and a "
           "sphere of this value."),
       coefficient_key("tangential_drag", "0.01",
                       "Drag coefficient of a face moving tangentially."),
       coefficient_key("added_mass", "1",
                       "Added mass as a fraction of the displaced water: 1 for a cylinder in cross "
                       "flow, 0.5 for a sphere."),
       factor_key()});
}

}  // namespace
}  // namespace forms

namespace {

struct Water {
  std::optional<SurfaceDescription> surface;  // none: the outer surface
  builder::WaterSettings settings;            // its faces are set later
};

void read_water(const Fields& fields, const ReadContext& context, LoadDescription& load) {
  Water own;
  if (fields.find("surface") != nullptr) {
    read_surface(fields.below("surface"), own.surface.emplace(), context);
  }
  builder::WaterSettings& water = own.settings;
  fields.read("density", water.density);
  if (fields.find("level") != nullptr) fields.read("level", water.level.emplace());
  fields.read("velocity", water.velocity);
  fields.read("normal_drag", water.normal_drag);
  fields.read("tangential_drag", water.tangential_drag);
  fields.read("added_mass", water.added_mass);
  load.own = std::move(own);
}

// The connected surface with the outermost node. It excludes the surfaces of internal voids.
std::vector<mesh::Face> outer_surface(const mesh::Mesh& mesh, const std::string& what) {
  const std::vector<NodeId> outer = mesh::outer_nodes(mesh);
  const NodeId outermost = *std::ranges::max_element(
      outer, [&](NodeId a, NodeId b) { return mesh.nodes(a, 0) < mesh.nodes(b, 0); });
  return mesh::grow_patch(mesh, mesh.nodes.row(outermost).transpose(), std::numbers::pi, what);
}

std::vector<mesh::Face> wet_faces(const LoadSite& site) {
  const auto& own = *site.load.as<Water>();
  if (own.surface) return site.faces(*own.surface);
  if (site.bears == nullptr) return {};
  return outer_surface(site.bears->load_mesh(), site.load.name);
}

builder::MakeLoad make_water(const LoadSite& site) {
  builder::WaterSettings water = site.load.as<Water>()->settings;
  water.faces = wet_faces(site);
  return water;
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

// @return Pa, at the highest of the faces in the scene's pose; 0 if it wets not all of them.
double head_of_water(const LoadSite& site, const std::vector<mesh::Face>& faces) {
  const builder::WaterSettings& water = site.load.as<Water>()->settings;
  if (!water.level || !contain(wet_faces(site), faces)) return 0.0;
  const mesh::Mesh& mesh = site.bears->load_mesh();
  const Vector3& gravity = site.bears->gravity();
  double least = std::numeric_limits<double>::infinity();  // m^2/s^2, gravity times depth
  for (const mesh::Face& face : faces) {
    for (const NodeId node : face.nodes()) {
      least = std::min(
          least, *water.level * gravity.norm() + mesh.nodes.row(node).transpose().dot(gravity));
    }
  }
  return water.density * std::max(0.0, least) * std::max(0.0, site.load.factor.lowest());
}

}  // namespace

const LoadKind& water_kind() {
  static const LoadKind kind{.word = "water",
                             .description = "Buoyancy, drag and added mass.",
                             .table = forms::water_table,
                             .read = read_water,
                             .make = make_water,
                             .head = head_of_water};
  return kind;
}

}  // namespace sinew::scene
