// The tables of bodies: mesh, material, mass, damping, fixed regions.
#include <limits>

#include <fmt/format.h>

#include "sinew/material/library.hpp"
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
      "Aimed edge length of the elements. Without: a few through the thinnest part.");
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
                shape("chambered-cylinder",
                      "A solid cylinder about z, its base at the origin, with a cylindrical "
                      "chamber beside its axis. Node set `chamber`: the chamber's wall.",
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
                           .description = "Where the chamber begins; at 0 it is open."},
                       optional_length("chamber_top", "60 mm", "",
                                       "Where it ends. Without: at the top, open.")}),
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

Range material_range(double min, double max = std::numeric_limits<double>::infinity()) {
  return {.min = min,
          .max = max,
          .above_min = true,
          .below_max = true,
          .kind = ErrorKind::invalid_material};
}

Key modulus(const char* name, const char* example, const char* description, bool required = true,
            bool any_sign = false) {
  const Range range = any_sign ? any() : material_range(0.0);
  return {.name = name,
          .forms = {quantity(stress(), range)},
          .example = example,
          .description = description,
          .required = required};
}

Key poisson_ratio(bool required, const char* description) {
  return {.name = "poisson_ratio",
          .forms = {quantity(plain_number(), material_range(-1.0, 0.5))},
          .example = "0.45",
          .description = description,
          .required = required};
}

std::vector<Key> small_strain_keys() {
  return {
      modulus("young_modulus", "450 kPa", "Young's modulus."),
      poisson_ratio(true, "Poisson's ratio, between -1 and 0.5. Linear tetrahedra lock near 0.5.")};
}

std::shared_ptr<const KeyTable> prony_table() {
  return make_table({.name = "material: viscosity",
                     .description = "A part of the isochoric stress that relaxes: G(t)/G(0) = 1 - "
                                    "sum of g (1 - exp(-t/tau)).",
                     .keys = {{.name = "relative_modulus",
                               .forms = {quantity(plain_number(), material_range(0.0, 1.0))},
                               .example = "0.1",
                               .description = "g, of the modulus of a sudden strain; all below 1 "
                                              "together.",
                               .required = true},
                              {.name = "relaxation_time",
                               .forms = {quantity(time(), material_range(0.0))},
                               .example = "50 ms",
                               .description = "tau.",
                               .required = true}}});
}

std::shared_ptr<const KeyTable> softening_table() {
  return make_table(
      {.name = "material: softening",
       .description = "Softening of rubber that was stretched before (Ogden & Roxburgh 1999): on "
                      "unloading the isochoric stress is 1 - erf((Wm - W)/(m + beta Wm))/r of the "
                      "law's, W its energy and Wm the largest so far. `sinew fit --mullins` "
                      "finds the numbers.",
       .keys = {{.name = "r",
                 .forms = {quantity(plain_number(), material_range(1.0))},
                 .example = "2.1",
                 .description = "How much at most: 1 - 1/r is left.",
                 .required = true},
                {.name = "m",
                 .forms = {quantity(stress(), non_negative())},
                 .example = "500 Pa",
                 .description = "Energy by which Wm must be undercut, J/m^3.",
                 .required = true},
                {.name = "beta",
                 .forms = {quantity(plain_number(), non_negative())},
                 .example = "0.1",
                 .default_text = "0",
                 .description = "The same as a share of Wm."}}});
}

/// Keys of all hyperelastic laws: viscoelasticity and softening.
std::vector<Key> history_keys() {
  Form series = list({table(prony_table())});
  return {{.name = "viscosity",
           .forms = {series},
           .example = "[{relative_modulus: 0.1, relaxation_time: 50 ms}]",
           .description = "Prony series of a viscoelastic material. Without: it is elastic."},
          {.name = "moduli",
           .forms = {choice({{"long-term", "Those of slow motion and statics."},
                             {"instantaneous", "Those of a sudden strain."}})},
           .example = "instantaneous",
           .default_text = "long-term",
           .description = "What the law's moduli are.",
           .only_with = "viscosity"},
          {.name = "softening",
           .forms = {table(softening_table())},
           .example = "{r: 2.1, m: 500 Pa, beta: 0.1}",
           .description = "The Mullins effect. Without: unloading follows loading."}};
}

