// Sensors of contacts: types contact-force and touch.
#include <algorithm>
#include <string>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::vector<Key> sensed_contact_keys() {
  std::vector<Key> patch = region_keys("Nodes");
  Key body = body_key();
  body.required = false;
  body.description =
      "The body that has the patch. Default: the first body of the contact. Required for an entry "
      "`between: all`.";
  patch.push_back(std::move(body));
  return {
      {.name = "contact",
       .forms = {reference("contacts")},
       .example = "floor",
       .description = "The contact to measure: a contact, one pair of a `between: all` entry (such "
                      "as `all-finger-box`), or the entry itself for all its pairs.",
       .required = true},
      {.name = "patch",
       .forms = {table(make_table(
           {.name = "patch of a contact",
            .description = "Nodes of the mesh at rest: exactly one of box, sphere, plane and set. "
                           "A contact point belongs to the patch if its nearest surface node does.",
            .keys = std::move(patch),
            .alternatives = {{{"box", "sphere", "plane", "set"}, true}}}))},
       .example = "{set: pad}",
       .description = "Region that it measures. Default: the whole contact."}};
}

std::shared_ptr<const KeyTable> contact_force_table() {
  return sensor_table("contact-force", "Sum of the normal forces of a contact, N.",
                      sensed_contact_keys(), {force(), "0.05 N", "0.01 N", "0 10 N"});
}

std::shared_ptr<const KeyTable> touch_table() {
  std::vector<Key> keys = sensed_contact_keys();
  keys.push_back({.name = "threshold",
                  .forms = {quantity(force(), non_negative())},
                  .example = "0.1 N",
                  .default_text = "0 N",
                  .description = "Normal force above which the sensor reads 1."});
  return sensor_table("touch", "Contact switch: 1 if something touches, otherwise 0.",
                      std::move(keys));
}

}  // namespace
}  // namespace forms

namespace {

ContactSensorDescription read_sensed_contact(const Fields& fields, SensorDescription& sensor) {
  ContactSensorDescription own;
  fields.read("contact", own.contact);
  if (fields.find("patch") == nullptr) return own;
  const Fields patch = fields.below("patch");
  own.patch = read_region(patch);
  patch.read("body", sensor.further_bodies.emplace_back());
  return own;
}

void read_contact_force(const Fields& fields, const ReadContext& /*context*/,
                        SensorDescription& sensor) {
  sensor.own = read_sensed_contact(fields, sensor);
}

void read_touch(const Fields& fields, const ReadContext& /*context*/, SensorDescription& sensor) {
  ContactSensorDescription own = read_sensed_contact(fields, sensor);
  fields.read("threshold", own.threshold.emplace(0.0));
  sensor.own = std::move(own);
}

// The contact of that name, or all pairs of an entry.
std::vector<std::string> contacts_named(const std::string& name, const SensorSite& site) {
  std::vector<std::string> names;
  for (const auto& [contact, entry] : site.contacts) {
    if (contact.name == name || entry == name) names.push_back(contact.name);
  }
  if (names.empty()) names.push_back(name);  // which is refused
  return names;
}

std::string first_body_of(const ContactSensorDescription& own, const SensorSite& site) {
  const auto found = std::ranges::find_if(
      site.contacts, [&](const SceneContact& one) { return one.contact.name == own.contact; });
  if (found != site.contacts.end()) return found->contact.body;
  throw Error(ErrorKind::missing_key, own.patch->place, "the patch names no body",
              "add body: followed by the body that has the patch");
}

sense::MakeSource contact_source(const SensorSite& site) {
  const auto& own = *site.sensor.as<ContactSensorDescription>();
  sense::SensorContact touch{contacts_named(own.contact, site), -1, {}, own.threshold};
  if (!own.patch) return touch;
  const std::string& named = site.sensor.further_bodies.front();
  const BuiltBody on = site.body_of(named.empty() ? first_body_of(own, site) : named);
  touch.body = on.number;
  touch.patch = nodes_of(*own.patch, on.model->mesh());
  return touch;
}

}  // namespace

const SensorKind& contact_force_kind() {
  static const SensorKind kind{.word = "contact-force",
                               .description = "Normal force of a contact.",
                               .table = forms::contact_force_table,
                               .read = read_contact_force,
                               .source = contact_source,
                               .reads_force = true};
  return kind;
}

const SensorKind& touch_kind() {
  static const SensorKind kind{.word = "touch",
                               .description = "Whether a contact is loaded.",
                               .table = forms::touch_table,
                               .read = read_touch,
                               .source = contact_source,
                               .is_switch = true,
                               .reads_force = true};
  return kind;
}

}  // namespace sinew::scene
