#include "sinew/scene/material_kind.hpp"

#include "sinew/scene/kind_list.hpp"
#include "sinew/scene/material_fields.hpp"

namespace sinew::scene {

namespace {

KindList<MaterialKind>& kinds_of_materials() {
  static KindList<MaterialKind> list(
      "material", {&corotational_kind(), &linear_kind(), &neo_hookean_kind(), &mooney_rivlin_kind(),
                   &yeoh_kind(), &ogden_kind(), &arruda_boyce_kind(), &saint_venant_kind()});
  return list;
}

}  // namespace

void register_material_kind(const MaterialKind& kind) { kinds_of_materials().add(kind); }

const MaterialKind& material_kind(std::string_view word) { return kinds_of_materials().get(word); }

Form forms::law_form() { return variants("model", kinds_of_materials().choices()); }

}  // namespace sinew::scene
