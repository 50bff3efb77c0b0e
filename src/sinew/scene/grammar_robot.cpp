// The tables of bodies: mesh, material, mass, damping, fixed regions.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

Key shape_length(const char* name, const char* example, const char* description) {
  return {.name = name,
          .forms = {quantity(length(), positive())},
          .example = example,
          .description = description,
          .required = true};
}

Key optional_length(const char* name, const char* example, const char* default_text,
                    const char* description) {
  Key key = shape_length(name, example, description);
  key.default_text = default_text;
  key.required = false;
  return key;
}

Key element_size() {
  return optional_length(
      "element_size", "5 mm", "",
      "Aimed edge length of the tetrahedra. Without: a few through the thinnest part.");
}

Choice shape(const char* word, const char* description, std::vector<Key> keys) {
  keys.push_back(element_size());
  return {.word = word,
          .description = description,
          .table = make_table({.name = std::string("mesh: shape ") + word,
                               .description = description,
                               .keys = std::move(keys)})};
}

Form mesh_shape() {
  return variants(
      "shape", {shape("block", "A box from the origin along the axes, z upwards.",
                      {shape_length("length", "100 mm", "Along x."),
                       shape_length("width", "20 mm", "Along y."),
                       shape_length("height", "20 mm", "Along z.")}),
                shape("cylinder", "A solid cylinder about z, its base at the origin.",
                      {shape_length("radius", "15 mm", "Outer radius."),
                       shape_length("height", "195 mm", "Along z.")}),
                shape("cone", "A solid truncated cone about z, its base at the origin.",
                      {shape_length("base_radius", "20 mm", "Radius at z = 0."),
                       shape_length("tip_radius", "8 mm", "Radius at the top."),
                       shape_length("height", "195 mm", "Along z.")}),
                shape("hollow-cylinder", "A tube about z, its base at the origin.",
                      {shape_length("inner_radius", "8 mm", "Radius of the bore."),
                       shape_length("outer_radius", "15 mm", "Outer radius."),
                       shape_length("height", "195 mm", "Along z.")}),
                shape("trunk", "A tapered trunk with bellows about z, its base at the origin.",
                      {optional_length("base_radius", "20 mm", "20 mm", "Outer radius at z = 0."),
                       optional_length("tip_radius", "12 mm", "8.5 mm", "Outer radius at the top."),
                       optional_length("height", "195 mm", "195 mm", "Along z."),
                       Key{.name = "bellows",
                           .forms = {integer(1, 1000)},
                           .example = "10",
                           .default_text = "9",
                           .description = "Number of bellows."},
                       optional_length("bellow_depth", "4 mm", "",
                                       "Depth of the grooves at z = 0; less towards the tip, as "
                                       "the radius. Without: a quarter of base_radius.")})});
}

std::shared_ptr<const KeyTable> mesh_file_table() {
  return make_table(
      {.name = "mesh: file",
       .description = "A mesh file: VTK legacy, VTU, or Gmsh 2.2 and 4.1, told by its content.",
       .keys = {{.name = "file",
                 .forms = {file()},
                 .example = "trunk.vtk",
                 .description = "Path of the mesh, relative to the scene file.",
                 .required = true},
                {.name = "unit",
                 .forms = {unit(length())},
                 .example = "mm",
                 .default_text = "m",
                 .description = "What one unit of the file's coordinates is."}}});
}

Form material_form() {
  Range above_zero = positive();
  above_zero.kind = ErrorKind::invalid_material;
  const Range poisson{.min = -1.0,
                      .max = 0.5,
                      .above_min = true,
                      .below_max = true,
                      .kind = ErrorKind::invalid_material};
  return table(make_table(
      {.name = "material",
       .description = "The elastic law and its constants.",
       .keys = {
           {.name = "model",
            .forms = {choice(
                {{"corotational", "Linear about the rotated element: large bending, small strain."},
                 {"linear", "Small displacements and strains."},
                 {"neo-hookean", "Hyperelastic.", true},
                 {"mooney-rivlin", "Hyperelastic.", true},
                 {"saint-venant-kirchhoff", "Hyperelastic.", true},
                 {"yeoh", "Hyperelastic.", true},
                 {"ogden", "Hyperelastic.", true}})},
            .example = "corotational",
            .default_text = "corotational",
            .description = "The elastic law."},
           {.name = "young_modulus",
            .forms = {quantity(stress(), above_zero)},
            .example = "450 kPa",
            .description = "Young's modulus.",
            .required = true},
           {.name = "poisson_ratio",
            .forms = {quantity(plain_number(), poisson)},
            .example = "0.45",
            .description = "Poisson's ratio, between -1 and 0.5. Linear tetrahedra lock near 0.5.",
            .required = true}}}));
}

std::shared_ptr<const KeyTable> sphere_table() {
  return make_table({.name = "sphere",
                     .description = "A ball.",
                     .keys = {{.name = "center",
                               .forms = {vector(length())},
                               .example = "0 0 195 mm",
                               .description = "Its center.",
                               .required = true},
                              {.name = "radius",
                               .forms = {quantity(length(), positive())},
                               .example = "10 mm",
                               .description = "Its radius.",
                               .required = true}}});
}

