#include "sinew/material/library.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::material {

namespace {

constexpr const char* kEcoflex30Source =
    "Coefficients as published with the multi-flexible-body simulation of a cable-driven conical "
    "arm; "
    "density: Smooth-On, technical bulletin of the Ecoflex series (1.07 g/cm^3)";
constexpr double kEcoflexDensity = 1070.0;

NamedMaterial make(std::string name, std::string trade_name, std::string law, Hyperelastic energy,
                   std::string source, std::string remark) {
  energy.bulk_modulus = bulk_modulus_of(energy.shear_modulus(), kLibraryPoissonRatio);
  return {.name = std::move(name),
          .trade_name = std::move(trade_name),
          .law = std::move(law),
          .energy = std::move(energy),
          .density = kEcoflexDensity,
          .source = std::move(source),
          .remark = std::move(remark)};
}

std::vector<NamedMaterial> make_library() {
  std::vector<NamedMaterial> list;
  list.push_back(
      make("ecoflex-00-30", "Ecoflex 00-30", "ogden",
           ogden({{24.361e3, 1.7138}, {66.703, 7.0679}, {-453.81, -3.3659}},
                 OgdenConvention::mu_over_alpha),
           kEcoflex30Source,
           "The source gives mu_3 = 453.81 Pa and also uses -453.81 Pa, which is taken here: with "
           "mu_3 alpha_3 < 0 the law is unstable below a stretch of 0.31 and above 3.68."));
  list.push_back(make("ecoflex-00-30-published", "Ecoflex 00-30", "ogden",
                      ogden({{24.361e3, 1.7138}, {66.703, 7.0679}, {453.81, -3.3659}},
                            OgdenConvention::mu_over_alpha),
                      kEcoflex30Source,
                      "mu_3 as first published: unstable in uniaxial compression below 0.31 and in "
                      "tension above 3.68. For comparison."));
  list.push_back(make("ecoflex-00-30-mooney-rivlin", "Ecoflex 00-30", "mooney-rivlin",
                      mooney_rivlin(12.18e3, -33.3515), kEcoflex30Source,
                      "Not a fit of its own: C10 = mu_1/2 and C01 = -mu_2/2 of the Ogden law."));
  list.push_back(make("ecoflex-00-30-neo-hookean", "Ecoflex 00-30", "neo-hookean",
                      neo_hookean(2.0 * 12.18e3), kEcoflex30Source,
                      "Not a fit of its own: C10 = mu_1/2 of the Ogden law."));
  list.push_back(make(
      "ecoflex-00-50", "Ecoflex 00-50", "ogden",
      ogden({{107.9e3, 1.55}, {21.47, 7.86}, {-87.1e3, -1.91}},
            OgdenConvention::two_mu_over_alpha_squared),
      "Coefficients as published with the simulation of a pneumatic bending module; density: "
      "Smooth-On, as Ecoflex 00-30",
      "The source does not say which convention: only sum 2 mu/alpha^2 (...) gives the material's "
      "initial shear modulus, 20.8 kPa; sum mu/alpha (...) would give 167 kPa. So read, the law is "
      "unstable after Drucker beyond a uniaxial stretch of 1.13 or below 0.885, an equibiaxial one "
      "of "
      "1.06: walls of it invert under little load. Fit your own where strains are large."));
  std::ranges::sort(list, {}, &NamedMaterial::name);
  return list;
}

}  // namespace

std::span<const NamedMaterial> material_library() {
  static const std::vector<NamedMaterial> library = make_library();
  return library;
}

const NamedMaterial& named_material(std::string_view name) {
  std::vector<std::string> names;
  for (const NamedMaterial& material : material_library()) {
    if (material.name == name) return material;
    names.push_back(material.name);
  }
  const std::string near = nearest_word(std::string(name), names);
  throw Error(ErrorKind::unknown_name, {.item = "material"},
              fmt::format("there is no material '{}' in the library", name),
              near.empty() ? fmt::format("one of {}", fmt::join(names, ", "))
                           : fmt::format("did you mean '{}'?", near));
}

}  // namespace sinew::material
