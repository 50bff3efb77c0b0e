// The tables of where bodies are, how they start and how they are moved.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

std::shared_ptr<const KeyTable> pose_rotation_table() {
  return make_table({.name = "rotation",
                     .description = "A rotation about an axis.",
                     .keys = {{.name = "axis",
                               .forms = axis_forms(),
                               .example = "0 0 1",
                               .description = "Direction of the axis; any non-zero length.",
                               .required = true},
                              {.name = "angle",
                               .forms = {quantity(angle())},
                               .example = "20 deg",
                               .description = "Angle, right-handed about the axis.",
                               .required = true}}});
}

Key position_key(const char* description) {
  return {.name = "position",
          .forms = {vector(length())},
          .example = "0 0 30 mm",
          .default_text = "0 0 0 m",
          .description = description};
}

Key rotation_key(const char* description) {
  return {.name = "rotation",
          .forms = {vector(angle()), table(pose_rotation_table())},
          .example = "{axis: 0 0 1, angle: 20 deg}",
          .default_text = "0 0 0 rad",
          .description = description};
}

}  // namespace

std::shared_ptr<const KeyTable> pose_table() {
  return make_table({.name = "pose",
                     .description = "Pose of a body at the start.",
                     .keys = {position_key("Position of the body's origin: that of its mesh file "
                                           "or shape."),
                              rotation_key("Rotation of the body's axes about its origin: an axis "
                                           "and an angle, or a rotation vector.")}});
}

// A rotation cannot give all directions exactly: the cosine of 90 degrees is not zero.
std::shared_ptr<const KeyTable> arm_pose_table() {
  return make_table(
      {.name = "pose of an arm",
       .description = "Pose of an arm at rest. Without a rotation it hangs along -z and bends "
                      "towards x.",
       .keys = {position_key("Position of the base."),
                rotation_key("Rotation about the base, from hanging: an axis and an angle, or a "
                             "rotation vector. In place of direction and side."),
                {.name = "direction",
                 .forms = {vector(plain_number())},
                 .example = "0 0 1",
                 .default_text = "0 0 -1",
                 .description = "Direction of the arm at rest."},
                {.name = "side",
                 .forms = {vector(plain_number())},
                 .example = "0 1 0",
                 .default_text = "1 0 0",
                 .description = "Direction of bending for positive angles; only the component "
                                "normal to the arm's direction counts."}},
       .alternatives = {{{"rotation", "direction"}, false}}});
}

std::shared_ptr<const KeyTable> velocity_table() {
  return make_table(
      {.name = "velocity",
       .description = "Rigid-body motion at the start. It acts in dynamics only.",
       .keys = {{.name = "linear",
                 .forms = {vector(speed())},
                 .example = "0 0 -1 m/s",
                 .default_text = "0 0 0 m/s",
                 .description = "Velocity of the centre of mass."},
                {.name = "angular",
                 .forms = {vector(angular_speed())},
                 .example = "0 0 20 rad/s",
                 .default_text = "0 0 0 rad/s",
                 .description = "Angular velocity about the centre of mass, in world axes."}}});
}

std::shared_ptr<const KeyTable> motion_table(const char* name, const char* description) {
  const auto along = [](const char* axis) {
    return Key{.name = axis,
               .forms = {quantity(length()), table(signal_table(length(), "10 mm"))},
               .example = "{sine: {amplitude: 10 mm, period: 2 s}}",
               .default_text = "0 mm",
               .description = std::string("Along ") + axis + "."};
  };
  return make_table(
      {.name = name,
       .description = description,
       .keys = {along("x"),
                along("y"),
                along("z"),
                {.name = "angle",
                 .forms = {quantity(angle()), table(signal_table(angle(), "90 deg"))},
                 .example = "{ramp: {to: 90 deg, duration: 2 s}}",
                 .default_text = "0 rad",
                 .description = "Angle of the rotation from rest."},
                {.name = "axis",
                 .forms = {vector(plain_number())},
                 .example = "0 1 0",
                 .default_text = "0 0 1",
                 .description = "Direction of the rotation axis; any non-zero length."},
                {.name = "centre",
                 .forms = {vector(length())},
                 .example = "0 0 0 mm",
                 .default_text = "0 0 0 mm",
                 .description = "A point on the rotation axis, at rest."}}});
}

Form body_motion_form() {
  return table(motion_table("motion",
                            "Prescribed motion of a body: a rotation about an axis, then a "
                            "translation, from its pose at the start."));
}

}  // namespace sinew::scene::forms
