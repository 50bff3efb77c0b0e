#include "sinew/material/library.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/material/instability.hpp"

namespace sinew::material {

namespace {

constexpr const char* kEcoflex30Source =
    "Coefficients as published with the multi-flexible-body simulation of a cable-driven conical"
    " arm; density: Smooth-On, technical bulletin of the Ecoflex series (1.07 g/cm^3)";

// Fits of `sinew fit FILE --model ogdenN --starts 8` to the rows of a curve up to a stretch of 4.
std::string tensile_source(const char* rms, double density) {
  return fmt::format(
      "Our fit to the tensile curve of Marechal, Balland, Lindenroth, Petrou, Kontovounisios, "
      "Bello, Soft Robotics 8 (2021) 284-297 (Soft-Robotics-Materials-Database, ODbL 1.0), "
      "stretch up to 4, RMS {} of nominal stress; density: Smooth-On, technical bulletin ({:g} "
      "g/cm^3)",
      rms, 1e-3 * density);
}
constexpr const char* kTensileRemark =
    "Strain is crosshead travel over 33 mm, so the law is too soft, most of all at small strain: "
    "in "
    "the four silicones that other tests could check, 1.8 to 2.6 times. Scale it to your own test. "
    "It was fitted to one tensile test and not checked in other modes.";

// Compression of three Ecoflex silicones, means of ten tests each.
constexpr const char* kCompression =
    "compression of cylinders 50 mm wide and 30 mm high: Dawood, Zhang, Osman, Suulker, Abdulali, "
    "Angelmahr, Althoefer, Hyperelastic Characterisation of Silicone Tissue Phantoms, 2026 "
    "(tissue-phantom-material-database, CC BY 4.0)";
constexpr const char* kBeam =
    "a clamped beam: Dubied, Michelis, Spielberg, Katzschmann, IEEE Robot. Autom. Lett. 7 (2022) "
    "5015-5022";
constexpr double kPsi = 6894.76;  // Pa
// The manufacturer's 100 % modulus still exceeds the tensile curves of the silicones with a test at
// small strain by a factor of 1.3 to 3.8.
constexpr double kSoftBelow = 2.0;
// A law is called too soft if a test at small strain gave more than this multiple of its modulus.
constexpr double kSofter = 1.2;

/// A test at small strain.
struct SmallStrain {
  double modulus = 0.0;  // Young's, Pa
  const char* source = "";
};
constexpr SmallStrain kBeam10 = {263824.0, kBeam}, kEcoflex10 = {54.21e3, kCompression},
                      kEcoflex30 = {97.26e3, kCompression}, kEcoflex50 = {152.70e3, kCompression};

/// Adds what another test says about an entry. @param better entry to use instead.
NamedMaterial checked(NamedMaterial entry, const SmallStrain& test, const char* better = "") {
  entry.measured_modulus = test.modulus;
  entry.measured_by = test.source;
  entry.better = better;
  const bool stable = instability(entry.energy).empty();  // others say that they are not
  const bool soft = test.modulus > kSofter * entry.energy.young_modulus();
  if (soft && stable) entry.soft_below = kSoftBelow;
  return entry;
}

/// An entry as published or fitted; finish() adds the bulk modulus.
struct Entry {
  std::string name, trade_name, law;
  Hyperelastic energy;
  double density, lowest, highest;
  std::string source, remark;
};

NamedMaterial finish(Entry entry) {
  entry.energy.bulk_modulus = bulk_modulus_of(entry.energy.shear_modulus(), kLibraryPoissonRatio);
  return {.name = std::move(entry.name),
          .trade_name = std::move(entry.trade_name),
          .law = std::move(entry.law),
          .energy = std::move(entry.energy),
          .density = entry.density,
          .lowest = entry.lowest,
          .highest = entry.highest,
          .source = std::move(entry.source),
          .remark = std::move(entry.remark)};
}

/// @param error as NamedMaterial::error. @param test at small strain. @param better entry for it.
NamedMaterial tensile(const char* name, const char* trade_name, const std::vector<OgdenTerm>& terms,
                      const char* rms, double error, double density, const SmallStrain& test = {},
                      const char* better = "", const std::string& more = "") {
  NamedMaterial entry =
      checked(finish({name, trade_name, "ogden", ogden(terms, OgdenConvention::mu_over_alpha),
                      density, 1.0, 4.0, tensile_source(rms, density), kTensileRemark + more}),
              test, better);
  entry.error = error;
  if (test.modulus == 0.0) entry.soft_below = kSlackBelow;
  return entry;
}

/// One term of Ogden with a measured Young's modulus E at small strain, mu_0 = E/3, and the
/// exponent a with which the stress at a stretch of 2 is the manufacturer's 100 % modulus:
///   (2 mu_0/a) (2^(a - 1) - 2^(-a/2 - 1)) = P_100.
/// @param psi P_100. @param alpha a. @param lowest,error as in NamedMaterial.
NamedMaterial small_strain(const char* name, const char* trade_name, const SmallStrain& test,
                           double psi, double alpha, double lowest, double error, double density,
                           const char* remark) {
  const double shear = test.modulus / 3.0;
  NamedMaterial entry = checked(
      finish({name, trade_name, "ogden",
              ogden({{shear, alpha}}, OgdenConvention::two_mu_over_alpha_squared), density, lowest,
              2.0,
              fmt::format("Our fit, one term: Young's modulus at small strain {:.4g} kPa, {}; and "
                          "the manufacturer's 100 % modulus, {:g} psi ({:.1f} kPa), and density: "
                          "Smooth-On, technical bulletin ({:g} g/cm^3)",
                          1e-3 * test.modulus, test.source, psi, 1e-3 * psi * kPsi, 1e-3 * density),
              remark}),
      test);
  entry.error = error;
  return entry;
}
constexpr const char* kCompressionRemark =
    "Assumes that the ends of the cylinders slid freely; the source does not say. Had they stuck, "
    "the modulus would be 30 % lower (our simulation of the test). A later evaluation by the "
    "source gives 4 to 6 % more. Between 1 and 2 the law is interpolated. Not checked in other "
    "modes.";

void add_ecoflex(std::vector<NamedMaterial>& list) {
  constexpr double kDensity = 1070.0;
  list.push_back(small_strain("ecoflex-00-10", "Ecoflex 00-10", kEcoflex10, 8.0, 3.42935, 0.75,
                              0.07, 1040.0, kCompressionRemark));
  list.push_back(tensile("ecoflex-00-10-tensile", "Ecoflex 00-10",
                         {{1563.90, 3.48450}, {10069.3, 0.938401}}, "0.31 kPa (0.5 %)", 0.03,
                         1040.0, kEcoflex10, "ecoflex-00-10"));
  list.push_back(finish(
      {"ecoflex-00-20", "Ecoflex 00-20", "neo-hookean", neo_hookean(31.5e3), kDensity, 1.0, 2.0,
       "From the manufacturer's 100 % modulus only, 8 psi (55.2 kPa) = mu (2 - 1/4); Smooth-On, "
       "technical bulletin of the Ecoflex series, also density (1.07 g/cm^3)",
       "A secant modulus between 0 and 100 % in the manufacturer's own test: stiffer at small "
       "strain than tests of Ecoflex 00-10 and 00-30 (7 and 15 to 24 kPa)."}));
  list.push_back(
      checked(finish({"ecoflex-00-30", "Ecoflex 00-30", "ogden",
                      ogden({{24.361e3, 1.7138}, {66.703, 7.0679}, {-453.81, -3.3659}},
                            OgdenConvention::mu_over_alpha),
                      kDensity, 0.0, 0.0, kEcoflex30Source,
                      "The source gives mu_3 = 453.81 Pa and also uses -453.81 Pa. The negative "
                      "value is used here: with the positive one, mu_3 alpha_3 < 0 and the law "
                      "is unstable below a stretch of 0.31 and above 3.68. Compression tests "
                      "of another laboratory are up to 1.5 times as stiff at small strain; see "
                      "ecoflex-00-30-compression."}),
              kEcoflex30, "ecoflex-00-30-compression"));
  list.push_back(small_strain("ecoflex-00-30-compression", "Ecoflex 00-30", kEcoflex30, 10.0,
                              2.54038, 0.75, 0.04, kDensity, kCompressionRemark));
  list.push_back(
      checked(finish({"ecoflex-00-30-published", "Ecoflex 00-30", "ogden",
                      ogden({{24.361e3, 1.7138}, {66.703, 7.0679}, {453.81, -3.3659}},
                            OgdenConvention::mu_over_alpha),
                      kDensity, 0.0, 0.0, kEcoflex30Source,
                      "mu_3 as first published: unstable in uniaxial compression below 0.31 "
                      "and in tension above 3.68, in equibiaxial tension above 1.79. For "
                      "comparison."}),
              kEcoflex30, "ecoflex-00-30"));
  list.push_back(
      checked(finish({"ecoflex-00-30-mooney-rivlin", "Ecoflex 00-30", "mooney-rivlin",
                      mooney_rivlin(12.18e3, -33.3515), kDensity, 0.0, 0.0, kEcoflex30Source,
                      "Not a separate fit: C10 = mu_1/2 and C01 = -mu_2/2 of the Ogden law."}),
              kEcoflex30, "ecoflex-00-30-compression"));
  list.push_back(checked(finish({"ecoflex-00-30-neo-hookean", "Ecoflex 00-30", "neo-hookean",
                                 neo_hookean(2.0 * 12.18e3), kDensity, 0.0, 0.0, kEcoflex30Source,
                                 "Not a separate fit: C10 = mu_1/2 of the Ogden law."}),
                         kEcoflex30, "ecoflex-00-30-compression"));
  list.push_back(tensile("ecoflex-00-30-tensile", "Ecoflex 00-30",
                         {{8.57318, 5.81546}, {13564.1, 2.22708}}, "0.34 kPa (0.4 %)", 0.04,
                         kDensity, kEcoflex30, "ecoflex-00-30-compression"));
  list.push_back(small_strain("ecoflex-00-50", "Ecoflex 00-50", kEcoflex50, 12.0, 1.77874, 0.75,
                              0.06, kDensity, kCompressionRemark));
  list.push_back(checked(
      finish(
          {"ecoflex-00-50-published", "Ecoflex 00-50", "ogden",
           ogden({{107.9e3, 1.55}, {21.47, 7.86}, {-87.1e3, -1.91}},
                 OgdenConvention::two_mu_over_alpha_squared),
           kDensity, 0.0, 0.0,
           "Coefficients as published with the simulation of a pneumatic bending module; density: "
           "Smooth-On, as Ecoflex 00-30",
           "The source does not state the convention: only sum 2 mu/alpha^2 (...) gives the "
           "material's "
           "initial shear modulus, 20.8 kPa; sum mu/alpha (...) would give 167 kPa. In this "
           "convention "
           "the law is Drucker-unstable beyond a uniaxial stretch of 1.13 or below 0.885, and "
           "beyond "
           "an equibiaxial stretch of 1.06; thin walls invert under small loads. Use "
           "ecoflex-00-50."}),
      kEcoflex50, "ecoflex-00-50"));
  list.push_back(tensile("ecoflex-00-50-tensile", "Ecoflex 00-50",
                         {{9.08724, 5.94580}, {16581.7, 2.41648}}, "0.40 kPa (0.3 %)", 0.02,
                         kDensity, kEcoflex50, "ecoflex-00-50"));
}

void add_dragon_skin(std::vector<NamedMaterial>& list) {
  list.push_back(small_strain(
      "dragon-skin-10", "Dragon Skin 10", kBeam10, 22.0, 1.95772, 0.9, 0.11, 1070.0,
      "The modulus was fitted to a bent beam, stretches 0.9 to 1.1; later fits of its authors are "
      "283 to 294 kPa. Between 1.1 and 2 the law is interpolated. Not checked in other modes."));
  list.push_back(tensile("dragon-skin-10-tensile", "Dragon Skin 10 Medium", {{34767.7, 2.85840}},
                         "6.0 kPa (1.4 %)", 0.15, 1070.0, kBeam10, "dragon-skin-10"));
  list.push_back(
      checked(finish({"dragon-skin-10-beam", "Dragon Skin 10", "neo-hookean",
                      neo_hookean(263824.0 / 3.0), 1070.0, 0.9, 1.1,
                      "Young's modulus 263.8 kPa (incompressible: mu = E/3) as fitted to a "
                      "clamped beam by Dubied, Michelis, Spielberg, Katzschmann, IEEE Robot. "
                      "Autom. Lett. 7 (2022) 5015-5022, also density",
                      "For bending at small strain; the same authors' later fits are 283 to 294 "
                      "kPa. Our simulation of that beam agrees best with 271 kPa."}),
              kBeam10, "dragon-skin-10"));
  list.back().error = 0.11;
  list.push_back(tensile("dragon-skin-20", "Dragon Skin 20", {{95909.4, 2.83335}},
                         "9.8 kPa (0.8 %)", 0.09, 1080.0));
  list.push_back(tensile("dragon-skin-30", "Dragon Skin 30", {{144776.9, 2.71607}},
                         "13.7 kPa (0.9 %)", 0.10, 1080.0));
  list.push_back(tensile(
      "dragon-skin-fx-pro", "Dragon Skin FX-Pro", {{19813.7, 2.73843}}, "0.4 kPa (0.2 %)", 0.0,
      1060.0, {}, "",
      " This curve has no stress up to 4.5 % strain (slack); 26 of its rows were fitted. Measure "
      "the density: it could not be checked against the data sheet."));
}

void add_others(std::vector<NamedMaterial>& list) {
  list.push_back(tensile("sorta-clear-40", "SORTA-Clear 40", {{176661.4, 2.76681}},
                         "6.8 kPa (0.3 %)", 0.04, 1080.0, {}, "",
                         " Measure the density: it could not be checked against the data sheet."));
  list.push_back(finish(
      {"elastosil-m4601", "Elastosil M4601", "yeoh", yeoh({0.11e6, 0.02e6}), 1130.0, 0.0, 0.0,
       "C10 = 0.11 MPa, C20 = 0.02 MPa and density as in the Soft Robotics Toolkit "
       "(softroboticstoolkit.com), PneuNets bending actuators, modeling",
       "The source does not state the strain up to which they hold."}));
  list.push_back(
      finish({"elastosil-m4601-neo-hookean", "Elastosil M4601", "neo-hookean",
              neo_hookean(2.0 * 0.12e6), 1130.0, 0.0, 0.0,
              "C10 = 0.12 MPa as in the Soft Robotics Toolkit (softroboticstoolkit.com), fiber-"
              "reinforced actuators, finite element modeling; density: as elastosil-m4601",
              "The source does not state the strain up to which it holds."}));
  list.push_back(
      finish({"smooth-sil-950", "Smooth-Sil 950", "neo-hookean", neo_hookean(1.875e6 / 1.75),
              1240.0, 1.0, 2.0,
              "From the manufacturer's 100 % modulus only, 272 psi (1.875 MPa) = mu (2 - 1/4), as "
              "commonly quoted from Smooth-On's bulletin, also density (1.24 g/cm^3)",
              "Neither figure could be checked against the bulletin itself. The modulus is a "
              "secant between 0 and 100 %: test your own material before you rely on it."}));
  list.push_back(finish(
      {"sylgard-184", "Sylgard 184 (10:1)", "neo-hookean", neo_hookean(1.32e6 / 3.0), 1030.0, 1.0,
       1.4,
       "Young's modulus 1.32 MPa (incompressible: mu = E/3) of samples cured at 25 C, to 40 % "
       "strain: Johnston, McCluskey, Tan, Tracey, J. Micromech. Microeng. 24 (2014) 035017; "
       "density: Dow, technical data sheet (1.03)",
       "The modulus depends on curing: 1.32 MPa at 25 C to 2.97 MPa at 200 C in this source; other "
       "sources differ more (Varner, Cohen, Soft Matter 2024). Measure the density: it could not "
       "be checked."}));
}

std::vector<NamedMaterial> make_library() {
  std::vector<NamedMaterial> list;
  add_ecoflex(list);
  add_dragon_skin(list);
  add_others(list);
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

std::string small_strain_remedy(const NamedMaterial& law) {
  const std::string scale = fmt::format(
      "scale it to a test of your own, such as material: {{name: {}, scale: 1.5}}", law.name);
  if (law.better.empty()) return scale;
  const NamedMaterial& better = named_material(law.better);
  return fmt::format("write {}, which was tested from {:g} to {:g}, or {}", better.name,
                     better.lowest, better.highest, scale);
}

}  // namespace sinew::material
