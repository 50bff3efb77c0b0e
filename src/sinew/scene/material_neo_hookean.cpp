// The law neo-hookean.
#include <memory>

#include "sinew/material/hyperelastic.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> neo_hookean_table() {
  return energy_table(neo_hookean_kind(),
                      {modulus_key("shear_modulus", "24.4 kPa", "Initial shear modulus.", false),
                       modulus_key("young_modulus", "72 kPa",
                                   "Initial Young's modulus, in place of `shear_modulus`.", false)},
                      {{{"shear_modulus", "young_modulus"}, true}});
}

}  // namespace
}  // namespace forms

namespace {

void read_neo_hookean(const Fields& fields, MaterialDescription& material) {
  const double young = read_number(fields, "young_modulus");
  const double bulk = read_number(fields, "bulk_modulus");
  double shear = read_number(fields, "shear_modulus"), poisson = 0.0;
  const bool by_ratio = fields.read("poisson_ratio", poisson);
  if (young > 0.0) {
    shear = by_ratio ? young / (2.0 * (1.0 + poisson)) : 3.0 * bulk * young / (9.0 * bulk - young);
  }
  set_energy(fields, material::neo_hookean(shear), material);
}

}  // namespace

const MaterialKind& neo_hookean_kind() {
  static const MaterialKind kind{.word = "neo-hookean",
                                 .description = "mu/2 (I - 3) and kappa/2 (J - 1)^2.",
                                 .table = forms::neo_hookean_table,
                                 .read = read_neo_hookean};
  return kind;
}

}  // namespace sinew::scene
