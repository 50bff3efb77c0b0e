// The law yeoh.
#include <memory>

#include "sinew/material/hyperelastic.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> yeoh_table() {
  Key c20 = modulus_key("c20", "-0.2 kPa", "Coefficient of (I - 3)^2.", false, true);
  Key c30 = modulus_key("c30", "0.03 kPa", "Coefficient of (I - 3)^3.", false, true);
  c20.default_text = c30.default_text = "0 Pa";
  return energy_table(
      yeoh_kind(),
      {modulus_key("c10", "12 kPa", "Coefficient of I - 3; half the initial shear modulus."), c20,
       c30});
}

}  // namespace
}  // namespace forms

namespace {

void read_yeoh(const Fields& fields, MaterialDescription& material) {
  set_energy(fields,
             material::yeoh({read_number(fields, "c10"), read_number(fields, "c20"),
                             read_number(fields, "c30")}),
             material);
}

}  // namespace

const MaterialKind& yeoh_kind() {
  static const MaterialKind kind{.word = "yeoh",
                                 .description = "C10 (I - 3) + C20 (I - 3)^2 + C30 (I - 3)^3.",
                                 .table = forms::yeoh_table,
                                 .read = read_yeoh};
  return kind;
}

}  // namespace sinew::scene
