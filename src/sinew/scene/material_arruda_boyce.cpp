// The law arruda-boyce.
#include <memory>

#include "sinew/material/hyperelastic.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> arruda_boyce_table() {
  return energy_table(arruda_boyce_kind(),
                      {modulus_key("shear_modulus", "20 kPa", "Modulus mu of the series."),
                       {.name = "locking_stretch",
                        .forms = {quantity(plain_number(), material_range(1.0))},
                        .example = "3.5",
                        .description = "Locking stretch, at which the chains are straight.",
                        .required = true}});
}

}  // namespace
}  // namespace forms

namespace {

void read_arruda_boyce(const Fields& fields, MaterialDescription& material) {
  set_energy(fields,
             material::arruda_boyce(read_number(fields, "shear_modulus"),
                                    read_number(fields, "locking_stretch")),
             material);
}

}  // namespace

const MaterialKind& arruda_boyce_kind() {
  static const MaterialKind kind{.word = "arruda-boyce",
                                 .description = "Eight-chain model, five terms of its series.",
                                 .table = forms::arruda_boyce_table,
                                 .read = read_arruda_boyce};
  return kind;
}

}  // namespace sinew::scene
