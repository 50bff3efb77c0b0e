#include "material_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/description.hpp"

namespace sinew::cli {

using material::NamedMaterial;

std::string tested_text(const NamedMaterial& law) {
  return law.highest > 0.0 ? fmt::format("{:g} to {:g}", law.lowest, law.highest) : "not stated";
}

std::string error_text(const NamedMaterial& law) {
  if (law.error == 0.0) return "not stated";
  const std::string from =
      law.soft_below > 0.0 ? fmt::format(" above {:g}", material::kSlackBelow) : "";
  return fmt::format("{:.0f} %{}", 100.0 * law.error, from);
}

void add_laws(nlohmann::ordered_json& json, std::string& text, const scene::BodyDescription& body) {
  const auto add = [&](const std::string& name, const scene::MaterialDescription& own) {
    if (own.library.empty()) return;
    const NamedMaterial& law = material::named_material(own.library);
    const double modulus = own.energy.young_modulus();
    json["materials"].push_back({{"item", name},
                                 {"name", law.name},
                                 {"tested_stretch", {law.lowest, law.highest}},
                                 {"error", law.error},
                                 {"young_modulus_Pa", modulus},
                                 {"measured_modulus_Pa", law.measured_modulus}});
    text += fmt::format(
        "  material of {}: {}, E = {:.4g} kPa at small strain, tested stretch {}, error {}\n", name,
        law.name, 1e-3 * modulus, tested_text(law), error_text(law));
  };
  if (!body.kind->has_elements) return;
  add(body.name, body.material);
  for (const scene::PartDescription& part : body.parts) {
    add(body.name + "." + part.name, part.material);
  }
}

}  // namespace sinew::cli
