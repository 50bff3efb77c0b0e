// Actuators of type cable.
#include <any>
#include <memory>
#include <string>
#include <utility>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> cable_table() {
  KeyTable cable{
      .name = "actuator: type cable",
      .description =
          "A cable that slides through points of a body, with or without friction. It can only "
          "pull.",
      .keys = {
          body_key(),
          {.name = "points",
           .forms = {table(point_file_table()),
                     list({vector(length()), table(body_point_table())}, 2)},
           .example = "[0 10 0 mm, 0 10 60 mm, 0 10 120 mm]",
           .description =
               "Routing points in the mesh at rest. The first is the pull point and the last is "
               "the fixed end. A point in another body: {body: upper, point: 0 10 80 mm}.",
           .required = true},
          {.name = "pull",
           .forms = {choice({{"world", "Does not move."}, {"body", "Moves with the body."}})},
           .example = "world",
           .default_text = "world",
           .description = "Attachment of the pull point."},
          outside_key(),
          {.name = "friction",
           .forms = {quantity(plain_number(), non_negative())},
           .example = "0.2",
           .default_text = "0",
           .description = "Coulomb friction coefficient at every point between the ends: the "
                          "tension changes there by a factor of at most e^(friction angle)."},
          {.name = "guide_radius",
           .forms = {quantity(length(), non_negative())},
           .example = "2 mm",
           .default_text = "0 m",
           .description = "Radius of the guide tubes or rings embedded in the material: each point "
                          "is the average over a ball. With 0 the cable acts on bare points, whose "
                          "local indentation grows without limit as the mesh is refined."},
          {.name = "guide_spacing",
           .forms = {quantity(length(), non_negative())},
           .example = "10 mm",
           .default_text = "0 m",
           .description = "Adds evenly spaced guides between the points, at most this far apart, "
                          "as in a conduit. 0: only the points, between which the cable runs "
                          "straight also where the body bends."},
          {.name = "geometric_stiffness",
           .forms = {boolean()},
           .example = "false",
           .default_text = "true",
           .description =
               "Adds the cable's geometric stiffness (from tension) to every step. If false, steps "
               "with highly loaded cables converge slowly or not at all."}}};
  const DriveWords words = line_words(builder::kCableKind, non_negative(), "0 N",
                                      "Length of cable pulled in at the pull point.",
                                      "Command. Default: slack until commanded.");
  for (Key& key : drive_keys(words)) cable.keys.push_back(std::move(key));
  return make_table(std::move(cable));
}

}  // namespace
}  // namespace forms

namespace {

CableDescription read_cable(const Fields& fields, const ReadContext& context) {
  CableDescription cable;
  const PointList points = read_line_points(fields, context);
  cable.points_place = points.place;
  cable.point_bodies = points.bodies;
  builder::CableSettings& settings = cable.settings;
  set_line(fields, points, settings);
  fields.read("geometric_stiffness", settings.geometric_stiffness);
  fields.read("friction", settings.friction);
  cable.guide_radius_given = fields.read("guide_radius", settings.guide_radius);
  fields.read("guide_spacing", settings.guide_spacing);
  read_limits(fields, builder::kCableKind, settings.tension, settings.displacement);
  return cable;
}

void add_cable(const ActuatorSite& site) {
  const auto& cable = *site.actuator.as<CableDescription>();
  builder::CableSettings settings = site.on_body(cable.settings);
  for (const std::string& name : cable.point_bodies) {
    settings.point_bodies.push_back(name.empty() ? settings.body : site.body_of(name).number);
  }
  site.builder.add_cable(settings);
}

FurtherBodies bodies_of_cable(std::any& own) {
  auto& cable = std::any_cast<CableDescription&>(own);
  return {&cable.point_bodies, cable.points_place};
}

void free_cable(std::any& own) {
  auto& settings = std::any_cast<CableDescription&>(own).settings;
  settings.tension = {.min = 0.0};
  settings.displacement = {};
}

}  // namespace

const ActuatorKind& cable_kind() {
  static const ActuatorKind kind{
      .words = &builder::kCableKind,
      .description = "A sliding cable.",
      .table = forms::cable_table,
      .read = [](const Fields& fields, const ReadContext& context) -> std::any {
        return read_cable(fields, context);
      },
      .add = add_cable,
      .bodies = bodies_of_cable,
      .free_effort = free_cable};
  return kind;
}

}  // namespace sinew::scene
