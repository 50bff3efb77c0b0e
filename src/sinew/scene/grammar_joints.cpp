// The tables of joints: what holds bodies together.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

std::shared_ptr<const KeyTable> weld_region_table() {
  return make_table({.name = "region of a weld",
                     .description = "Nodes of the first body, selected in the mesh at rest. "
                                    "Exactly one of box, sphere, plane and set.",
                     .keys = region_keys("Nodes"),
                     .alternatives = {{{"box", "sphere", "plane", "set"}, true}}});
}

std::shared_ptr<const KeyTable> weld_table() {
  return make_table(
      {.name = "joint: type weld",
       .description = "Bonds two bodies: nodes of the first keep their position in the material of "
                      "the second. Meshes need not match; name the body with the finer mesh first. "
                      "In statics a body may be held by its welds alone. Without region and "
                      "points: all surface nodes of the first body that lie in or on the second.",
       .keys = {{.name = "bodies",
                 .forms = {list({reference("bodies")}, 2, 2)},
                 .example = "[upper, lower]",
                 .description = "The two bodies.",
                 .required = true},
                {.name = "region",
                 .forms = {table(weld_region_table())},
                 .example = "{set: z_min}",
                 .description = "Which nodes of the first body are welded."},
                {.name = "points",
                 .forms = {table(point_file_table()), list({vector(length())})},
                 .example = "[0 0 60 mm, 10 0 60 mm, 0 10 60 mm]",
                 .description = "Points of the first body, in place of nodes. Three that are not "
                                "collinear suppress all relative motion."},
                outside_key()},
       .alternatives = {{{"region", "points"}, false}}});
}

}  // namespace

std::shared_ptr<const KeyTable> body_point_table() {
  return make_table({.name = "point of a body",
                     .description = "A point in the material of another body than the cable's.",
                     .keys = {body_key(),
                              {.name = "point",
                               .forms = {vector(length())},
                               .example = "0 10 80 mm",
                               .description = "Where it is at rest.",
                               .required = true}}});
}

Form joint_form() {
  return variants("type", {{.word = "weld", .description = "One body.", .table = weld_table()}});
}

}  // namespace sinew::scene::forms
