#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/sim/contact_settings.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::scene {

namespace {

std::vector<NodeId> nodes_of(const ContactDescription& contact, const mesh::Mesh& mesh) {
  std::vector<NodeId> outer = mesh::outer_nodes(mesh);
  if (!contact.nodes) return outer;
  const std::vector<NodeId> picked = at_place(contact.nodes->place, [&] {
    return mesh::select_nodes(mesh, region_of(*contact.nodes), contact.nodes->place.item);
  });
  std::vector<NodeId> nodes;
  std::ranges::set_intersection(picked, outer, std::back_inserter(nodes));
  if (nodes.empty()) {
    throw Error(ErrorKind::empty_region, contact.nodes->place,
                "all nodes of the region lie inside the body", "name a part of its outside");
  }
  return nodes;
}

bool is_rigid(const BuiltBody& body) {
  return mechanics::as<const mechanics::HasShape>(*body.model) != nullptr;
}

void refuse_points(const ContactDescription& contact) {
  if (!contact.nodes && contact.points.points.rows() == 0) return;
  throw Error(ErrorKind::conflicting_keys, contact.place,
              "deformable bodies touch with the whole of their surfaces",
              "leave `nodes` and `points` out");
}

}  // namespace

void add_contact(sim::ModelBuilder& builder, const ContactDescription& contact,
                 const BodyOf& body_of) {
  BuiltBody touching = body_of(contact.body), other;
  if (!contact.other.empty()) {
    other = body_of(contact.other);
    if (!is_rigid(other) && is_rigid(touching)) std::swap(touching, other);
  }
  const bool surfaces = other.model != nullptr && !is_rigid(other);
  const auto [body, model] = touching;
  sim::ContactSettings settings;
  settings.name = contact.name;
  settings.place = contact.place;
  settings.body = body;
  std::visit([&](const auto& surface) { settings.surface = surface; }, contact.surface);
  if (surfaces) refuse_points(contact);
  if (other.model != nullptr) settings.touched = other.number;
  settings.points = contact.points.points;
  settings.outside = contact.outside;
  settings.friction = contact.friction;
  settings.restitution = contact.restitution;
  const bool whole = is_rigid(touching) && !contact.nodes;
  if (settings.points.rows() == 0 && !whole && !surfaces) {
    settings.nodes = nodes_of(contact, model->mesh());
  }
  if (contact.motion) {
    const BaseDescription& motion = *contact.motion;
    settings.motion = {-1, motion.translation, motion.angle, motion.axis, motion.centre};
  }
  builder.add_contact(settings);
}

}  // namespace sinew::scene
