// Laws of small strain: corotational and linear.
#include <memory>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> small_strain_table(const MaterialKind& kind) {
  return make_table({.name = std::string("material: model ") + kind.word,
                     .description = kind.description,
                     .keys = small_strain_keys()});
}

}  // namespace
}  // namespace forms

namespace {

template <MaterialModel model>
void read_small_strain(const Fields& fields, MaterialDescription& material) {
  material.model = model;
  fields.read("young_modulus", material.young_modulus);
  fields.read("poisson_ratio", material.poisson_ratio);
  material.young_modulus_place = fields.place("young_modulus");
  material.poisson_ratio_place = fields.place("poisson_ratio");
}

}  // namespace

const MaterialKind& corotational_kind() {
  static const MaterialKind kind{
      .word = "corotational",
      .description = "Corotational linear elasticity: large rotation, small strain.",
      .table = [] { return forms::small_strain_table(corotational_kind()); },
      .read = read_small_strain<MaterialModel::corotational>};
  return kind;
}

const MaterialKind& linear_kind() {
  static const MaterialKind kind{.word = "linear",
                                 .description = "Small displacements and strains.",
                                 .table = [] { return forms::small_strain_table(linear_kind()); },
                                 .read = read_small_strain<MaterialModel::linear>};
  return kind;
}

}  // namespace sinew::scene
