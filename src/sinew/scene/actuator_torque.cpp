// Actuators of type torque.
#include <any>
#include <memory>
#include <utility>

#include "sinew/builder/model_builder.hpp"
#include "sinew/builder/torque_settings.hpp"
#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> torque_table() {
  KeyTable table{
      .name = "actuator: type torque",
      .description = "A torque on the bend of a segment of a constant-curvature arm.",
      .keys = {body_key(),
               {.name = "segment",
                .forms = {integer(0, 10000)},
                .example = "1",
                .description = "Index of the segment from the base; the first is 0.",
                .required = true},
               {.name = "towards",
                .forms = {choice({{"side", "Towards a section's x."},
                                  {"across", "Towards a section's y; spatial segments only."}})},
                .example = "across",
                .default_text = "side",
                .description = "Direction in which a positive torque bends the segment."}}};
  DriveWords words{.kind = &builder::kTorqueKind};
  words.effort_measure = torque();
  words.effort_rate = torque_rate();
  words.effort_range = any();
  words.effort_example = "0.18 N m";
  words.effort_rate_example = "1 Nm/s";
  words.effort_value = "0.05 N m";
  words.motion_measure = angle();
  words.motion_rate = frequency();
  words.motion_example = "90 deg";
  words.motion_rate_example = "1 1/s";
  words.motion_value = "20 deg";
  words.motion_text = "Bending angle of the segment.";
  words.undriven = "Command. Default: no torque until commanded.";
  for (Key& key : drive_keys(words)) table.keys.push_back(std::move(key));
  return make_table(std::move(table));
}

}  // namespace
}  // namespace forms

namespace {

builder::TorqueSettings read_torque(const Fields& fields) {
  using Towards = builder::TorqueSettings::Towards;
  builder::TorqueSettings torque;
  fields.read("segment", torque.segment);
  fields.read_choice("towards", torque.towards,
                     {{"side", Towards::side}, {"across", Towards::across}});
  read_limits(fields, builder::kTorqueKind, torque.torque, torque.angle);
  return torque;
}

void add_torque(const ActuatorSite& site) {
  site.builder.add_torque(site.on_body(*site.actuator.as<builder::TorqueSettings>()));
}

}  // namespace

const ActuatorKind& torque_kind() {
  static const ActuatorKind kind{.words = &builder::kTorqueKind,
                                 .description = "On a bend.",
                                 .table = forms::torque_table,
                                 .read = [](const Fields& fields, const ReadContext&) -> std::any {
                                   return read_torque(fields);
                                 },
                                 .add = add_torque};
  return kind;
}

}  // namespace sinew::scene