/// A hyperelastic law: its own keys, and one of the two that say how little it is compressible.
Choice energy(const char* word, const char* description, std::vector<Key> keys,
              std::vector<Alternatives> alternatives = {}) {
  keys.push_back(poisson_ratio(
      false, "That of small strain, below 0.5: 0.49 to 0.4999 for rubbers on hexahedra."));
  keys.push_back(modulus("bulk_modulus", "1 MPa", "In place of poisson_ratio.", false));
  for (Key& key : history_keys()) keys.push_back(std::move(key));
  alternatives.push_back({{"poisson_ratio", "bulk_modulus"}, true});
  return {.word = word,
          .description = description,
          .table = make_table({.name = std::string("material: model ") + word,
                               .description = description,
                               .keys = std::move(keys),
                               .alternatives = std::move(alternatives)})};
}

Choice small_strain(const char* word, const char* description) {
  return {.word = word,
          .description = description,
          .table = make_table({.name = std::string("material: model ") + word,
                               .description = description,
                               .keys = small_strain_keys()})};
}

std::vector<Key> ogden_keys() {
  constexpr int kMostTerms = 6;
  Form moduli = quantity(stress(), any());
  moduli.max_count = kMostTerms;
  return {
      {.name = "mu",
       .forms = {moduli},
       .example = "24.361 0.066703 -0.45381 kPa",
       .description = "Moduli, one to six.",
       .required = true},
      {.name = "alpha",
       .forms = {numbers(1, kMostTerms, any())},
       .example = "1.7138 7.0679 -3.3659",
       .description = "Exponents, as many.",
       .required = true},
      {.name = "convention",
       .forms = {choice({{"mu-over-alpha", "sum mu/alpha (...), Ogden's own."},
                         {"two-mu-over-alpha-squared",
                          "sum 2 mu/alpha^2 (...): mu adds up to the initial shear modulus."}})},
       .example = "mu-over-alpha",
       .description = "How the moduli are meant; sources differ, and stiffness with them.",
       .required = true}};
}

std::vector<Key> saint_venant_keys() {
  std::vector<Key> keys = small_strain_keys();
  for (Key& key : history_keys()) keys.push_back(std::move(key));
  return keys;
}

/// Laws by name, told by `model`.
Form law_form() {
  const Key shear = modulus("shear_modulus", "24.4 kPa", "Initial shear modulus.", false);
  Key c20 = modulus("c20", "-0.2 kPa", "Of (I - 3)^2.", false, true);
  Key c30 = modulus("c30", "0.03 kPa", "Of (I - 3)^3.", false, true);
  c20.default_text = c30.default_text = "0 Pa";
  return variants(
      "model",
      {small_strain("corotational",
                    "Linear about the rotated element: large bending, small strain."),
       small_strain("linear", "Small displacements and strains."),
       energy("neo-hookean", "mu/2 (I - 3) and kappa/2 (J - 1)^2.",
              {shear, modulus("young_modulus", "72 kPa", "In place of shear_modulus.", false)},
              {{{"shear_modulus", "young_modulus"}, true}}),
       energy("mooney-rivlin", "C10 (I - 3) + C01 (II - 3).",
              {modulus("c10", "12.18 kPa", "Of I - 3.", true, true),
               modulus("c01", "1 kPa", "Of II - 3.", true, true)}),
       energy("yeoh", "C10 (I - 3) + C20 (I - 3)^2 + C30 (I - 3)^3.",
              {modulus("c10", "12 kPa", "Of I - 3; half the initial shear modulus."), c20, c30}),
       energy("ogden", "A sum of powers of the principal stretches.", ogden_keys()),
       energy("arruda-boyce", "Eight chains of finite length, five terms of their series.",
              {modulus("shear_modulus", "20 kPa", "mu of the series."),
               {.name = "locking_stretch",
                .forms = {quantity(plain_number(), material_range(1.0))},
                .example = "3.5",
                .description = "Where the chains are straight.",
                .required = true}}),
       {.word = "saint-venant-kirchhoff",
        .description = "Linear in the Green strain: large rotation, small strain; softens and "
                       "collapses in compression.",
        .table = make_table({.name = "material: model saint-venant-kirchhoff",
                             .description = "Linear in the Green strain.",
                             .keys = saint_venant_keys()})}});
}

