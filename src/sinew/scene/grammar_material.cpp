// The keys that laws share: moduli, viscosity and softening; the forms of a material.

#include <fmt/format.h>

#include "sinew/material/library.hpp"
#include "sinew/scene/material_fields.hpp"

namespace sinew::scene::forms {

Range material_range(double min, double max) {
  return {.min = min,
          .max = max,
          .above_min = true,
          .below_max = true,
          .kind = ErrorKind::invalid_material};
}

Key modulus_key(const char* name, const char* example, const char* description, bool required,
                bool any_sign) {
  const Range range = any_sign ? any() : material_range(0.0);
  return {.name = name,
          .forms = {quantity(elastic_modulus(), range)},
          .example = example,
          .description = description,
          .required = required};
}

namespace {

Key poisson_ratio_key(bool required, const char* description) {
  return {.name = "poisson_ratio",
          .forms = {quantity(plain_number(), material_range(-1.0, 0.5))},
          .example = "0.45",
          .description = description,
          .required = required};
}

}  // namespace

std::vector<Key> small_strain_keys() {
  return {modulus_key("young_modulus", "450 kPa", "Young's modulus."),
          poisson_ratio_key(
              true, "Poisson's ratio, between -1 and 0.5. Linear tetrahedra lock near 0.5.")};
}

namespace {

std::shared_ptr<const KeyTable> prony_table() {
  return make_table(
      {.name = "material: viscosity",
       .description = "A part of the isochoric stress that relaxes: G(t)/G(0) = 1 - "
                      "sum of g (1 - exp(-t/tau)).",
       .keys = {{.name = "relative_modulus",
                 .forms = {quantity(plain_number(), material_range(0.0, 1.0))},
                 .example = "0.1",
                 .description = "g, relative to the instantaneous modulus; the sum is below 1.",
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
       .description =
           "Mullins softening (Ogden & Roxburgh 1999): on unloading, the isochoric stress is "
           "multiplied by 1 - erf((Wm - W)/(m + beta Wm))/r, with the law's energy W and its "
           "maximum so far Wm. `sinew fit --mullins` fits the constants.",
       .keys = {{.name = "r",
                 .forms = {quantity(plain_number(), material_range(1.0))},
                 .example = "2.1",
                 .description = "Maximum softening: the fraction 1 - 1/r of the stress remains.",
                 .required = true},
                {.name = "m",
                 .forms = {quantity(energy_per_volume(), non_negative())},
                 .example = "500 Pa",
                 .description = "Energy scale of the drop below Wm, J/m^3.",
                 .required = true},
                {.name = "beta",
                 .forms = {quantity(plain_number(), non_negative())},
                 .example = "0.1",
                 .default_text = "0",
                 .description = "Energy scale as a fraction of Wm, added to m."}}});
}

}  // namespace

std::vector<Key> history_keys() {
  Form series = list({table(prony_table())});
  return {{.name = "viscosity",
           .forms = {series},
           .example = "[{relative_modulus: 0.1, relaxation_time: 50 ms}]",
           .description = "Prony series of a viscoelastic material. Default: elastic."},
          {.name = "moduli",
           .forms = {choice({{"long-term", "Long-term: moduli for slow motion and statics."},
                             {"instantaneous", "Instantaneous: moduli for a sudden strain."}})},
           .example = "instantaneous",
           .default_text = "long-term",
           .description = "Time scale of the law's moduli.",
           .only_with = "viscosity"},
          {.name = "softening",
           .forms = {table(softening_table())},
           .example = "{r: 2.1, m: 500 Pa, beta: 0.1}",
           .description = "The Mullins effect. Default: unloading follows loading."}};
}

std::shared_ptr<const KeyTable> history_table() {
  static const auto table = make_table({.name = "keys of all hyperelastic laws",
                                        .description = "Viscoelasticity and softening.",
                                        .keys = history_keys()});
  return table;
}

std::shared_ptr<const KeyTable> energy_table(const MaterialKind& kind, std::vector<Key> own,
                                             std::vector<Alternatives> alternatives) {
  own.push_back(poisson_ratio_key(
      false, "Initial Poisson's ratio, below 0.5: 0.49 to 0.4999 for rubbers on hexahedra."));
  own.push_back(
      modulus_key("bulk_modulus", "1 MPa", "Bulk modulus, in place of `poisson_ratio`.", false));
  for (Key& key : history_keys()) own.push_back(std::move(key));
  alternatives.push_back({{"poisson_ratio", "bulk_modulus"}, true});
  return make_table({.name = std::string("material: model ") + kind.word,
                     .description = kind.description,
                     .keys = std::move(own),
                     .alternatives = std::move(alternatives),
                     .shared = history_table()});
}

namespace {

Key stiffness_scale() {
  return {.name = "scale",
          .forms = {quantity(plain_number(), material_range(0.0))},
          .example = "1.5",
          .default_text = "1",
          .description = "Factor of all moduli, to match a test of your own batch."};
}

}  // namespace

std::vector<Form> material_forms() {
  const auto usual =
      make_table({.name = "material",
                  .description = "The corotational law, which applies if `model` is left out.",
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
                               .description = "A material in a separate YAML file with the keys of "
                                              "a material, as written by `sinew fit`.",
                               .keys = {{.name = "file",
                                         .forms = {file()},
                                         .example = "rubber.yaml",
                                         .description = "Path of the file, relative to the scene "
                                                        "file.",
                                         .required = true},
                                        stiffness_scale()}});
  Form word = choice(std::move(library), "name");
  word.loose = true;
  Form bare_word = word;  // what the words mean stands at the form without a map
  for (Choice& choice : bare_word.choices) choice.description.clear();
  const auto named = make_table(
      {.name = "material: name",
       .description = "A library material with scaled moduli.",
       .keys = {{.name = "name",
                 .forms = {bare_word},
                 .example = "dragon-skin-30",
                 .description = "A name of the library; capitals, spaces and hyphens are ignored.",
                 .required = true},
                stiffness_scale()}});
  return {law_form(), table(usual, "young_modulus"), table(own, "file"), table(named, "name"),
          std::move(word)};
}

}  // namespace sinew::scene::forms
