// The keys that joints share.
#include <iterator>
#include <utility>

#include "sinew/constraint/joint_type.hpp"
#include "sinew/scene/joint_fields.hpp"

namespace sinew::scene::forms {

namespace {

using constraint::JointType;

// The limits of one motion of a joint.
Key motion_limits(const char* name, const Measure& measure, const char* example) {
  const auto bound = [&](const char* key, const char* at, const char* description) {
    return Key{
        .name = key, .forms = {quantity(measure)}, .example = at, .description = description};
  };
  return {.name = name,
          .forms = {table(make_table(
              {.name = std::string("limits of a joint's ") + name,
               .description =
                   "Stops, measured from the initial pose of the scene; 0 lies between them.",
               .keys = {bound("min", measure.unit == std::string_view("m") ? "-10 mm" : "-45 deg",
                              "Smallest value."),
                        bound("max", measure.unit == std::string_view("m") ? "40 mm" : "90 deg",
                              "Largest value.")}}))},
          .example = example,
          .default_text = "{}",
          .description = std::string("Limits of the ") + name + "."};
}

// The limits and the friction of the motions that a joint leaves free.
std::vector<Key> motion_keys_of(JointType joint) {
  const std::string type = constraint::joint_type_name(joint);
  const bool turns = constraint::turns_about_axis(joint);
  const bool slides = constraint::slides_along_axis(joint);
  std::vector<Key> keys;
  if (turns || slides) {
    KeyTable limits{.name = "limits of a " + type, .description = "Stops of the joint."};
    if (turns) limits.keys.push_back(motion_limits("angle", angle(), "{max: 90 deg}"));
    if (slides) {
      limits.keys.push_back(motion_limits("displacement", length(), "{max: 40 mm}"));
    }
    keys.push_back({.name = "limits",
                    .forms = {table(make_table(std::move(limits)))},
                    .example = turns ? "{angle: {min: 0 deg, max: 90 deg}}"
                                     : "{displacement: {min: 0 mm, max: 40 mm}}",
                    .default_text = "{}",
                    .description = "Limits of the joint's motion; no limits by default."});
  }
  if (turns != slides) {
    keys.push_back(
        {.name = "friction",
         .forms = {quantity(turns ? torque() : force(), non_negative())},
         .example = turns ? "1 mN m" : "0.1 N",
         .default_text = turns ? "0 N m" : "0 N",
         .description = "Coulomb friction: the force or moment needed to move the joint."});
  }
  return keys;
}

}  // namespace

Key bodies_key(const char* example, const char* description) {
  return {.name = "bodies",
          .forms = {list({reference("bodies", {{"world", "The fixed world."}})}, 2, 2)},
          .example = example,
          .description = description,
          .required = true};
}

std::shared_ptr<const KeyTable> rigid_joint_table(JointType type, const char* description,
                                                  std::vector<Key> axes) {
  KeyTable joint{.name = std::string("joint: type ") + constraint::joint_type_name(type),
                 .description = description,
                 .keys = {bodies_key("[box, cover]",
                                     "Two bodies, each rigid or an arm of constant curvature; or "
                                     "one of them and `world`."),
                          {.name = "point",
                           .forms = {vector(length())},
                           .example = "0 0 40 mm",
                           .description = "Position of the joint in the initial pose of the scene.",
                           .required = true}}};
  std::ranges::move(axes, std::back_inserter(joint.keys));
  std::ranges::move(motion_keys_of(type), std::back_inserter(joint.keys));
  return make_table(std::move(joint));
}

Key joint_axis_key() {
  return {.name = "axis",
          .forms = axis_forms(),
          .example = "1 0 0",
          .description = "Direction of the axis in the initial pose; any non-zero length.",
          .required = true};
}

std::shared_ptr<const KeyTable> body_point_table() {
  return make_table({.name = "point of a body",
                     .description = "A point in the material of a body other than the cable's.",
                     .keys = {body_key(),
                              {.name = "point",
                               .forms = {vector(length())},
                               .example = "0 10 80 mm",
                               .description = "Position at rest.",
                               .required = true}}});
}

}  // namespace sinew::scene::forms
