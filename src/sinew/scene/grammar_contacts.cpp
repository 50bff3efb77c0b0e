// The tables of contacts.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

Key radius_key(const char* example) {
  return {.name = "radius",
          .forms = {quantity(length(), positive())},
          .example = example,
          .description = "Its radius.",
          .required = true};
}

std::shared_ptr<const KeyTable> solid_plane() {
  return make_table(
      {.name = "solid plane",
       .description = "A half space that is solid below a plane.",
       .keys = {{.name = "point",
                 .forms = {vector(length())},
                 .example = "0 0 0 mm",
                 .default_text = "0 0 0 mm",
                 .description = "A point of the plane."},
                {.name = "normal",
                 .forms = {vector(plain_number())},
                 .example = "0 0 1",
                 .default_text = "0 0 1",
                 .description = "Normal, outward from the solid; any non-zero length."}}});
}

std::shared_ptr<const KeyTable> solid_sphere() {
  return make_table({.name = "solid sphere",
                     .description = "A ball, touched from outside.",
                     .keys = {{.name = "centre",
                               .forms = {vector(length())},
                               .example = "0 0 195 mm",
                               .description = "Its centre.",
                               .required = true},
                              radius_key("10 mm")}});
}

std::shared_ptr<const KeyTable> solid_capsule() {
  return make_table({.name = "solid capsule",
                     .description = "All points within a radius of a segment: a rod with "
                                    "hemispherical ends, touched from outside.",
                     .keys = {{.name = "ends",
                               .forms = {list({vector(length())}, 2, 2)},
                               .example = "[-50 0 40 mm, 50 0 40 mm]",
                               .description = "The ends of the segment.",
                               .required = true},
                              radius_key("5 mm")}});
}

std::shared_ptr<const KeyTable> contact_solid_table() {
  return make_table({.name = "surface of a contact",
                     .description = "Exactly one of plane, sphere and capsule.",
                     .keys = {{.name = "plane",
                               .forms = {table(solid_plane())},
                               .example = "{point: 0 0 0 mm, normal: 0 0 1}",
                               .description = "A plane."},
                              {.name = "sphere",
                               .forms = {table(solid_sphere())},
                               .example = "{centre: 0 0 0 mm, radius: 10 mm}",
                               .description = "A ball."},
                              {.name = "capsule",
                               .forms = {table(solid_capsule())},
                               .example = "{ends: [-50 0 40 mm, 50 0 40 mm], radius: 5 mm}",
                               .description = "A rod with hemispherical ends."}},
                     .alternatives = {{{"plane", "sphere", "capsule"}, true}}});
}

std::shared_ptr<const KeyTable> nodes_table() {
  return region_table("nodes of a contact",
                      "Surface nodes that may make contact, selected in the mesh at "
                      "rest. Exactly one of box, sphere, plane and set.");
}

}  // namespace

Form contact_form() {
  KeyTable contact{.name = "contact",
                   .description =
                       "A surface that points of a body may touch but not penetrate, with Coulomb "
                       "friction. Points near the surface add three rows each to every step. "
                       "`sinew run` records the resultant force in run.csv.",
                   .keys = {body_key()},
                   .alternatives = {{{"body", "between"}, true}, {{"nodes", "points"}, false}}};
  contact.keys.front().required = false;
  contact.keys.push_back(
      {.name = "between",
       .forms = {list({touching_body()}, 2, 2), choice({{"all", "All pairs of bodies."}})},
       .example = "[finger, box]",
       .description =
           "Two bodies, in place of body and surface. Their surfaces touch. A body named twice "
           "touches itself. Spheres, boxes, capsules and cylinders touch each other with their "
           "exact shapes. If you name nodes or points of a body with elements or of an arm, these "
           "touch a rigid body's shape or hull. `all`: every pair, except pairs that joints "
           "connect, pairs of fixed bodies, and pairs with an entry of their own; the contacts are "
           "called NAME-FIRST-SECOND, where a plane is the second."});
  contact.keys.push_back({.name = "except",
                          .forms = {list({list({touching_body()}, 2, 2)})},
                          .example = "[[palm, finger]]",
                          .description = "Pairs that may pass through each other. Only with "
                                         "`between: all`."});
  contact.keys.push_back({.name = "surface",
                          .forms = {table(contact_solid_table())},
                          .example = "{plane: {point: 0 0 0 mm, normal: 0 0 1}}",
                          .description = "The surface, fixed in the world or moved by `motion`."});
  contact.keys.push_back(
      {.name = "nodes",
       .forms = {table(nodes_table()), list({table(nodes_table())})},
       .example = "{set: z_min}",
       .description =
           "Surface nodes that may make contact: those of one region or of several. Default, if "
           "there are no `points` either: all surface nodes that are not fixed; for a rigid body, "
           "its whole shape."});
  contact.keys.push_back({.name = "points",
                          .forms = {table(point_file_table()), list({vector(length())})},
                          .example = "[0 0 195 mm]",
                          .description = "Points in the mesh at rest, in place of nodes."});
  contact.keys.push_back(outside_key());
  contact.keys.push_back(
      {.name = "friction",
       .forms = {quantity(plain_number(), non_negative())},
       .example = "0.5",
       .default_text = "0",
       .description = "Coulomb friction coefficient. Typical values are 0.05 to 0.2 for coated "
                      "surfaces on rigid ones and 0.6 to 0.9 for silicone on steel."});
  contact.keys.push_back(
      {.name = "kinetic_friction",
       .forms = {quantity(plain_number(), positive())},
       .example = "0.4",
       .description = "Friction coefficient of sliding points, at most `friction`, which then "
                      "applies to points at rest. A point counts as sliding if it slid in the "
                      "previous step. Default: the value of `friction`."});
  contact.keys.push_back(
      {.name = "restitution",
       .forms = {quantity(plain_number(), {.min = 0.0, .max = 1.0})},
       .example = "0.8",
       .description = "Coefficient of restitution of impacts, for `integrator: event-driven`. It "
                      "applies only between rigid bodies; deformable bodies rebound by their "
                      "elasticity. Default: the integrator's value."});
  contact.keys.push_back(
      {.name = "aggregate",
       .forms = {quantity(length(), positive())},
       .example = "5 mm",
       .description = "Size of zones whose points act as one: fewer unknowns and the same total "
                      "force. Choose a few edge lengths of the mesh. Only for deformable bodies. "
                      "Default: every point acts by itself."});
  contact.keys.push_back(
      {.name = "motion",
       .forms = {table(motion_table("motion of a surface",
                                    "Motion of the surface from its declared pose: a rotation "
                                    "about an axis, then a translation."))},
       .example = "{z: {ramp: {to: -4 mm, duration: 1 s}}}",
       .description = "Motion of the surface. Default: at rest."});
  return table(make_table(std::move(contact)));
}

}  // namespace sinew::scene::forms
