// The tables of rigid bodies.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

Key shape_form(const char* name, const char* example, const char* description,
               std::vector<Key> keys) {
  return {.name = name,
          .forms = {table(make_table({.name = std::string("shape: ") + name,
                                      .description = description,
                                      .keys = std::move(keys)}))},
          .example = example,
          .description = description};
}

std::shared_ptr<const KeyTable> shape_table() {
  return make_table(
      {.name = "shape of a rigid body",
       .description = "A shape centred on the body's origin.",
       .keys = {{.name = "box",
                 .forms = {vector(length())},
                 .example = "40 30 20 mm",
                 .description =
                     "A box along the body's axes, given by the full lengths of its edges."},
                shape_form("sphere", "{radius: 15 mm}", "A ball.",
                           {shape_length("radius", "15 mm", "Its radius.")}),
                shape_form(
                    "capsule", "{radius: 10 mm, length: 40 mm}",
                    "A cylinder about z with hemispherical ends.",
                    {shape_length("radius", "10 mm",
                                  "Radius of the cylinder and of its hemispherical ends."),
                     shape_length("length", "40 mm", "Length of the cylinder, without its ends.")}),
                shape_form("cylinder", "{radius: 10 mm, height: 40 mm}", "A cylinder about z.",
                           {shape_length("radius", "10 mm", "Its radius."),
                            shape_length("height", "40 mm", "Along z.")}),
                shape_form("plane", "{}",
                           "The half-space below the plane z = 0 of the body's axes: a floor or a "
                           "wall. The body is `fixed` or has a `motion`. Only contacts can name "
                           "it; it is not among the bodies of the simulation.",
                           {})},
       .alternatives = {{{"box", "sphere", "capsule", "cylinder", "plane"}, true}}});
}

std::shared_ptr<const KeyTable> solid_table() {
  return make_table(
      {.name = "mesh of a rigid body",
       .description = "A closed surface: an STL, OBJ or PLY file, or the surface of a mesh in a "
                      "VTK legacy, VTU or Gmsh file. The body has the origin and axes of the file.",
       .keys = {mesh_file_key("part.stl"),
                file_unit_key(),
                file_scale_key(),
                {.name = "use",
                 .forms = {choice({{"surface", "Its triangles make contact."},
                                   {"convex", "Its convex hull makes contact."}})},
                 .example = "convex",
                 .default_text = "surface",
                 .description = "Geometry used in contacts. Mass, drawing and attached points "
                                "always use the surface."}}});
}

}  // namespace

std::shared_ptr<const KeyTable> rigid_table() {
  return make_table(
      {.name = "body: type rigid",
       .description = "A rigid body of homogeneous material.",
       .keys = {{.name = "shape",
                 .forms = {table(shape_table())},
                 .example = "{box: 40 30 20 mm}",
                 .description = "The shape, centred on the body's origin."},
                {.name = "mesh",
                 .forms = {table(solid_table())},
                 .example = "{file: part.stl, unit: mm}",
                 .description = "A solid enclosed by a surface, in place of a shape."},
                {.name = "density",
                 .forms = {quantity(density(), positive())},
                 .example = "1200 kg/m^3",
                 .description = "Density."},
                {.name = "mass",
                 .forms = {quantity(mass(), positive())},
                 .example = "100 g",
                 .description = "Total mass, in place of a density."},
                {.name = "inertia",
                 .forms = {vector(inertia())},
                 .example = "1e-5 2e-5 2.5e-5 kg m^2",
                 .description = "Moments of inertia about the body's axes through the centre of "
                                "mass. Default: computed from the shape.",
                 .only_with = "mass"},
                {.name = "centre_of_mass",
                 .forms = {vector(length())},
                 .example = "0 0 5 mm",
                 .description =
                     "Centre of mass in the body's frame. Default: computed from the shape.",
                 .only_with = "inertia"},
                {.name = "pose",
                 .forms = {table(pose_table())},
                 .example = "{position: 0 0 30 mm, rotation: {axis: 0 0 1, angle: 20 deg}}",
                 .default_text = "{}",
                 .description = "Position and rotation at the start."},
                {.name = "velocity",
                 .forms = {table(velocity_table())},
                 .example = "{linear: 0 0 -1 m/s}",
                 .default_text = "{}",
                 .description = "Initial motion; at rest by default."},
                {.name = "fixed",
                 .forms = {boolean()},
                 .example = "true",
                 .default_text = "false",
                 .description = "Whether the body is fixed in the world; it then needs no mass."},
                {.name = "motion",
                 .forms = {body_motion_form()},
                 .example = "{z: {ramp: {to: 10 mm, duration: 1 s}}}",
                 .description = "Prescribed motion of the body, regardless of the forces on it; it "
                                "then needs no mass. Default: it moves freely, or is fixed."}},
       .alternatives = {{{"shape", "mesh"}, true}, {{"density", "mass"}, false}}});
}

}  // namespace sinew::scene::forms
