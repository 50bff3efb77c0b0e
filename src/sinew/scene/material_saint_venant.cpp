// The law saint-venant-kirchhoff.
#include <memory>
#include <utility>
#include <vector>

#include "sinew/material/hyperelastic.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> saint_venant_table() {
  std::vector<Key> keys = small_strain_keys();
  for (Key& key : history_keys()) keys.push_back(std::move(key));
  return make_table({.name = "material: model saint-venant-kirchhoff",
                     .description = "Linear in the Green strain.",
                     .keys = std::move(keys),
                     .shared = history_table()});
}

}  // namespace
}  // namespace forms

namespace {

void read_saint_venant(const Fields& fields, MaterialDescription& material) {
  material.model = MaterialModel::hyperelastic;
  material.energy = material::saint_venant_kirchhoff(read_number(fields, "young_modulus"),
                                                     read_number(fields, "poisson_ratio"));
}

}  // namespace

const MaterialKind& saint_venant_kind() {
  static const MaterialKind kind{
      .word = "saint-venant-kirchhoff",
      .description =
          "Linear in the Green strain: large rotation, small strain; softens and "
          "collapses in compression.",
      .table = forms::saint_venant_table,
      .read = read_saint_venant};
  return kind;
}

}  // namespace sinew::scene
