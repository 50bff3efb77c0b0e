// Actuators of type force.
#include <any>
#include <memory>
#include <utility>

#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> force_table() {
  KeyTable push{.name = "actuator: type force",
                .description = "A force along a fixed direction of the world on a point of a body.",
                .keys = {body_key(),
                         {.name = "point",
                          .forms = {vector(length())},
                          .example = "0 0 195 mm",
                          .description = "Point of application, in the mesh at rest.",
                          .required = true},
                         {.name = "direction",
                          .forms = {vector(plain_number())},
                          .example = "1 0 0",
                          .description = "Direction; any non-zero length.",
                          .required = true},
                         outside_key()}};
  const DriveWords words =
      line_words(builder::kForceKind, any(), "", "Motion of the point along the direction.",
                 "Command. Default: no force until commanded.");
  for (Key& key : drive_keys(words)) push.keys.push_back(std::move(key));
  return make_table(std::move(push));
}

}  // namespace
}  // namespace forms

namespace {

builder::ForceSettings read_force(const Fields& fields) {
  builder::ForceSettings force;
  fields.read("point", force.point);
  fields.read_direction("direction", force.direction);
  read_outside(fields, force.outside);
  read_limits(fields, builder::kForceKind, force.force, force.displacement);
  return force;
}

void add_force(const ActuatorSite& site) {
  site.builder.add_force(site.on_body(*site.actuator.as<builder::ForceSettings>()));
}

}  // namespace

const ActuatorKind& force_kind() {
  static const ActuatorKind kind{.words = &builder::kForceKind,
                                 .description = "A point force.",
                                 .table = forms::force_table,
                                 .read = [](const Fields& fields, const ReadContext&) -> std::any {
                                   return read_force(fields);
                                 },
                                 .add = add_force};
  return kind;
}

}  // namespace sinew::scene
