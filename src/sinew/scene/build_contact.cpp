#include <algorithm>
#include <string_view>
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

// The nodes of a rigid body's picture are points of it where it has corners alone.
void check_corners(const ContactDescription& contact, const mechanics::BodyModel& model) {
  const auto* shape = mechanics::as<const mechanics::HasShape>(model);
  if (shape == nullptr || shape->shape_name() == std::string_view("box")) return;
  throw Error(ErrorKind::not_in_this_version, contact.place,
              fmt::format("body '{}' is round, and contact of round bodies", contact.body),
              "name `points` of it that may touch");
}

// The surface is that of a rigid body, the points are the other's.
void order(const ContactDescription& contact, BuiltBody& touching, BuiltBody& other) {
  const auto is_rigid = [](const BuiltBody& body) {
    return mechanics::as<const mechanics::HasShape>(*body.model) != nullptr;
  };
  if (touching.number == other.number || (!is_rigid(touching) && !is_rigid(other))) {
    throw Error(ErrorKind::not_in_this_version, contact.between_place,
                "contact of deformable bodies with one another or themselves",
                "name a rigid body and another one");
  }
  if (!is_rigid(other)) std::swap(touching, other);
}

}  // namespace

void add_contact(sim::ModelBuilder& builder, const ContactDescription& contact,
                 const BodyOf& body_of) {
  BuiltBody touching = body_of(contact.body), other;
  if (!contact.other.empty()) {
    other = body_of(contact.other);
    order(contact, touching, other);
  }
  const auto [body, model] = touching;
  sim::ContactSettings settings;
  settings.name = contact.name;
  settings.place = contact.place;
  settings.body = body;
  if (other.model != nullptr) {
    settings.surface = mechanics::as<const mechanics::HasShape>(*other.model)->rest_shape();
    settings.carrier = other.number;
  } else {
    std::visit([&](const auto& surface) { settings.surface = surface; }, contact.surface);
  }
  settings.points = contact.points.points;
  settings.outside = contact.outside;
  settings.friction = contact.friction;
  if (settings.points.rows() == 0) {
    check_corners(contact, *model);
    settings.nodes = nodes_of(contact, model->mesh());
  }
  if (contact.motion) {
    const BaseDescription& motion = *contact.motion;
    settings.motion = {-1, motion.translation, motion.angle, motion.axis, motion.centre};
  }
  builder.add_contact(settings);
}

}  // namespace sinew::scene
