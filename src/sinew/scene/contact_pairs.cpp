#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sinew/core/error.hpp"
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
  return !one.arm && !other.arm;
}

bool is_fixed(const BodyDescription& body) { return body.rigid && body.rigid->fixed; }

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
      if ((one == other && one->rigid) || (is_fixed(*one) && is_fixed(*other))) continue;
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
      if (!one->rigid || !other->rigid) added.restitution.reset();  // of rigid pairs alone
      if (one->rigid && other->rigid) added.aggregate = 0.0;        // of deformable bodies
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
      contacts.push_back({contact, contact.name});
    }
  }
  return contacts;
}

}  // namespace sinew::scene
