#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

std::vector<NodeId> nodes_of(const ContactDescription& contact, const mesh::Mesh& mesh) {
  std::vector<NodeId> outer = mesh::outer_nodes(mesh);
  if (contact.nodes.empty()) return outer;
  std::vector<NodeId> nodes;
  for (const FixedRegion& region : contact.nodes) {
    const std::vector<NodeId> picked = at_place(region.place, [&] {
      return mesh::select_nodes(mesh, region_of(region), region.place.item);
    });
    std::vector<NodeId> in_region, all;
    std::ranges::set_intersection(picked, outer, std::back_inserter(in_region));
    if (in_region.empty()) {
      throw Error(ErrorKind::empty_region, region.place,
                  "all nodes of the region lie inside the body", "name a part of its outside");
    }
    std::ranges::set_union(nodes, in_region, std::back_inserter(all));
    nodes = std::move(all);
  }
  return nodes;
}

bool names_points(const ContactDescription& contact) {
  return !contact.nodes.empty() || contact.points.points.rows() > 0;
}

void refuse_points(const ContactDescription& contact) {
  if (!names_points(contact)) return;
  throw Error(ErrorKind::conflicting_keys, contact.place,
              "these bodies touch with the whole of their surfaces",
              "leave `nodes` and `points` out");
}

// Radius of a surface; infinite for a plane.
double radius_of(const constraint::SmoothSurface& surface) {
  if (const auto* sphere = std::get_if<collision::Sphere>(&surface)) return sphere->radius;
  if (const auto* capsule = std::get_if<collision::Capsule>(&surface)) return capsule->radius;
  return kInfinity;
}

std::optional<Notice> coarse_notice(const ContactDescription& contact, const mesh::Mesh& mesh) {
  const double longest = mesh::longest_edge(mesh::boundary_surface(mesh));
  const double radius = radius_of(contact.surface);
  if (longest <= builder::kFineEdge * radius) return std::nullopt;
  return Notice{
      contact.nodes.empty() ? NoticeLevel::warning : NoticeLevel::remark,
      NoticeKind::coarse_contact, contact.place,
      fmt::format("nodes of body '{}' up to {:.2g} mm apart touch a surface of radius {:.2g} mm, "
                  "which may pass between them",
                  contact.body, 1e3 * longest, 1e3 * radius),
      "mesh the body finer, or make the surface a body (type: rigid, fixed) and name both in "
      "`between`"};
}

}  // namespace

std::optional<Notice> add_contact(builder::ModelBuilder& builder, const ContactDescription& contact,
                                  const BodyOf& body_of) {
  BuiltBody touching = body_of(contact.body), other;
  if (!contact.other.empty()) {
    other = body_of(contact.other);
    if (!is_rigid(other) && is_rigid(touching)) std::swap(touching, other);
  }
  const bool surfaces =
      other.model != nullptr &&
      builder::touch_by_surfaces(*touching.model, *other.model, names_points(contact));
  const auto [body, model] = touching;
  builder::ContactSettings settings;
  settings.name = contact.name;
  settings.place = contact.place;
  settings.body = body;
  std::visit([&](const auto& surface) { settings.surface = surface; }, contact.surface);
  if (surfaces) refuse_points(contact);
  if (other.model != nullptr) settings.touched = other.number;
  settings.points = contact.points.points;
  settings.outside = contact.outside;
  settings.friction = contact.friction;
  settings.kinetic_friction = contact.kinetic_friction;
  settings.restitution = contact.restitution;
  settings.aggregate = contact.aggregate;
  settings.motion = contact.motion;
  const bool whole = is_rigid(touching) && contact.nodes.empty();
  if (settings.points.rows() == 0 && !whole && !surfaces) {
    settings.nodes = nodes_of(contact, model->mesh());
  }
  builder.add_contact(settings);
  if (settings.touched || settings.nodes.empty() || is_rigid(touching)) return std::nullopt;
  return coarse_notice(contact, model->mesh());
}

}  // namespace sinew::scene
