// The tables of bodies: mesh, element, mass, damping, fixed regions.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

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
      "Target edge length of the elements. Default: a few elements through the thinnest part. "
      "Blocks and ribbed fingers of tetrahedra get even numbers of cells, so that they are "
      "symmetric.");
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
      "shape",
      {shape(
           "block",
           "A box from the origin along the axes, z upwards. Node sets: `x_min`, `x_max`, `y_min`, "
           "`y_max`, `z_min`, `z_max`.",
           {shape_length("length", "100 mm", "Along x."),
            shape_length("width", "20 mm", "Along y."),
            shape_length("height", "20 mm", "Along z.")}),
       shape("cylinder",
             "A solid cylinder about z with its base at the origin. Node sets: `bottom`, `top`, "
             "`side`.",
             {shape_length("radius", "15 mm", "Outer radius."),
              shape_length("height", "195 mm", "Along z.")}),
       shape("cone",
             "A solid truncated cone about z with its base at the origin. Node sets: `bottom`, "
             "`top`, `side`.",
             {shape_length("base_radius", "20 mm", "Radius at z = 0."),
              shape_length("tip_radius", "8 mm", "Radius at the top."),
              shape_length("height", "195 mm", "Along z.")}),
       shape("hollow-cylinder",
             "A tube about z with its base at the origin. Node sets: `bottom`, `top`, `inner`, "
             "`outer`.",
             {shape_length("inner_radius", "8 mm", "Radius of the bore."),
              shape_length("outer_radius", "15 mm", "Outer radius."),
              shape_length("height", "195 mm", "Along z.")}),
       shape("chambered-cylinder",
             "A solid cylinder about z with its base at the origin and a cylindrical chamber "
             "beside its axis. Node sets: `bottom`, `top`, `side`, and `chamber`, its whole wall.",
             {shape_length("radius", "12.5 mm", "Outer radius."),
              shape_length("height", "65 mm", "Along z."),
              shape_length("chamber_radius", "3.7 mm", "Radius of the chamber."),
              Key{.name = "chamber_offset",
                  .forms = {quantity(length(), non_negative())},
                  .example = "7.3 mm",
                  .default_text = "0 mm",
                  .description = "Distance of the chamber's axis from z, along x."},
              Key{.name = "chamber_bottom",
                  .forms = {quantity(length(), non_negative())},
                  .example = "5 mm",
                  .default_text = "0 mm",
                  .description = "Height at which the chamber begins; at 0 it is open."},
              optional_length(
                  "chamber_top", "60 mm", "",
                  "Height at which the chamber ends. Default: at the top, where it is open.")}),
       shape("sphere",
             "A ball centred at the origin. Node sets: `surface`, and its parts `top` (z >= 0) and "
             "`bottom` (z <= 0).",
             {shape_length("radius", "15 mm", "Its radius.")}),
       shape("capsule",
             "A cylinder about z with hemispherical ends, centred at the origin. Node sets: "
             "`surface`, and its parts `side`, `top` and `bottom`.",
             {shape_length("radius", "10 mm",
                           "Radius of the cylinder and of its hemispherical ends."),
              shape_length("length", "40 mm", "Length of the cylinder, without its ends.")}),
       shape("ribbed-finger",
             "A finger for a cable: a spine along x from the origin, with ribs on it. There is a "
             "rib at each end, and all gaps are equal. Node sets: `x_min` to `z_max`.",
             {shape_length("length", "100 mm", "Along x."),
              shape_length("width", "20 mm", "Along y."),
              shape_length("height", "20 mm", "Along z, spine and ribs together."),
              Key{.name = "ribs",
                  .forms = {integer(2, 1000)},
                  .example = "8",
                  .default_text = "7",
                  .description = "Number of ribs."},
              optional_length("gap", "4 mm", "",
                              "Gap between two ribs. Default: half the length of a rib."),
              optional_length("spine", "6 mm", "",
                              "Thickness of the spine. Default: a third of the height.")}),
       shape("trunk",
             "A tapered trunk along z with bellows and its base at the origin. Node sets: "
             "`bottom`, `top`, `side`.",
             {optional_length("base_radius", "20 mm", "20 mm", "Outer radius at z = 0."),
              optional_length("tip_radius", "12 mm", "8.5 mm", "Outer radius at the top."),
              optional_length("height", "195 mm", "195 mm", "Along z."),
              Key{.name = "bellows",
                  .forms = {integer(1, 1000)},
                  .example = "10",
                  .default_text = "9",
                  .description = "Number of bellows."},
              optional_length("bellow_depth", "4 mm", "",
                              "Depth of the grooves at z = 0; it decreases towards the tip with "
                              "the radius. Default: a quarter of base_radius.")})});
}

