// Actuators of types motor and linear-motor.
#include <any>
#include <memory>
#include <string>
#include <utility>

#include "sinew/builder/model_builder.hpp"
#include "sinew/builder/motor_settings.hpp"
#include "sinew/scene/actuator_fields.hpp"
#include "sinew/scene/actuator_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> joint_table(const char* description, const char* joint_text,
                                            DriveWords words) {
  KeyTable table{.name = std::string("actuator: type ") + words.kind->word,
                 .description = description,
                 .keys = {{.name = "joint",
                           .forms = {reference("joints")},
                           .example = "lid",
                           .description = joint_text,
                           .required = true}}};
  words.undriven = "Command. Default: no effort until commanded.";
  for (Key& key : drive_keys(words)) table.keys.push_back(std::move(key));
  return make_table(std::move(table));
}

std::shared_ptr<const KeyTable> motor_table() {
  DriveWords words{.kind = &builder::kMotorKind};
  words.effort_measure = torque();
  words.effort_rate = torque_rate();
  words.effort_range = any();
  words.effort_example = "1 N m";
  words.effort_rate_example = "10 Nm/s";
  words.effort_value = "0.2 N m";
  words.motion_measure = angle();
  words.motion_rate = frequency();
  words.motion_example = "90 deg";
  words.motion_rate_example = "1 1/s";
  words.motion_value = "30 deg";
  words.motion_text = "Angle of the hinge, 0 at rest.";
  words.inputs = {
      input_key("velocity", angular_speed(), "60 deg/s",
                "Angular velocity: each step advances the hinge from its present angle.")};
  return joint_table("A motor in a hinge.", "The hinge.", words);
}

std::shared_ptr<const KeyTable> linear_motor_table() {
  DriveWords words{.kind = &builder::kLinearMotorKind};
  words.effort_measure = force();
  words.effort_rate = force_rate();
  words.effort_range = any();
  words.effort_example = "5 N";
  words.effort_rate_example = "10 N/s";
  words.effort_value = "1 N";
  words.motion_measure = length();
  words.motion_rate = speed();
  words.motion_example = "20 mm";
  words.motion_rate_example = "50 mm/s";
  words.motion_value = "10 mm";
  words.motion_text = "Displacement of the slider, 0 at rest.";
  words.inputs = {input_key("velocity", speed(), "5 mm/s",
                            "Velocity: each step advances the slider from its present position.")};
  return joint_table("A motor on a slider.", "The slider.", words);
}

}  // namespace
}  // namespace forms

namespace {

MotorDescription read_motor(const Fields& fields, const model::ActuatorKind& kind) {
  MotorDescription motor;
  fields.read("joint", motor.joint);
  motor.joint_place = fields.place("joint");
  motor.settings.linear = &kind == &builder::kLinearMotorKind;
  read_limits(fields, kind, motor.settings.effort, motor.settings.motion);
  return motor;
}

void add_motor(const ActuatorSite& site) {
  const auto& motor = *site.actuator.as<MotorDescription>();
  builder::MotorSettings settings = site.complete(motor.settings);
  settings.joint = site.joint_of(motor.joint);
  site.builder.add_motor(settings);
}

}  // namespace

const ActuatorKind& motor_kind() {
  static const ActuatorKind kind{.words = &builder::kMotorKind,
                                 .description = "In a hinge.",
                                 .table = forms::motor_table,
                                 .read = [](const Fields& fields, const ReadContext&) -> std::any {
                                   return read_motor(fields, builder::kMotorKind);
                                 },
                                 .add = add_motor,
                                 .on_body = false};
  return kind;
}

const ActuatorKind& linear_motor_kind() {
  static const ActuatorKind kind{.words = &builder::kLinearMotorKind,
                                 .description = "On a slider.",
                                 .table = forms::linear_motor_table,
                                 .read = [](const Fields& fields, const ReadContext&) -> std::any {
                                   return read_motor(fields, builder::kLinearMotorKind);
                                 },
                                 .add = add_motor,
                                 .on_body = false};
  return kind;
}

}  // namespace sinew::scene
