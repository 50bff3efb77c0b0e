// The law mooney-rivlin.
#include <memory>

#include "sinew/material/hyperelastic.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> mooney_rivlin_table() {
  return energy_table(mooney_rivlin_kind(),
                      {modulus_key("c10", "12.18 kPa", "Coefficient of I - 3.", true, true),
                       modulus_key("c01", "1 kPa", "Coefficient of II - 3.", true, true)});
}

}  // namespace
}  // namespace forms

namespace {

void read_mooney_rivlin(const Fields& fields, MaterialDescription& material) {
  set_energy(fields,
             material::mooney_rivlin(read_number(fields, "c10"), read_number(fields, "c01")),
             material);
}

}  // namespace

const MaterialKind& mooney_rivlin_kind() {
  static const MaterialKind kind{.word = "mooney-rivlin",
                                 .description = "C10 (I - 3) + C01 (II - 3).",
                                 .table = forms::mooney_rivlin_table,
                                 .read = read_mooney_rivlin};
  return kind;
}

}  // namespace sinew::scene