std::shared_ptr<const KeyTable> mesh_file_table() {
  return make_table(
      {.name = "mesh: file",
       .description =
           "A mesh file: VTK legacy, VTU, or Gmsh 2.2 and 4.1, recognised by its content.",
       .keys = {mesh_file_key("trunk.vtk"), file_unit_key(), file_scale_key()}});
}

std::shared_ptr<const KeyTable> sphere_table() {
  return make_table({.name = "sphere",
                     .description = "A ball.",
                     .keys = {{.name = "centre",
                               .forms = {vector(length())},
                               .example = "0 0 195 mm",
                               .description = "Its centre.",
                               .required = true},
                              {.name = "radius",
                               .forms = {quantity(length(), positive())},
                               .example = "10 mm",
                               .description = "Its radius.",
                               .required = true}}});
}

std::shared_ptr<const KeyTable> plane_table() {
  return make_table(
      {.name = "plane",
       .description = "A plane, and the distance within which nodes belong to it.",
       .keys = {{.name = "point",
                 .forms = {vector(length())},
                 .example = "0 0 0 mm",
                 .description = "A point of the plane.",
                 .required = true},
                {.name = "normal",
                 .forms = {vector(plain_number())},
                 .example = "0 0 1",
                 .default_text = "0 0 1",
                 .description = "Normal of the plane; any non-zero length."},
                {.name = "within",
                 .forms = {quantity(length(), non_negative())},
                 .example = "0.1 mm",
                 .default_text = "0.001 mm",
                 .description =
                     "Nodes within this distance of the plane, on either side, are selected."}}});
}

}  // namespace

std::vector<Key> region_keys(const char* whose) {
  const std::string what = whose;
  return {{.name = "box",
           .forms = {vector(length(), 6)},
           .example = "-20 -20 0 20 20 20 mm",
           .description =
               what + " inside the box, given by x y z of its lowest and of its highest corner."},
          {.name = "sphere",
           .forms = {table(sphere_table())},
           .example = "{centre: 0 0 0 mm, radius: 10 mm}",
           .description = what + " inside the sphere."},
          {.name = "plane",
           .forms = {table(plane_table())},
           .example = "{point: 0 0 0 mm, normal: 0 0 1}",
           .description = what + " on the plane."},
          {.name = "set",
           .forms = {text()},
           .example = "base",
           .description = what + " of a named set of the mesh; `sinew info` lists them."}};
}

std::shared_ptr<const KeyTable> region_table(const char* name, const char* description) {
  return make_table({.name = name,
                     .description = description,
                     .keys = region_keys("Nodes"),
                     .alternatives = {{{"box", "sphere", "plane", "set"}, true}}});
}

namespace {

Form fixed_region() {
  KeyTable fixed{.name = "fixed region",
                 .description =
                     "The nodes of the mesh at rest that do not move. Exactly one of "
                     "box, sphere, plane and set.",
                 .keys = region_keys("Nodes"),
                 .alternatives = {{{"box", "sphere", "plane", "set"}, true}}};
  fixed.keys.push_back(
      {.name = "axes",
       .forms = {choice({{"x", "Along x."}, {"y", "Along y."}, {"z", "Along z."}}),
                 list({choice({{"x", ""}, {"y", ""}, {"z", ""}})}, 1, 3)},
       .example = "z",
       .default_text = "[x, y, z]",
       .description = "Fixed axes; along the other axes the nodes slide freely, as on rollers."});
  return table(make_table(std::move(fixed)));
}

std::shared_ptr<const KeyTable> damping_table() {
  return make_table(
      {.name = "damping",
       .description = "Rayleigh damping: mass times M plus stiffness times K. It acts in dynamics "
                      "only. Stiffness damping resists strain, not rotation.",
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
       .description = "Total mass. Gravity and dynamics require mass or density."},
      {.name = "density",
       .forms = {quantity(density(), positive())},
       .example = "1070 kg/m^3",
       .description = "Mass per volume."},
      {.name = "mass_distribution",
       .forms = {choice(
           {{"volume", "By the volume of the elements."}, {"even", "The same for every node."}})},
       .example = "even",
       .default_text = "volume",
       .description = "Distribution of `mass` over the nodes.",
       .only_with = "mass"},
      {.name = "mass_matrix",
       .forms = {choice({{"lumped", "Diagonal."}, {"consistent", "From the shape functions."}})},
       .example = "lumped",
       .default_text = "lumped",
       .description = "The mass matrix."}};
}

std::shared_ptr<const KeyTable> part_table() {
  return make_table(
      {.name = "part",
       .description = "Elements of a body that have another material.",
       .keys = {
           {.name = "region",
            .forms = {table(region_table("region of a part",
                                         "Elements with all their nodes in the region. Exactly one "
                                         "of box, sphere, plane and set."))},
            .example = "{box: -20 -20 80 20 20 100 mm}",
            .description = "Region of the part, in the mesh at rest.",
            .required = true},
           {.name = "material",
            .forms = material_forms(),
            .example = "smooth-sil-950",
            .description = "Material of the part, given as for a body.",
            .required = true},
           {.name = "density",
            .forms = {quantity(density(), positive())},
            .example = "1200 kg/m^3",
            .description = "Density of the part. Default: the density of the library's material, "
                           "or else of the body. It cannot be combined with the body's `mass`."}}});
}

}  // namespace

