#include <fmt/format.h>

#include "sinew/scene/readers.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace {

constraint::SmoothSurface read_solid(const Fields& fields) {
  if (fields.find("plane") != nullptr) {
    const Fields written = fields.below("plane");
    constraint::Plane plane;
    written.read("point", plane.point);
    written.read_direction("normal", plane.normal);
    return plane;
  }
  if (fields.find("sphere") != nullptr) {
    const Fields written = fields.below("sphere");
    constraint::Sphere sphere;
    written.read("centre", sphere.centre);
    written.read("radius", sphere.radius);
    return sphere;
  }
  const Fields written = fields.below("capsule");
  constraint::Capsule capsule;
  written.read("radius", capsule.radius);
  const Node& ends = *written.find("ends");
  const Form& form = written.form("ends").items.front();
  const std::vector<double> from = read_numbers(ends.items()[0], form);
  const std::vector<double> to = read_numbers(ends.items()[1], form);
  capsule.from = {from[0], from[1], from[2]};
  capsule.to = {to[0], to[1], to[2]};
  return capsule;
}

void refuse_key(const Fields& fields, const char* key, const char* why, const char* remedy) {
  if (fields.find(key) == nullptr) return;
  throw Error(ErrorKind::conflicting_keys, fields.place(key), fmt::format("`{}` {}", key, why),
              remedy);
}

void read_between(const Fields& fields, const Node& between, ContactDescription& contact) {
  contact.between_place = between.place();
  contact.all = between.items().empty();
  for (const char* key : {"surface", "motion"}) {
    refuse_key(fields, key, "does not apply to contact between bodies",
               "leave it out, or name one `body` in place of `between`");
  }
  if (contact.all) {
    for (const char* key : {"nodes", "points"}) {
      refuse_key(fields, key, "belongs to one body", "give that pair an entry of its own");
    }
    const Node* except = fields.find("except");
    if (except == nullptr) return;
    for (const Node& pair : except->items()) {
      contact.except.emplace_back(read_text(pair.items()[0]), read_text(pair.items()[1]));
    }
    return;
  }
  refuse_key(fields, "except", "is for `between: all`", "leave it out");
  contact.body = read_text(between.items()[0]);
  contact.other = read_text(between.items()[1]);
}

}  // namespace

ContactDescription read_contact(const Node::Entry& entry, const ReadContext& context) {
  ContactDescription contact;
  contact.name = entry.key;
  contact.place = entry.key_place;
  const Fields fields(entry.value, form_of(grammar(), "contacts", Shape::names).items.front());
  if (const Node* between = fields.find("between")) {
    read_between(fields, *between, contact);
  } else {
    fields.read("body", contact.body);
    if (fields.find("surface") == nullptr) {
      throw Error(ErrorKind::missing_key, contact.place, "'surface' is missing",
                  "add the surface that the body may touch, or write between: [it, another body]");
    }
    contact.surface = read_solid(fields.below("surface"));
  }
  contact.nodes = read_regions(fields, "nodes");
  if (fields.find("points") != nullptr) contact.points = read_points(fields, "points", context);
  read_outside(fields, contact.outside);
  fields.read("friction", contact.friction);
  if (fields.find("kinetic_friction") != nullptr) {
    fields.read("kinetic_friction", contact.kinetic_friction.emplace());
  }
  if (fields.find("restitution") != nullptr)
    fields.read("restitution", contact.restitution.emplace());
  fields.read("aggregate", contact.aggregate);
  if (fields.find("motion") != nullptr) {
    contact.motion = read_motion(fields.below("motion"), context);
  }
  return contact;
}

}  // namespace sinew::scene
