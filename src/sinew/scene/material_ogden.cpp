// The law ogden.
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/material/hyperelastic.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/material_fields.hpp"
#include "sinew/scene/material_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::vector<Key> ogden_keys() {
  constexpr int kMaxTerms = 6;
  Form moduli = quantity(elastic_modulus(), any());
  moduli.max_count = kMaxTerms;
  return {
      {.name = "mu",
       .forms = {moduli},
       .example = "24.361 0.066703 -0.45381 kPa",
       .description = "Moduli, one to six.",
       .required = true},
      {.name = "alpha",
       .forms = {numbers(1, kMaxTerms, any())},
       .example = "1.7138 7.0679 -3.3659",
       .description = "Exponents, one per modulus.",
       .required = true},
      {.name = "convention",
       .forms = {choice({{"mu-over-alpha", "sum mu/alpha (...), Ogden's own form."},
                         {"two-mu-over-alpha-squared",
                          "sum 2 mu/alpha^2 (...): mu adds up to the initial shear modulus."}})},
       .example = "mu-over-alpha",
       .description = "Convention of the moduli. Sources differ, and the wrong convention gives a "
                      "wrong stiffness.",
       .required = true}};
}

std::shared_ptr<const KeyTable> ogden_table() { return energy_table(ogden_kind(), ogden_keys()); }

}  // namespace
}  // namespace forms

namespace {

material::Hyperelastic read_ogden(const Fields& fields) {
  std::vector<double> mu, alpha;
  fields.read_numbers("mu", mu);
  fields.read_numbers("alpha", alpha);
  if (mu.size() != alpha.size()) {
    throw Error(ErrorKind::wrong_length, fields.place("alpha"),
                fmt::format("there are {} moduli and {} exponents", mu.size(), alpha.size()),
                "give one exponent for each modulus");
  }
  auto convention = material::OgdenConvention::mu_over_alpha;
  fields.read_choice(
      "convention", convention,
      {{"mu-over-alpha", material::OgdenConvention::mu_over_alpha},
       {"two-mu-over-alpha-squared", material::OgdenConvention::two_mu_over_alpha_squared}});
  std::vector<material::OgdenTerm> terms;
  for (std::size_t k = 0; k < mu.size(); ++k) {
    if (alpha[k] == 0.0) {
      throw Error(ErrorKind::invalid_material, fields.place("alpha"), "an exponent is 0",
                  "give one that is not, for instance 2");
    }
    terms.push_back({mu[k], alpha[k]});
  }
  return material::ogden(terms, convention);
}

void read_ogden_law(const Fields& fields, MaterialDescription& material) {
  set_energy(fields, read_ogden(fields), material);
}

}  // namespace

const MaterialKind& ogden_kind() {
  static const MaterialKind kind{.word = "ogden",
                                 .description = "A sum of powers of the principal stretches.",
                                 .table = forms::ogden_table,
                                 .read = read_ogden_law};
  return kind;
}

}  // namespace sinew::scene