std::shared_ptr<const KeyTable> plane_table() {
  return make_table({.name = "plane",
                     .description = "A plane, and how far from it nodes still count.",
                     .keys = {{.name = "point",
                               .forms = {vector(length())},
                               .example = "0 0 0 mm",
                               .description = "A point of the plane.",
                               .required = true},
                              {.name = "normal",
                               .forms = {vector(plain_number())},
                               .example = "0 0 1",
                               .default_text = "0 0 1",
                               .description = "Its normal; any length but zero."},
                              {.name = "within",
                               .forms = {quantity(length(), non_negative())},
                               .example = "0.1 mm",
                               .default_text = "0.001 mm",
                               .description = "Nodes at most this far from the plane, on either "
                                              "side, are fixed."}}});
}

Form fixed_region() {
  return table(make_table(
      {.name = "fixed region",
       .description = "The nodes of the mesh at rest that do not move. Exactly one of the keys.",
       .keys = {{.name = "box",
                 .forms = {vector(length(), 6)},
                 .example = "-20 -20 0 20 20 20 mm",
                 .description = "Nodes inside the box: x y z of its lowest, then its highest "
                                "corner."},
                {.name = "sphere",
                 .forms = {table(sphere_table())},
                 .example = "{center: 0 0 0 mm, radius: 10 mm}",
                 .description = "Nodes inside the sphere."},
                {.name = "plane",
                 .forms = {table(plane_table())},
                 .example = "{point: 0 0 0 mm, normal: 0 0 1}",
                 .description = "Nodes on the plane."},
                {.name = "set",
                 .forms = {text()},
                 .example = "base",
                 .description = "Nodes of a named set of the mesh; `sinew info` lists them."}},
       .alternatives = {{{"box", "sphere", "plane", "set"}, true}}}));
}

std::shared_ptr<const KeyTable> damping_table() {
  return make_table(
      {.name = "damping",
       .description = "Rayleigh damping: mass times M plus stiffness times K. Acts in dynamics.",
       .keys = {{.name = "mass",
                 .forms = {quantity(frequency(), non_negative())},
                 .example = "0.1 1/s",
                 .default_text = "0 1/s",
                 .description = "Factor of the mass matrix."},
                {.name = "stiffness",
                 .forms = {quantity(time(), non_negative())},
                 .example = "0.01 s",
                 .default_text = "0 s",
                 .description = "Factor of the stiffness matrix."}}});
}

std::vector<Key> mass_keys() {
  return {
      {.name = "mass",
       .forms = {quantity(mass(), positive())},
       .example = "42 g",
       .description = "Total mass. Needed, or else density, with gravity or dynamics."},
      {.name = "density",
       .forms = {quantity(density(), positive())},
       .example = "1070 kg/m^3",
       .description = "Mass per volume."},
      {.name = "mass_distribution",
       .forms = {choice(
           {{"volume", "By the volume of the elements."}, {"even", "The same for every node."}})},
       .example = "even",
       .default_text = "volume",
       .description = "How `mass` is spread over the nodes.",
       .only_with = "mass"},
      {.name = "mass_matrix",
       .forms = {choice({{"lumped", "Diagonal."}, {"consistent", "From the shape functions."}})},
       .example = "lumped",
       .default_text = "lumped",
       .description = "The mass matrix."}};
}

std::shared_ptr<const KeyTable> fem_table() {
  KeyTable fem{.name = "body: type fem",
               .description = "A deformable body of finite elements.",
               .alternatives = {{{"mass", "density"}, false}}};
  fem.keys = {{.name = "mesh",
               .forms = {table(mesh_file_table(), "file"), mesh_shape()},
               .example = "{file: trunk.vtk, unit: mm}",
               .description = "The shape at rest.",
               .required = true},
              {.name = "element",
               .forms = {choice({{"tet4", "Linear tetrahedra."},
                                 {"tet10", "Quadratic tetrahedra.", true},
                                 {"hex8", "Hexahedra.", true}})},
               .example = "tet4",
               .default_text = "tet4",
               .description = "The finite element."},
              {.name = "material",
               .forms = {material_form(), later(text())},
               .example = "{young_modulus: 450 kPa, poisson_ratio: 0.45}",
               .description = "What it is made of.",
               .required = true}};
  for (Key& key : mass_keys()) fem.keys.push_back(std::move(key));
  fem.keys.push_back({.name = "damping",
                      .forms = {table(damping_table())},
                      .example = "{mass: 0.1 1/s, stiffness: 0.01 s}",
                      .default_text = "{}",
                      .description = "Rayleigh damping."});
  fem.keys.push_back({.name = "fixed",
                      .forms = {fixed_region(), list({fixed_region()})},
                      .example = "{box: -20 -20 0 20 20 20 mm}",
                      .description = "Where it is held: one region, or a list of them."});
  return make_table(std::move(fem));
}

}  // namespace

Form body_form() {
  return variants("type", {{.word = "fem", .description = "Finite elements.", .table = fem_table()},
                           {.word = "reduced", .description = "Reduced elements.", .later = true},
                           {.word = "rod", .description = "A slender rod.", .later = true},
                           {.word = "pcc", .description = "Constant curvature.", .later = true},
                           {.word = "rigid", .description = "A rigid body.", .later = true}});
}

}  // namespace sinew::scene::forms
