// The notices about laws that fail where robots work.
#include <string>

#include <fmt/format.h>

#include "sinew/material/instability.hpp"
#include "sinew/material/library.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

namespace {

// Saint Venant-Kirchhoff is for small strain, which its name says; the others promise more.
std::optional<Notice> unstable_notice(const MaterialDescription& material) {
  if (!material.is_hyperelastic()) return std::nullopt;
  const std::string where = material::instability(material.energy);
  if (where.empty()) return std::nullopt;
  const std::string better =
      material.library.empty() ? "" : material::named_material(material.library).better;
  const bool small = material.energy.saint_venant_shear > 0.0;
  return Notice{
      small ? NoticeLevel::remark : NoticeLevel::warning, NoticeKind::unstable_law, material.place,
      fmt::format("the law{} is unstable {}: walls that strain further invert or collapse",
                  material.library.empty() ? "" : fmt::format(" '{}'", material.library), where),
      !better.empty() ? fmt::format("write {}", better)
                      : "keep strains within this range, or fit another law (sinew fit)"};
}

std::optional<Notice> soft_remark(const MaterialDescription& material) {
  if (material.library.empty() || material.scaled) return std::nullopt;
  const material::NamedMaterial& law = material::named_material(material.library);
  if (law.soft_below == 0.0) return std::nullopt;
  return Notice{NoticeLevel::remark, NoticeKind::strain_range, material.place,
                fmt::format("'{}' {} too soft where no stretch exceeds {:g}", law.name,
                            law.measured_modulus > 0.0 ? "is" : "is probably", law.soft_below),
                material::small_strain_remedy(law)};
}

}  // namespace

std::vector<Notice> law_notices(const BodyDescription& body) {
  std::vector<Notice> notices;
  if (!body.kind->has_elements) return notices;
  const auto judge = [&](const MaterialDescription& material) {
    if (auto notice = unstable_notice(material)) notices.push_back(std::move(*notice));
    if (auto notice = soft_remark(material)) notices.push_back(std::move(*notice));
  };
  judge(body.material);
  for (const PartDescription& part : body.parts) judge(part.material);
  return notices;
}

}  // namespace sinew::scene