std::shared_ptr<const KeyTable> fem_table() {
  KeyTable fem{.name = "body: type fem",
               .description = "A deformable body of finite elements.",
               .alternatives = {{{"mass", "density"}, false}}};
  fem.keys = {
      {.name = "mesh",
       .forms = {table(mesh_file_table(), "file"), mesh_shape()},
       .example = "{file: trunk.vtk, unit: mm}",
       .description = "The shape at rest.",
       .required = true},
      {.name = "pose",
       .forms = {table(pose_table())},
       .example = "{position: 0 0 60 mm, rotation: {axis: z, angle: 90 deg}}",
       .default_text = "{}",
       .description =
           "Position and rotation of the mesh. Points, boxes and planes of the scene are "
           "in world coordinates, with the body at rest."},
      {.name = "element",
       .forms = {choice(
           {{"tet4",
             "Linear tetrahedra: too stiff in bending at any Poisson's ratio, and most of all near "
             "0.5. A notice states the factor."},
            {"tet4-patch",
             "Linear tetrahedra that share the dilatation of about eight neighbours: no volumetric "
             "locking, but too stiff in bending; a notice states the factor. For hyperelastic "
             "materials."},
            {"tet10",
             "Quadratic tetrahedra: no locking. A linear mesh gets mid-edge nodes, numbered after "
             "its own nodes. For hyperelastic materials."},
            {"hex8",
             "Trilinear hexahedra with the pressure of their mean dilatation: no volumetric "
             "locking, but too stiff in bending if they are long or few. For hyperelastic "
             "materials."}})},
       .example = "hex8",
       .description = "The finite element. Default: the elements of the mesh file, and tetrahedra "
                      "for shapes, which become quadratic (tet10) if all materials are "
                      "hyperelastic, as those of the library are."},
      {.name = "material",
       .forms = material_forms(),
       .example = "{young_modulus: 450 kPa, poisson_ratio: 0.45}",
       .description = "Material: a constitutive law, or a library name such as ecoflex-00-30.",
       .required = true},
      {.name = "parts",
       .forms = {names(table(part_table()))},
       .example = "{tip: {region: {box: -20 -20 80 20 20 100 mm}, material: smooth-sil-950}}",
       .description =
           "Parts made of other materials. All other elements have the body's `material`."}};
  for (Key& key : mass_keys()) fem.keys.push_back(std::move(key));
  fem.keys.push_back({.name = "damping",
                      .forms = {table(damping_table())},
                      .example = "{mass: 0.1 1/s, stiffness: 0.01 s}",
                      .default_text = "{}",
                      .description = "Rayleigh damping."});
  fem.keys.push_back(
      {.name = "velocity",
       .forms = {table(velocity_table())},
       .example = "{linear: 0 0 -1 m/s}",
       .default_text = "{}",
       .description = "Initial motion; at rest by default. Fixed nodes stay at rest."});
  fem.keys.push_back({.name = "motion",
                      .forms = {body_motion_form()},
                      .example = "{x: {sine: {amplitude: 10 mm, period: 2 s}}}",
                      .description = "Motion of the fixed nodes, which does work on the robot. "
                                     "Default: at rest.",
                      .only_with = "fixed"});
  fem.keys.push_back({.name = "fixed",
                      .forms = {fixed_region(), list({fixed_region()})},
                      .example = "{box: -20 -20 0 20 20 20 mm}",
                      .description = "Fixed nodes: one region, or a list of regions."});
  return make_table(std::move(fem));
}

}  // namespace sinew::scene::forms