/// A law, the usual one by its constants alone, or a name of the library.
std::vector<Form> material_forms() {
  const auto usual = make_table({.name = "material",
                                 .description = "The corotational law, when `model` is left out.",
                                 .keys = small_strain_keys()});
  std::vector<Choice> library;
  for (const material::NamedMaterial& named : material::material_library()) {
    std::string description =
        fmt::format("{}, {}, {:g} kg/m^3, nu_0 {:g}. {}.", named.trade_name, named.law,
                    named.density, material::kLibraryPoissonRatio, named.source);
    if (!named.remark.empty()) description += " " + named.remark;
    library.push_back({.word = named.name, .description = std::move(description)});
  }
  const auto own = make_table({.name = "material: file",
                               .description = "A material in a YAML file of its own, with the keys "
                                              "of a material here, as `sinew fit` writes it.",
                               .keys = {{.name = "file",
                                         .forms = {file()},
                                         .example = "rubber.yaml",
                                         .description = "Path of the file, relative to the scene "
                                                        "file.",
                                         .required = true}}});
  return {law_form(), table(usual, "young_modulus"), table(own, "file"),
          choice(std::move(library))};
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

}  // namespace

std::vector<Key> region_keys(const char* whose) {
  const std::string what = whose;
  return {{.name = "box",
           .forms = {vector(length(), 6)},
           .example = "-20 -20 0 20 20 20 mm",
           .description = what + " inside the box: x y z of its lowest, then its highest corner."},
          {.name = "sphere",
           .forms = {table(sphere_table())},
           .example = "{center: 0 0 0 mm, radius: 10 mm}",
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
       .description = "What is held; along the other axes the nodes slide freely, as on rollers."});
  return table(make_table(std::move(fixed)));
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

std::shared_ptr<const KeyTable> base_table() {
  const auto along = [](const char* axis) {
    return Key{.name = axis,
               .forms = {quantity(length()), table(signal_table(length(), "10 mm"))},
               .example = "{sine: {amplitude: 10 mm, period: 2 s}}",
               .default_text = "0 mm",
               .description = std::string("Along ") + axis + "."};
  };
  return make_table({.name = "base",
                     .description =
                         "How the fixed nodes move: turned about an axis, then shifted, from rest. "
                         "What moves them puts in or takes out work.",
                     .keys = {along("x"),
                              along("y"),
                              along("z"),
                              {.name = "angle",
                               .forms = {quantity(angle()), table(signal_table(angle(), "90 deg"))},
                               .example = "{ramp: {to: 90 deg, duration: 2 s}}",
                               .default_text = "0 rad",
                               .description = "Of the turn, from rest."},
                              {.name = "axis",
                               .forms = {vector(plain_number())},
                               .example = "0 1 0",
                               .default_text = "0 0 1",
                               .description = "Of the turn; any length but zero."},
                              {.name = "center",
                               .forms = {vector(length())},
                               .example = "0 0 0 mm",
                               .default_text = "0 0 0 mm",
                               .description = "A point of the axis, at rest."}}});
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
  fem.keys = {
      {.name = "mesh",
       .forms = {table(mesh_file_table(), "file"), mesh_shape()},
       .example = "{file: trunk.vtk, unit: mm}",
       .description = "The shape at rest.",
       .required = true},
      {.name = "element",
       .forms = {choice({{"tet4", "Linear tetrahedra; near nu = 0.5 they lock."},
                         {"tet4-patch",
                          "Linear tetrahedra that share the dilatation of about eight neighbours: "
                          "no locking in volume. For hyperelastic materials."},
                         {"tet10",
                          "Quadratic tetrahedra: no locking. A linear mesh gets middle nodes. For "
                          "hyperelastic materials."},
                         {"hex8",
                          "Trilinear hexahedra with the pressure of their mean dilatation: "
                          "no locking in volume. For hyperelastic materials."}})},
       .example = "hex8",
       .description = "The finite element. Without: what a mesh file holds, and tet4 for shapes."},
      {.name = "material",
       .forms = material_forms(),
       .example = "{young_modulus: 450 kPa, poisson_ratio: 0.45}",
       .description = "What it is made of: a law, or a name of the library such as "
                      "ecoflex-00-30.",
       .required = true}};
  for (Key& key : mass_keys()) fem.keys.push_back(std::move(key));
  fem.keys.push_back({.name = "damping",
                      .forms = {table(damping_table())},
                      .example = "{mass: 0.1 1/s, stiffness: 0.01 s}",
                      .default_text = "{}",
                      .description = "Rayleigh damping."});
  fem.keys.push_back({.name = "base",
                      .forms = {table(base_table())},
                      .example = "{x: {sine: {amplitude: 10 mm, period: 2 s}}}",
                      .description = "How the fixed nodes move. Without: they stand still.",
                      .only_with = "fixed"});
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
