#include "scene_kinds.hpp"

#include <any>
#include <memory>
#include <utility>

#include "sinew/builder/model_builder.hpp"
#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/controller_kind.hpp"
#include "sinew/scene/grammar_forms.hpp"

#include "couple.hpp"
#include "proportional.hpp"
#include "speedometer.hpp"
#include "spring_point.hpp"
#include "strut.hpp"

namespace sinew::testing {

namespace {

using namespace scene::forms;
using scene::KeyTable;

std::shared_ptr<const KeyTable> spring_point_table() {
  return make_table({.name = "body: type spring-point",
                     .description = "A point with mass on a spring to its rest position.",
                     .keys = {{.name = "at",
                               .forms = {vector(length())},
                               .example = "60 80 40 mm",
                               .description = "Rest position.",
                               .required = true},
                              {.name = "mass",
                               .forms = {quantity(mass(), positive())},
                               .example = "10 g",
                               .description = "Mass.",
                               .required = true},
                              {.name = "stiffness",
                               .forms = {quantity(stiffness(), positive())},
                               .example = "50 N/m",
                               .description = "Stiffness of the spring.",
                               .required = true}}});
}

void read_spring_point(const scene::Fields& fields, const scene::ReadContext&,
                       scene::BodyDescription& body) {
  SpringPointSettings settings;
  settings.name = body.name;
  fields.read("at", settings.at);
  fields.read("mass", settings.mass);
  fields.read("stiffness", settings.stiffness);
  body.own = std::move(settings);
}

std::unique_ptr<mechanics::BodyModel> make_spring_point(const scene::BodySite& site) {
  SpringPointSettings settings = *site.body.as<SpringPointSettings>();
  settings.gravity = site.scene.gravity;
  return std::make_unique<SpringPointModel>(std::move(settings));
}

std::shared_ptr<const KeyTable> strut_table() {
  KeyTable strut{.name = "actuator: type strut",
                 .description = "A strut from a point of a body to a point of the world.",
                 .keys = {body_key(),
                          {.name = "point",
                           .forms = {vector(length())},
                           .example = "0 0 60 mm",
                           .description = "Point of the body, at rest.",
                           .required = true},
                          {.name = "anchor",
                           .forms = {vector(length())},
                           .example = "40 60 90 mm",
                           .description = "Point of the world.",
                           .required = true}}};
  const scene::forms::DriveWords words =
      line_words(kStrutKind, any(), "", "How much shorter the strut is than at rest.",
                 "Command. Default: no force until commanded.");
  for (scene::Key& key : drive_keys(words)) strut.keys.push_back(std::move(key));
  return make_table(std::move(strut));
}

std::any read_strut(const scene::Fields& fields, const scene::ReadContext&) {
  StrutSettings strut;
  fields.read("point", strut.point);
  fields.read("anchor", strut.anchor);
  scene::read_limits(fields, kStrutKind, strut.pull, strut.shortening);
  return strut;
}

void add_strut_of(const scene::ActuatorSite& site) {
  add_strut(site.builder.data(), site.on_body(*site.actuator.as<StrutSettings>()));
}

std::shared_ptr<const KeyTable> proportional_table() {
  return make_table({.name = "controller: type proportional",
                     .description = "Descends the error of its first effector.",
                     .keys = {tasks_key(true),
                              driven_key(),
                              {.name = "gain",
                               .forms = {quantity(plain_number(), positive())},
                               .example = "0.5",
                               .default_text = "0.5",
                               .description = "Part of the error that a step is to remove."}}});
}

std::any read_proportional(const scene::ControllerEntry& entry) {
  ProportionalSettings settings{.name = entry.controller.name};
  entry.fields.read("gain", settings.gain);
  return settings;
}

control::ControllerSettings build_proportional(const scene::ControllerSite& site) {
  return control::settings_for<Proportional>(site.targets,
                                             *site.controller.as<ProportionalSettings>());
}

constexpr scene::BodyKind kSpringPoint{.word = "spring-point",
                                       .description = "A point on a spring.",
                                       .noun = "a point on a spring",
                                       .table = spring_point_table,
                                       .read = read_spring_point,
                                       .make = make_spring_point,
                                       .is_searched = false};
constexpr scene::ActuatorKind kStrut{.words = &kStrutKind,
                                     .description = "A strut.",
                                     .table = strut_table,
                                     .read = read_strut,
                                     .add = add_strut_of};
constexpr scene::ControllerKind kProportional{.word = "proportional",
                                              .description = "A proportional law.",
                                              .table = proportional_table,
                                              .read = read_proportional,
                                              .build = build_proportional};

}  // namespace

void register_toys() {
  static const bool done =
      (scene::register_body_kind(kSpringPoint), scene::register_actuator_kind(kStrut),
       scene::register_sensor_kind(kSpeedometer), scene::register_load_kind(kCouple),
       scene::register_controller_kind(kProportional), true);
  static_cast<void>(done);
}

}  // namespace sinew::testing
