// The keys that loads share, and the tables of point masses and membranes.
#include "sinew/scene/load_fields.hpp"

namespace sinew::scene::forms {

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

std::shared_ptr<const KeyTable> load_table(const char* type, const char* description,
                                           std::vector<Key> own) {
  own.insert(own.begin(), body_key());
  return make_table({.name = std::string("load: type ") + type,
                     .description = description,
                     .keys = std::move(own)});
}

Key vector_key(const char* name, const Measure& measure, const char* example,
               const char* description) {
  return {.name = name,
          .forms = {vector(measure)},
          .example = example,
          .description = description,
          .required = true};
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
