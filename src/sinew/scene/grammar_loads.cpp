// The tables of loads, point masses and membranes.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

Key factor_key() {
  return {.name = "factor",
          .forms = {quantity(plain_number()), table(signal_table(plain_number(), "1"))},
          .example = "{ramp: {to: 1, duration: 1 s}}",
          .default_text = "1",
          .description = "Load factor over time."};
}

Key surface_key(const char* description, bool required) {
  return {.name = "surface",
          .forms = {table(surface_table())},
          .example = "{plane: {point: 0 0 100 mm, normal: 0 0 1}}",
          .description = description,
          .required = required};
}

std::shared_ptr<const KeyTable> load_table(const char* name, const char* description,
                                           std::vector<Key> keys) {
  KeyTable load{.name = std::string("load: type ") + name, .description = description};
  load.keys.push_back(body_key());
  for (Key& key : keys) load.keys.push_back(std::move(key));
  return make_table(std::move(load));
}

Key vector_key(const char* name, const Measure& measure, const char* example,
               const char* description) {
  return {.name = name,
          .forms = {vector(measure)},
          .example = example,
          .description = description,
          .required = true};
}

Key coefficient(const char* name, const char* value, const char* description) {
  return {.name = name,
          .forms = {quantity(plain_number(), non_negative())},
          .example = value,
          .default_text = value,
          .description = description};
}

std::shared_ptr<const KeyTable> force_load_table() {
  return load_table(
      "force", "A force of fixed direction on a point of the body.",
      {vector_key("point", length(), "0 0 195 mm", "Position in the mesh at rest."),
       vector_key("force", force(), "0 0 -1 N", "The force."), outside_key(), factor_key()});
}

std::shared_ptr<const KeyTable> line_table() {
  return load_table("line", "A force of fixed direction spread evenly along a line in the body.",
                    {{.name = "points",
                      .forms = {table(point_file_table()), list({vector(length())}, 2)},
                      .example = "[0 0 0 mm, 0 0 100 mm]",
                      .description = "The line, in the mesh at rest.",
                      .required = true},
                     vector_key("force_per_length", force_per_length(), "0 0 -2 N/m",
                                "Force per length at rest."),
                     outside_key(),
                     factor_key()});
}

std::shared_ptr<const KeyTable> traction_table() {
  return load_table(
      "traction", "A force of fixed direction spread evenly over faces.",
      {surface_key("The faces.", true),
       vector_key("traction", force_per_area(), "0 0 -100 Pa", "Force per area at rest."),
       factor_key()});
}

std::shared_ptr<const KeyTable> acceleration_table() {
  return load_table("acceleration", "A force proportional to mass, as on a shaker or a turntable.",
                    {vector_key("acceleration", acceleration(), "2 0 0 m/s^2",
                                "Acceleration in addition to gravity."),
                     factor_key()});
}

std::shared_ptr<const KeyTable> pressure_load_table() {
  return load_table("pressure",
                    "Follower pressure on faces, open or closed. Steps use the symmetric part of "
                    "its stiffness; static solutions use all of it.",
                    {surface_key("The faces; pressure pushes into the body.", true),
                     {.name = "pressure",
                      .forms = {quantity(pressure()), table(signal_table(pressure(), "1 kPa"))},
                      .example = "1 kPa",
                      .description = "Pressure, constant or over time.",
                      .required = true}});
}

std::shared_ptr<const KeyTable> water_table() {
  return load_table(
      "water",
      "Surrounding water: buoyancy under the scene's gravity, drag on every face, and added mass.",
      {surface_key("The wet faces. Default: the whole outer surface of the body.", false),
       {.name = "density",
        .forms = {quantity(density(), non_negative())},
        .example = "1000 kg/m^3",
        .default_text = "1000 kg/m^3",
        .description = "Density of the water."},
       {.name = "level",
        .forms = {quantity(length())},
        .example = "100 mm",
        .description = "Height of the water's surface above the origin, against gravity. Default: "
                       "far above the body."},
       {.name = "velocity",
        .forms = {vector(speed())},
        .example = "0.1 0 0 m/s",
        .default_text = "0 0 0 m/s",
        .description = "Velocity of the water far from the body."},
       coefficient("normal_drag", "0.9",
                   "Drag coefficient of a face moving along its normal. Referred to the width, a "
                   "cylinder in cross flow then has a drag coefficient of 4/3 of this value, and a "
                   "sphere of this value."),
       coefficient("tangential_drag", "0.01", "Drag coefficient of a face moving tangentially."),
       coefficient("added_mass", "1",
                   "Added mass as a fraction of the displaced water: 1 for a cylinder in cross "
                   "flow, 0.5 for a sphere."),
       factor_key()});
}

}  // namespace

Form load_form() {
  return variants(
      "type",
      {{.word = "force", .description = "On a point.", .table = force_load_table()},
       {.word = "line", .description = "Along a line.", .table = line_table()},
       {.word = "traction", .description = "Over faces.", .table = traction_table()},
       {.word = "acceleration", .description = "On all mass.", .table = acceleration_table()},
       {.word = "pressure", .description = "Normal to faces.", .table = pressure_load_table()},
       {.word = "water", .description = "Buoyancy, drag and added mass.", .table = water_table()}});
}

Form mass_form() {
  return table(make_table(
      {.name = "mass",
       .description = "A point mass on a body, such as a suspended weight or a camera, with weight "
                      "and inertia but no size. It is added to the body's own mass.",
       .keys = {body_key(),
                vector_key("point", length(), "0 0 195 mm", "Position in the mesh at rest."),
                {.name = "mass",
                 .forms = {quantity(mass(), positive())},
                 .example = "52 g",
                 .description = "Mass.",
                 .required = true},
                outside_key()}}));
}

Form membrane_form() {
  return table(make_table(
      {.name = "membrane",
       .description = "A thin layer on faces of a body, such as the paper in a bending actuator or "
                      "fabric on silicone. It resists stretch in its plane, does not resist "
                      "bending, and has no mass. Its law is linear in the Green strain (plane "
                      "stress) and suits layers that stretch by a few per cent.",
       .keys = {body_key(),
                surface_key("The faces: a patch or a region of the body's surface.", true),
                {.name = "thickness",
                 .forms = {quantity(length(), positive())},
                 .example = "0.1 mm",
                 .description = "Thickness.",
                 .required = true},
                {.name = "young_modulus",
                 .forms = {quantity(elastic_modulus(), positive())},
                 .example = "2 GPa",
                 .description = "Young's modulus.",
                 .required = true},
                {.name = "poisson_ratio",
                 .forms = {quantity(plain_number(), material_range(-1.0, 0.5))},
                 .example = "0.3",
                 .default_text = "0.3",
                 .description = "Poisson's ratio, between -1 and 0.5."}}}));
}

}  // namespace sinew::scene::forms
