#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

namespace {

using Pair = std::pair<std::string, std::string>;

Pair ordered(const std::string& one, const std::string& other) {
  return one < other ? Pair{one, other} : Pair{other, one};
}

// The pairs that have an entry of their own.
std::set<Pair> named_pairs(const SceneDescription& scene) {
  std::set<Pair> pairs;
  for (const ContactDescription& contact : scene.contacts) {
    if (contact.other.empty()) continue;
    if (pairs.insert(ordered(contact.body, contact.other)).second) continue;
    throw Error(ErrorKind::conflicting_keys, contact.between_place,
                fmt::format("'{}' and '{}' have a contact already", contact.body, contact.other),
                "give a pair of bodies one entry");
  }
  return pairs;
}

bool can_touch(const BodyDescription& one, const BodyDescription& other) {
  return one.kind->is_searched && other.kind->is_searched;
}

const PlaneDescription* plane_named(const SceneDescription& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.planes, name, &PlaneDescription::name);
  return found != scene.planes.end() ? &*found : nullptr;
}

// Contact of one body with the surface of a plane.
void touch_plane(ContactDescription& contact, const std::string& body,
                 const PlaneDescription& plane) {
  contact.body = body;
  contact.other.clear();
  contact.surface = plane.plane;
  contact.motion = plane.motion;
}

// The contact of a pair that has an entry of its own.
ContactDescription own_contact(const ContactDescription& written, const SceneDescription& scene) {
  ContactDescription contact = written;
  const PlaneDescription *first = plane_named(scene, written.body),
                         *second = plane_named(scene, written.other);
  if (first == nullptr && second == nullptr) return contact;
  if (first != nullptr && second != nullptr) {
    throw Error(ErrorKind::conflicting_keys, written.between_place,
                fmt::format("'{}' and '{}' are both planes", written.body, written.other),
                "name a plane and a body that can move");
  }
  touch_plane(contact, first != nullptr ? written.other : written.body,
              first != nullptr ? *first : *second);
  return contact;
}

bool is_fixed(const BodyDescription& body) {
  return body.kind->is_fixed != nullptr && body.kind->is_fixed(body);
}

// Throws for pairs of a `between: all` whose contact is not in this version.
void refuse_pairs(const std::vector<Pair>& pairs, const Location& place) {
  if (pairs.empty()) return;
  std::vector<std::string> texts;
  texts.reserve(pairs.size());
  for (const auto& [one, other] : pairs) texts.push_back(fmt::format("[{}, {}]", one, other));
  throw Error(ErrorKind::not_in_this_version, place,
              "contact of arms with one another, with themselves and without points,",
              fmt::format("write except: [{}], and give arms entries with `points`",
                          fmt::join(texts, ", ")));
}

// The pairs of a `between: all`. @param settled pairs to be left out; the new pairs are added.
std::vector<SceneContact> pairs_of(const ContactDescription& contact, const SceneDescription& scene,
                                   std::set<Pair>& settled) {
  std::set<Pair> excepted;
  for (const auto& [one, other] : contact.except) excepted.insert(ordered(one, other));
  std::vector<SceneContact> contacts;
  std::vector<Pair> refused;
  for (auto one = scene.bodies.begin(); one != scene.bodies.end(); ++one) {
    for (auto other = one; other != scene.bodies.end(); ++other) {
      if ((one == other && one->kind->is_rigid) || (is_fixed(*one) && is_fixed(*other))) continue;
      const Pair pair = ordered(one->name, other->name);
      if (excepted.contains(pair) || !settled.insert(pair).second) continue;
      if (!can_touch(*one, *other)) {
        refused.emplace_back(one->name, other->name);
        continue;
      }
      ContactDescription& added =
          contacts.emplace_back(SceneContact{contact, contact.name}).contact;
      added.name = fmt::format("{}-{}-{}", contact.name, one->name, other->name);
      added.body = one->name;
      added.other = other->name;
      const bool rigid = one->kind->is_rigid && other->kind->is_rigid;
      if (!rigid) added.restitution.reset();  // of rigid pairs alone
      if (rigid) added.aggregate = 0.0;       // of deformable bodies
    }
    if (is_fixed(*one)) continue;
    for (const PlaneDescription& plane : scene.planes) {
      const Pair pair = ordered(one->name, plane.name);
      if (excepted.contains(pair) || !settled.insert(pair).second) continue;
      if (!one->kind->is_searched) {
        refused.emplace_back(one->name, plane.name);
        continue;
      }
      ContactDescription& added =
          contacts.emplace_back(SceneContact{contact, contact.name}).contact;
      added.name = fmt::format("{}-{}-{}", contact.name, one->name, plane.name);
      touch_plane(added, one->name, plane);
      if (!one->kind->is_rigid) added.restitution.reset();
      if (one->kind->is_rigid) added.aggregate = 0.0;
    }
  }
  refuse_pairs(refused, contact.between_place);
  return contacts;
}

}  // namespace

std::vector<SceneContact> contact_pairs(const SceneDescription& scene) {
  std::set<Pair> settled = named_pairs(scene);
  for (const JointDescription& joint : scene.joints) {
    settled.insert(ordered(joint.first, joint.second));
  }
  std::vector<SceneContact> contacts;
  for (const ContactDescription& contact : scene.contacts) {
    if (contact.all) {
      std::ranges::move(pairs_of(contact, scene, settled), std::back_inserter(contacts));
    } else {
      contacts.push_back({own_contact(contact, scene), contact.name});
    }
  }
  return contacts;
}

}  // namespace sinew::scene
