// The tables of joints.
#include "sinew/constraint/joint_type.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

using constraint::JointType;

std::shared_ptr<const KeyTable> weld_region_table() {
  return region_table("region of a weld",
                      "Nodes of the first body, selected in the mesh at rest. "
                      "Exactly one of box, sphere, plane and set.");
}

Key bodies_key(const char* example, const char* description) {
  return {.name = "bodies",
          .forms = {list({reference("bodies", {{"world", "The fixed world."}})}, 2, 2)},
          .example = example,
          .description = description,
          .required = true};
}

std::shared_ptr<const KeyTable> weld_table() {
  return make_table(
      {.name = "joint: type weld",
       .description = "Bonds two bodies: nodes of the first keep their position in the material of "
                      "the second. Meshes need not match; name the body with the finer mesh first. "
                      "In statics a body may be held by its joints alone. By default, the weld "
                      "takes all surface nodes of the first body that lie in or on the second. Two "
                      "rigid bodies, or one and the world, become one.",
       .keys = {bodies_key("[upper, lower]",
                           "The two bodies. Either may be a rigid body or `world`."),
                {.name = "region",
                 .forms = {table(weld_region_table())},
                 .example = "{set: z_min}",
                 .description = "Nodes of the first body that are welded."},
                {.name = "points",
                 .forms = {table(point_file_table()), list({vector(length())})},
                 .example = "[0 0 60 mm, 10 0 60 mm, 0 10 60 mm]",
                 .description = "Points of the first body, in place of nodes. Three that are not "
                                "collinear suppress all relative motion."},
                outside_key()},
       .alternatives = {{{"region", "points"}, false}}});
}

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

struct JointWords {
  JointType type;
  const char* description;
  int axes = 0;
};

std::shared_ptr<const KeyTable> joint_table(const JointWords& words) {
  const std::string type = constraint::joint_type_name(words.type);
  const bool turns = constraint::turns_about_axis(words.type);
  const bool slides = constraint::slides_along_axis(words.type);
  KeyTable joint{.name = "joint: type " + type,
                 .description = words.description,
                 .keys = {bodies_key("[box, cover]",
                                     "Two bodies, each rigid or an arm of constant curvature; or "
                                     "one of them and `world`."),
                          {.name = "point",
                           .forms = {vector(length())},
                           .example = "0 0 40 mm",
                           .description = "Position of the joint in the initial pose of the scene.",
                           .required = true}}};
  if (words.axes == 1) {
    joint.keys.push_back(
        {.name = "axis",
         .forms = axis_forms(),
         .example = "1 0 0",
         .description = "Direction of the axis in the initial pose; any non-zero length.",
         .required = true});
  }
  if (words.axes == 2) {
    joint.keys.push_back({.name = "axes",
                          .forms = {list({vector(plain_number())}, 2, 2)},
                          .example = "[1 0 0, 0 1 0]",
                          .description = "The axis fixed in the first body and the one fixed in "
                                         "the second, normal to each other.",
                          .required = true});
  }
  if (turns || slides) {
    KeyTable limits{.name = "limits of a " + type, .description = "Stops of the joint."};
    if (turns) limits.keys.push_back(motion_limits("angle", angle(), "{max: 90 deg}"));
    if (slides) {
      limits.keys.push_back(motion_limits("displacement", length(), "{max: 40 mm}"));
    }
    joint.keys.push_back({.name = "limits",
                          .forms = {table(make_table(std::move(limits)))},
                          .example = turns ? "{angle: {min: 0 deg, max: 90 deg}}"
                                           : "{displacement: {min: 0 mm, max: 40 mm}}",
                          .default_text = "{}",
                          .description = "Limits of the joint's motion; no limits by default."});
  }
  if (turns != slides) {
    joint.keys.push_back(
        {.name = "friction",
         .forms = {quantity(turns ? torque() : force(), non_negative())},
         .example = turns ? "1 mN m" : "0.1 N",
         .default_text = turns ? "0 N m" : "0 N",
         .description = "Coulomb friction: the force or moment needed to move the joint."});
  }
  return make_table(std::move(joint));
}

Choice joint(const JointWords& words) {
  return {.word = constraint::joint_type_name(words.type),
          .description = words.description,
          .table = joint_table(words)};
}

}  // namespace

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

Form joint_form() {
  return variants(
      "type", {{.word = "weld", .description = "Bonds two bodies.", .table = weld_table()},
               joint({JointType::ball, "Two points coincide.", 0}),
               joint({JointType::hinge, "Turns about an axis.", 1}),
               joint({JointType::slider, "Slides along an axis.", 1}),
               joint({JointType::cylindrical, "Turns about an axis and slides along it.", 1}),
               joint({JointType::universal, "Turns about two axes, one fixed in each body.", 2})});
}

}  // namespace sinew::scene::forms
